// Points on clouds as they are drawn: under a pointer, and nearest to a tool.

import { Vector3, type Ray } from "three";
import type { Cloud } from "./cloud";

const kMost = 100_000; // points of a cloud that are looked at
const kReach = 1.5; // spacings around a ray in which a surface has some points for certain
const kFew = 3; // points that are a surface, not outliers
const kMany = 2000; // that are enough of one
const kLayer = 3; // reaches along a ray that one surface takes
const kStiff = 0.02; // of the reach, squared: how little few points tilt a surface
// Of points all around a ray the mean is on it. Where the ray is d reaches beyond an edge, it lies 0.34, 0.63 and
// 0.85 reaches aside for d = 0, 0.5 and 0.8; these lead to about 0.3 reaches inside of the edge.
const kInside = 0.15; // reaches
const kInward = 1.6;

/** Where a ray meets a surface. */
export interface Seen {
  position: Vector3;
  normal: Vector3; // towards the eye
  reach: number; // how far points may lie from the ray, m
  inward: Vector3; // from the ray to the position, which is on the surface beside an edge, too, m
}

function strideOf(cloud: Cloud): number {
  return Math.max(1, Math.ceil(cloud.count / kMost));
}

/** Of the points that are looked at, m. */
function spacingOf(cloud: Cloud): number {
  return cloud.spacing * Math.sqrt(strideOf(cloud));
}

/** Calls `take` with the position of every stride-th point; what is shown is what can be picked. */
function eachPoint(cloud: Cloud, take: (x: number, y: number, z: number) => void): void {
  const { position, scale, geometry } = cloud.points;
  const units = geometry.getAttribute("position").array;
  const stride = strideOf(cloud);
  const [sx, sy, sz] = [scale.x / 65535, scale.y / 65535, scale.z / 65535];
  for (let i = 0; i < cloud.count; i += stride) {
    take(position.x + sx * units[3 * i]!, position.y + sy * units[3 * i + 1]!, position.z + sz * units[3 * i + 2]!);
  }
}

/** The nearest of the surfaces that a ray meets; `slope`: m beside it that count, a metre of its length. */
export function surfaceAlong(ray: Ray, clouds: readonly Cloud[], slope: number): Seen | undefined {
  let nearest: Seen | undefined;
  let least = Infinity;
  for (const cloud of clouds) {
    const found = meets(ray, cloud, slope);
    const far = found?.position.distanceTo(ray.origin) ?? Infinity;
    if (far < least) [nearest, least] = [found, far];
  }
  return nearest;
}

interface Hit {
  along: number; // and aside of the ray, m
  u: number;
  v: number;
  weight: number;
}

function meets(ray: Ray, cloud: Cloud, slope: number): Seen | undefined {
  const { origin, direction } = ray;
  const sideways = new Vector3(direction.z, direction.x, direction.y).cross(direction).normalize();
  const axes = [sideways, direction.clone().cross(sideways)] as const;
  const near = kReach * spacingOf(cloud);
  const hits: Hit[] = [];
  const offset = new Vector3();
  eachPoint(cloud, (x, y, z) => {
    offset.set(x, y, z).sub(origin);
    const along = offset.dot(direction);
    const reach = Math.max(near, slope * along);
    const part = (offset.lengthSq() - along * along) / (reach * reach);
    if (along > 0 && part < 1) hits.push({ along, u: offset.dot(axes[0]), v: offset.dot(axes[1]), weight: 1 - part });
  });
  if (hits.length > kMany) thin(hits);
  hits.sort((a, b) => a.along - b.along);
  for (let first = 0; first + kFew <= hits.length; first += 1) {
    const { along } = hits[first]!;
    const reach = Math.max(near, slope * along);
    const layer = hits.slice(first).filter((hit) => hit.along < along + kLayer * reach);
    if (layer.length >= kFew) return planeOf(ray, axes, layer, reach);
  }
  return undefined;
}

/** Leaves one in so many that kMany are left at most. */
function thin(hits: Hit[]): void {
  const stride = Math.ceil(hits.length / kMany);
  for (let i = 0; i * stride < hits.length; i += 1) hits[i] = hits[i * stride]!;
  hits.length = Math.ceil(hits.length / stride);
}

/** By least squares: along = a + b u + c v. */
function planeOf(ray: Ray, [U, V]: readonly [Vector3, Vector3], layer: readonly Hit[], reach: number): Seen {
  const mean = (of: (hit: Hit) => number) => layer.reduce((sum, hit) => sum + hit.weight * of(hit), 0) / weight;
  const weight = layer.reduce((sum, hit) => sum + hit.weight, 0);
  const [u, v, along] = [mean((hit) => hit.u), mean((hit) => hit.v), mean((hit) => hit.along)];
  const stiff = kStiff * reach * reach;
  const uu = mean((hit) => (hit.u - u) ** 2) + stiff;
  const vv = mean((hit) => (hit.v - v) ** 2) + stiff;
  const uv = mean((hit) => (hit.u - u) * (hit.v - v));
  const ua = mean((hit) => (hit.u - u) * (hit.along - along));
  const va = mean((hit) => (hit.v - v) * (hit.along - along));
  const b = (ua * vv - va * uv) / (uu * vv - uv * uv);
  const c = (va * uu - ua * uv) / (uu * vv - uv * uv);
  const inward = new Vector3().addScaledVector(U, u).addScaledVector(V, v);
  const aside = inward.length();
  inward.setLength(kInward * Math.max(0, aside - kInside * reach));
  const depth = along + b * (inward.dot(U) - u) + c * (inward.dot(V) - v);
  const normal = ray.direction.clone().negate().addScaledVector(U, b).addScaledVector(V, c).normalize();
  return { position: ray.at(depth, new Vector3()).add(inward), normal, reach, inward };
}

/** The nearest point of all, and the spacing of its cloud, m. */
export function nearestTo(position: Vector3, clouds: readonly Cloud[]): { point: Vector3; spacing: number } | undefined {
  let least = Infinity;
  let nearest: { point: Vector3; spacing: number } | undefined;
  for (const cloud of clouds) {
    const [x0, y0, z0] = [position.x, position.y, position.z];
    const found = new Vector3(Infinity);
    eachPoint(cloud, (x, y, z) => {
      const square = (x - x0) ** 2 + (y - y0) ** 2 + (z - z0) ** 2;
      if (square >= least) return;
      least = square;
      found.set(x, y, z);
    });
    if (found.x !== Infinity) nearest = { point: found, spacing: spacingOf(cloud) };
  }
  return nearest;
}
