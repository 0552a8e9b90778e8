// Unit vectors in two bytes. Cigolini and others, JCGT 3(2), 2014: "Survey of Efficient
// Representations for Independent Unit Vectors". The cloud's shader decodes in the same manner.

import type { Vector } from "./messages";

function signOf(x: number): number {
  return x < 0 ? -1 : 1;
}

export function decodeOctahedral(u: number, v: number): Vector {
  let x = Math.max(-1, u / 127);
  let y = Math.max(-1, v / 127);
  const z = 1 - Math.abs(x) - Math.abs(y);
  if (z < 0) [x, y] = [(1 - Math.abs(y)) * signOf(x), (1 - Math.abs(x)) * signOf(y)];
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

export function encodeOctahedral([x, y, z]: Vector): [number, number] {
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
  let u = x / sum;
  let v = y / sum;
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * signOf(u), (1 - Math.abs(u)) * signOf(v)];
  return [Math.round(u * 127), Math.round(v * 127)];
}
