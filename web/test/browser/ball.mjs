/** A ball of points, as XYZ; its radius in m. */
export function ball(radius) {
  const rows = [];
  for (let i = 0; i < 4000; i += 1) {
    const z = 1 - (2 * i + 1) / 4000;
    const r = Math.sqrt(1 - z * z);
    rows.push([r * Math.cos(2.4 * i), r * Math.sin(2.4 * i), z].map((x) => (radius * x).toFixed(6)).join(" "));
  }
  return rows.join("\n");
}
