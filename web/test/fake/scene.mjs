// The fake program's world: a table with a ball, seen by two cameras. Lengths in metres, z up.

export const kTable = { half: [0.3, 0.22], height: 0 };
export const kBall = { centre: [0.05, 0.02, 0.055], radius: 0.06 };
const kBump = 0.004;

/** A repeatable random number from 0 to 1. */
export function randomFrom(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

const bump = (x, y) => kBump * Math.sin(60 * x) * Math.sin(60 * y) * Math.exp(-((x + 0.17) ** 2 + y ** 2) / 0.006);

export const tableHeight = (x, y) => kTable.height + bump(x, y);

export function tableNormal(x, y) {
  const d = 1e-4;
  const gx = (tableHeight(x + d, y) - tableHeight(x - d, y)) / (2 * d);
  const gy = (tableHeight(x, y + d) - tableHeight(x, y - d)) / (2 * d);
  const length = Math.hypot(gx, gy, 1);
  return [-gx / length, -gy / length, 1 / length];
}

/** The nearest point of the surface in front of a hand that is inside; undefined where it is outside. */
export function stopAt(hand) {
  const [x, y, z] = hand;
  const way = hand.map((v, i) => v - kBall.centre[i]);
  const away = Math.hypot(...way) || 1e-9;
  const inBall = kBall.radius - away;
  const onTable = Math.abs(x) < kTable.half[0] && Math.abs(y) < kTable.half[1];
  const inTable = onTable ? tableHeight(x, y) - z : -1;
  if (inBall <= 0 && (inTable <= 0 || inTable > 0.1)) return undefined;
  if (inBall > 0) {
    const normal = way.map((v) => v / away);
    return { normal, proxy: kBall.centre.map((c, i) => c + kBall.radius * normal[i]) };
  }
  const normal = tableNormal(x, y);
  return { normal, proxy: [x, y, tableHeight(x, y)] };
}

export const kCameras = [
  { name: "left", eye: [-0.45, -0.42, 0.5] },
  { name: "right", eye: [0.5, -0.35, 0.45] },
];

/** Rotation of a camera that looks from a place at the origin (z forward, x right, y down). */
export function lookAtOrigin(eye) {
  const norm = (v) => v.map((c) => c / Math.hypot(...v));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const z = norm(eye.map((c) => -c));
  const x = norm(cross(z, [0, 0, 1]));
  const y = cross(z, x);
  const w = Math.sqrt(Math.max(1e-12, 1 + x[0] + y[1] + z[2])) / 2;
  if (w > 1e-3) return [(y[2] - z[1]) / (4 * w), (z[0] - x[2]) / (4 * w), (x[1] - y[0]) / (4 * w), w];
  return [1, 0, 0, 0];
}

/** Pairs of numbers from 0 to 1 that fill the square evenly from the first on (M. Roberts' R2). */
function evenly(start) {
  let [u, v] = [start, start];
  return () => {
    u = (u + 0.7548776662466927) % 1;
    v = (v + 0.5698402909980532) % 1;
    return [u, v];
  };
}

function pointOf(random, next, camera) {
  const [p, q] = next();
  if (random() < 0.2) {
    const u = 2 * p - 1;
    const a = 2 * Math.PI * q;
    const normal = [Math.sqrt(1 - u * u) * Math.cos(a), Math.sqrt(1 - u * u) * Math.sin(a), u];
    const place = kBall.centre.map((c, i) => c + kBall.radius * normal[i]);
    const facing = normal.reduce((sum, n, i) => sum + n * (camera.eye[i] - place[i]), 0);
    if (facing < 0.05 || place[2] < 0.003) return undefined;
    return { place, normal, colour: [92, 128, 158], trust: 40 };
  }
  const [x, y] = [kTable.half[0] * (2 * p - 1), kTable.half[1] * (2 * q - 1)];
  const place = [x, y, tableHeight(x, y)];
  const way = camera.eye.map((c, i) => c - place[i]);
  if (hitsBall(place, way)) return undefined;
  const check = (Math.floor(x / 0.05) + Math.floor(y / 0.05)) & 1;
  return { place, normal: tableNormal(x, y), colour: check ? [186, 160, 124] : [158, 130, 96], trust: 220 };
}

function hitsBall(from, way) {
  const o = from.map((c, i) => c - kBall.centre[i]);
  const a = way.reduce((s, c) => s + c * c, 0);
  const b = o.reduce((s, c, i) => s + c * way[i], 0);
  const c = o.reduce((s, v) => s + v * v, 0) - kBall.radius ** 2;
  return b * b - a * c > 0 && b < 0;
}

/** Points that one camera sees, with normals and colours. */
export function seenPoints(camera, count, random, noise = 0.0004) {
  const points = [];
  const next = evenly(random());
  while (points.length < count) {
    const point = pointOf(random, next, camera);
    if (point === undefined) continue;
    const shift = noise * (random() + random() + random() - 1.5);
    point.place = point.place.map((c, i) => c + shift * point.normal[i]);
    points.push(point);
  }
  return points;
}
