// The side from which a scene is seen first: the one that most of its surface faces, with nothing in front.

import { Vector3 } from "three";
import type { Bounds, Sample } from "./bounds";

const kRaise = 0.5; // of the distance, upward
const kAside = 0.55; // radians beside an axis: what stands along the axes has depth there
const kSides = 8; // that are tried, the same whatever is there: noise gives no other at the next start
const kCells = 14; // across a coarse picture that determines what hides what
const kLayer = 0.06; // of the radius: what is nearer to the foremost than this is not hidden by it
const kFavour = 0.25; // of the score, for the usual side and against the far one
const kFavourCameras = 0.6; // where the usual one is the cameras'
const kUnknown = 0.5; // cosine where there is no normal

/** From the middle to the eye. Of the sides all around, those count more that `cameras` look from: directions towards them. */
export function firstDirection(up: Vector3, cameras: readonly Vector3[], bounds: Bounds): Vector3 {
  const first = new Vector3().crossVectors(new Vector3(Math.abs(up.x) < 0.9 ? 1 : 0, Math.abs(up.x) < 0.9 ? 0 : 1, 0), up);
  const usual = cameras.reduce((sum, towards) => sum.add(towards), new Vector3());
  usual.addScaledVector(up, -usual.dot(up));
  first.normalize().applyAxisAngle(up, kAside);
  if (usual.lengthSq() < 1e-12) usual.copy(first);
  usual.normalize();
  const favour = cameras.length > 0 ? kFavourCameras : kFavour;
  let best = first;
  let most = -Infinity;
  for (let i = 0; i < kSides; i += 1) {
    const level = first.clone().applyAxisAngle(up, (2 * Math.PI * i) / kSides);
    const side = level.clone().addScaledVector(up, kRaise).normalize();
    const score = (seenFrom(side, up, bounds) + 1e-9) * (1 + favour * level.dot(usual));
    if (score > most) [best, most] = [side, score];
  }
  return best;
}

/** How much of the surface shows its face to an eye far away: the cosines of what nothing hides. */
function seenFrom(direction: Vector3, up: Vector3, { samples, centre, radius }: Bounds): number {
  const right = new Vector3().crossVectors(up, direction).normalize();
  const upward = new Vector3().crossVectors(direction, right);
  const cells = new Map<number, { nearest: number; samples: [Sample, number][] }>();
  for (const sample of samples) {
    const from = sample.position.clone().sub(centre).divideScalar(radius);
    const [u, v] = [from.dot(right), from.dot(upward)].map((x) => Math.floor(((x + 1) / 2) * kCells));
    const near = from.dot(direction);
    const cell = cells.get(kCells * v! + u!) ?? { nearest: -Infinity, samples: [] };
    cells.set(kCells * v! + u!, cell);
    cell.nearest = Math.max(cell.nearest, near);
    cell.samples.push([sample, near]);
  }
  let seen = 0;
  for (const cell of cells.values()) {
    for (const [{ normal }, near] of cell.samples) {
      if (near > cell.nearest - kLayer) seen += Math.max(0, normal?.dot(direction) ?? kUnknown);
    }
  }
  return seen;
}
