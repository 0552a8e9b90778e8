// Where there is something to see, from a few points of each cloud; far outliers are left out.

import { Vector2, Vector3 } from "three";
import type { CloudMessage } from "../protocol/decode";

const kSamples = 400; // of one cloud
const kTail = 0.02; // left out at each end

export interface Bounds {
  places: readonly Vector3[]; // of points, without outliers
  centre: Vector3;
  radius: number; // m
  heights: Vector2; // along up, m
}

export function samplePlaces(message: CloudMessage): Vector3[] {
  const stride = Math.max(1, Math.floor(message.count / kSamples));
  const places: Vector3[] = [];
  for (let i = 0; i < message.count; i += stride) {
    const u = (axis: 0 | 1 | 2) =>
      message.lower[axis] + (message.extent[axis] * message.places[3 * i + axis]!) / 65535;
    places.push(new Vector3(u(0), u(1), u(2)));
  }
  return places;
}

function range(values: number[]): [number, number] {
  values.sort((a, b) => a - b);
  const at = (q: number) => values[Math.round(q * (values.length - 1))] ?? 0;
  return [at(kTail), at(1 - kTail)];
}

export function boundsOf(places: readonly Vector3[], up: Vector3): Bounds | undefined {
  if (places.length < 2) return undefined;
  const [x0, x1] = range(places.map((p) => p.x));
  const [y0, y1] = range(places.map((p) => p.y));
  const [z0, z1] = range(places.map((p) => p.z));
  const lower = new Vector3(x0, y0, z0);
  const upper = new Vector3(x1, y1, z1);
  const inside = (v: number, low: number, high: number) => {
    const slack = 0.1 * (high - low);
    return v >= low - slack && v <= high + slack;
  };
  return {
    places: places.filter((p) => inside(p.x, x0, x1) && inside(p.y, y0, y1) && inside(p.z, z0, z1)),
    centre: lower.clone().add(upper).multiplyScalar(0.5),
    radius: Math.max(upper.distanceTo(lower) / 2, 1e-4),
    heights: new Vector2(...range(places.map((p) => p.dot(up)))),
  };
}
