// Where there is something to see, from a few points of each cloud: the densest eight tenths of them.

import { Vector2, Vector3 } from "three";
import { decodeOctahedral } from "../protocol/octahedral";
import type { CloudMessage } from "../protocol/decode";

const kSamples = 500; // of one cloud
const kTail = 0.02; // of heights, left out at each end
const kKept = 0.8; // of the points: what lies thin, such as a far floor or outliers, is left out (judgement)
const kNeighbours = 6; // by which the density is estimated (judgement)

export interface Sample {
  position: Vector3;
  normal: Vector3 | undefined;
}

export interface Bounds {
  samples: readonly Sample[];
  centre: Vector3;
  radius: number; // m
}

export function samplesOf(message: CloudMessage): Sample[] {
  const stride = Math.max(1, Math.floor(message.count / kSamples));
  const samples: Sample[] = [];
  for (let i = 0; i < message.count; i += stride) {
    const u = (axis: 0 | 1 | 2) =>
      message.lower[axis] + (message.extent[axis] * message.positions[3 * i + axis]!) / 65535;
    const bent = message.normals?.subarray(2 * i, 2 * i + 2);
    const normal = bent && new Vector3(...decodeOctahedral(bent[0]!, bent[1]!));
    samples.push({ position: new Vector3(u(0), u(1), u(2)), normal });
  }
  return samples;
}

/** Along up, low and high, without outliers, m. */
export function heightsOf(samples: readonly Sample[], up: Vector3): Vector2 {
  const heights = samples.map(({ position }) => position.dot(up)).sort((a, b) => a - b);
  const at = (q: number) => heights[Math.round(q * (heights.length - 1))] ?? 0;
  return new Vector2(at(kTail), at(1 - kTail));
}

/** Square of the distance to the last of the nearest others, m². */
function thinness(sample: Sample, samples: readonly Sample[]): number {
  const nearest: number[] = new Array<number>(kNeighbours + 1).fill(Infinity);
  for (const { position } of samples) {
    const square = position.distanceToSquared(sample.position);
    if (square >= nearest[kNeighbours]!) continue;
    let i = kNeighbours;
    for (; i > 0 && nearest[i - 1]! > square; i -= 1) nearest[i] = nearest[i - 1]!;
    nearest[i] = square;
  }
  return nearest[Math.min(kNeighbours, samples.length - 1)]!;
}

export function boundsOf(all: readonly Sample[]): Bounds | undefined {
  if (all.length < 2) return undefined;
  const byThinness = all.map((sample) => ({ sample, thin: thinness(sample, all) })).sort((a, b) => a.thin - b.thin);
  const samples = byThinness.slice(0, Math.ceil(kKept * all.length)).map(({ sample }) => sample);
  const lower = new Vector3(Infinity, Infinity, Infinity);
  const upper = lower.clone().negate();
  for (const { position } of samples) {
    lower.min(position);
    upper.max(position);
  }
  return {
    samples,
    centre: lower.clone().add(upper).multiplyScalar(0.5),
    radius: Math.max(upper.distanceTo(lower) / 2, 1e-4),
  };
}
