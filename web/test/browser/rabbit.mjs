// A scan to drop: the rabbit of `synthetic:rabbit`, a point about every 1.3 mm.

const kParts = [ // middle, half axes (mm), leaning forward and aside (radians)
  [[-20, 0, 55], [70, 50, 55], -0.35, 0], // body
  [[35, 0, 60], [38, 36, 50], 0.25, 0], // chest
  [[55, 0, 115], [36, 28, 29], 0.3, 0], // head
  [[30, 16, 165], [13, 8, 45], -0.35, -0.2], [[30, -16, 165], [13, 8, 45], -0.35, 0.2], // ears
  [[-10, 40, 30], [45, 20, 30], 0, 0], [[-10, -40, 30], [45, 20, 30], 0, 0], // hind legs
  [[58, 18, 14], [26, 12, 14], 0, 0], // paw
  [[-90, 0, 40], [18, 18, 18], 0, 0], // tail
];
const kArea = 1.7; // mm², of a point

const turned = (a, b, angle) => [a * Math.cos(angle) - b * Math.sin(angle), a * Math.sin(angle) + b * Math.cos(angle)];

/** From a part's unit ball to the rabbit, and back. */
function outOf([middle, axes, forward, aside], unit) {
  const [x, y, z] = unit.map((u, i) => axes[i] * u);
  const [z1, x1] = turned(z, x, forward);
  const [y2, z2] = turned(y, z1, aside);
  return [x1, y2, z2].map((p, i) => middle[i] + p);
}
function into([middle, axes, forward, aside], point) {
  const [x, y, z] = point.map((p, i) => p - middle[i]);
  const [y1, z1] = turned(y, z, -aside);
  const [z2, x2] = turned(z1, x, -forward);
  return [x2, y1, z2].map((p, i) => p / axes[i]);
}

/** As XYZ, in m: of each part what lies in no other. */
export function rabbit() {
  const rows = [];
  for (const part of kParts) {
    const [a, b, c] = part[1];
    const count = Math.round((4 * Math.PI * ((a * b + b * c + c * a) / 3)) / kArea);
    for (let i = 0; i < count; i += 1) {
      const z = 1 - (2 * i + 1) / count;
      const angle = i * Math.PI * (3 - Math.sqrt(5)); // a spiral of the golden angle covers a ball evenly
      const point = outOf(part, [Math.sqrt(1 - z * z) * Math.cos(angle), Math.sqrt(1 - z * z) * Math.sin(angle), z]);
      const hidden = kParts.some((other) => other !== part && Math.hypot(...into(other, point)) < 1);
      if (point[2] > 0 && !hidden) rows.push(point.map((p) => (p / 1000).toFixed(6)).join(" "));
    }
  }
  return rows.join("\n");
}
