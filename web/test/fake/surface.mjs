// A patch of the fake program's surface around the proxy: a disk in the tangent plane, put on the surface.

import { encodeSurface } from "./encode.mjs";
import { kBall, tableHeight } from "./scene.mjs";

const kRings = 9;
const kSpokes = 28;

function onSurface([x, y, z]) {
  const way = [x, y, z].map((c, i) => c - kBall.centre[i]);
  const away = Math.hypot(...way);
  if (away < kBall.radius * 1.25) return kBall.centre.map((c, i) => c + (kBall.radius * way[i]) / away);
  return [x, y, tableHeight(x, y)];
}

/** Without a contact: that nothing is near. */
export function patchAround(contact, extent) {
  if (contact === undefined) return encodeSurface(0, [0, 0, 0], 0, [], []);
  const { proxy, normal } = contact;
  const [nx, ny, nz] = normal;
  const a = Math.abs(nz) < 0.9 ? [-ny, nx, 0] : [0, -nz, ny];
  const u = a.map((c) => c / Math.hypot(...a));
  const v = [ny * u[2] - nz * u[1], nz * u[0] - nx * u[2], nx * u[1] - ny * u[0]];
  const vertices = [onSurface(proxy)];
  const triangles = [];
  for (let ring = 1; ring <= kRings; ring += 1) {
    for (let spoke = 0; spoke < kSpokes; spoke += 1) {
      const r = (extent * 0.95 * ring) / kRings;
      const angle = (2 * Math.PI * spoke) / kSpokes;
      const [c, s] = [r * Math.cos(angle), r * Math.sin(angle)];
      vertices.push(onSurface(proxy.map((p, i) => p + c * u[i] + s * v[i])));
      const at = (k, j) => (k === 0 ? 0 : 1 + (k - 1) * kSpokes + (j % kSpokes));
      const [in0, in1, out0, out1] = [at(ring - 1, spoke), at(ring - 1, spoke + 1), at(ring, spoke), at(ring, spoke + 1)];
      triangles.push([in0, out0, out1]);
      if (ring > 1) triangles.push([in0, out1, in1]);
    }
  }
  return encodeSurface(0, proxy, extent, vertices, triangles);
}
