// Binary messages as the program writes them: docs/viewer_protocol.md.

export function octahedral([x, y, z]) {
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
  let [u, v] = [x / sum, y / sum];
  const sign = (c) => (c < 0 ? -1 : 1);
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * sign(u), (1 - Math.abs(u)) * sign(v)];
  return [Math.round(u * 127), Math.round(v * 127)];
}

export function encodeState(state) {
  const after = state.tool === undefined ? [] : [...state.tool.hand, ...state.tool.proxy, 0, state.tool.opening, ...state.tool.torque, 0];
  const bytes = Buffer.alloc(92 + 12 * state.samples.length + 4 * after.length);
  bytes.writeUInt8(1, 0);
  bytes.writeUInt8(state.device, 1);
  bytes.writeUInt16LE(state.samples.length, 2);
  bytes.writeUInt32LE(state.flags | (state.tool === undefined ? 0 : 8192 | 65536), 4);
  bytes.writeDoubleLE(state.time, 8);
  const floats = [
    ...state.hip, ...state.proxy, ...state.normal, ...state.force, state.radius, state.rate,
    ...state.step, ...state.lateness, state.interval, ...state.samples.flat(), ...after,
  ];
  floats.forEach((value, i) => bytes.writeFloatLE(value, 16 + 4 * i));
  return bytes;
}

/** A box's corners, m. */
export function encodeTool(device, [x, y, z]) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [(k & 1) - 0.5, ((k >> 1) & 1) - 0.5, (k >> 2) - 0.5]);
  const floats = [1, 0, 0, ...corners.flatMap(([i, j, k]) => [i * x, j * y, k * z, 0, 0])];
  const bytes = Buffer.alloc(12 + 4 * floats.length);
  bytes.writeUInt8(5, 0);
  bytes.writeUInt8(device, 1);
  bytes.writeUInt32LE(corners.length, 4);
  floats.forEach((value, i) => bytes.writeFloatLE(value, 12 + 4 * i));
  return bytes;
}

/** Steps are times before the last, and forces. */
export function encodePast(device, time, steps) {
  const bytes = Buffer.alloc(16 + 16 * steps.length);
  bytes.writeUInt8(4, 0);
  bytes.writeUInt8(device, 1);
  bytes.writeUInt32LE(steps.length, 4);
  bytes.writeDoubleLE(time, 8);
  steps.flat().forEach((value, i) => bytes.writeFloatLE(value, 16 + 4 * i));
  return bytes;
}

/** bare: without colours and normals. R is 2.5 spacings of points that lie evenly on the sides of their box. */
export function encodeCloud(source, stamp, points, bare = false) {
  const n = points.length;
  const lower = [0, 1, 2].map((i) => points.reduce((least, p) => Math.min(least, p.place[i]), Infinity));
  const upper = [0, 1, 2].map((i) => points.reduce((most, p) => Math.max(most, p.place[i]), -Infinity));
  const extent = upper.map((u, i) => u - lower[i]);
  const [x, y, z] = extent;
  const radius = Math.round(160 + 8 * Math.log2(2.5 * Math.sqrt((x * y + y * z + z * x) / Math.max(n, 1))));
  const bytes = Buffer.alloc(40 + (bare ? 8 : 13) * n, Math.min(255, Math.max(0, radius)));
  bytes.writeUInt8(2, 0);
  bytes.writeUInt8(source, 1);
  bytes.writeUInt16LE(bare ? 12 : 15, 2);
  bytes.writeUInt32LE(n, 4);
  bytes.writeDoubleLE(stamp, 8);
  [...lower, ...extent].forEach((value, i) => bytes.writeFloatLE(value, 16 + 4 * i));
  points.forEach(({ place, normal, colour, trust }, k) => {
    for (let i = 0; i < 3; i += 1) {
      const u = Math.round((65535 * (place[i] - lower[i])) / (extent[i] || 1));
      bytes.writeUInt16LE(Math.min(65535, Math.max(0, u)), 40 + 6 * k + 2 * i);
      if (!bare) bytes.writeUInt8(colour[i], 40 + 6 * n + 3 * k + i);
    }
    bytes.writeUInt8(trust, 40 + (bare ? 6 : 11) * n + k);
    if (bare) return;
    const [u, v] = octahedral(normal);
    bytes.writeInt8(u, 40 + 9 * n + 2 * k);
    bytes.writeInt8(v, 40 + 9 * n + 2 * k + 1);
  });
  return bytes;
}

export function encodeSurface(device, centre, extent, vertices, triangles) {
  const bytes = Buffer.alloc(24 + 6 * vertices.length + 6 * triangles.length);
  bytes.writeUInt8(3, 0);
  bytes.writeUInt8(device, 1);
  bytes.writeUInt16LE(vertices.length, 2);
  bytes.writeUInt32LE(triangles.length, 4);
  [...centre, extent].forEach((value, i) => bytes.writeFloatLE(value, 8 + 4 * i));
  vertices.flat().forEach((value, i) => {
    const at = Math.max(-1, Math.min(1, (value - centre[i % 3]) / extent));
    bytes.writeInt16LE(Math.round(32767 * at), 24 + 2 * i);
  });
  triangles.flat().forEach((value, i) => bytes.writeUInt16LE(value, 24 + 6 * vertices.length + 2 * i));
  return bytes;
}
