import assert from "node:assert/strict";
import { test } from "node:test";
import { BufferAttribute, BufferGeometry, Object3D, Ray, Vector3 } from "three";
import type { Cloud } from "../src/view/cloud";
import { nearestTo, surfaceAlong } from "../src/view/pick";

/** A cloud as it is drawn, of places in a box of 2 m around the origin. */
function cloudOf(places: readonly Vector3[], spacing: number): Cloud {
  const units = Uint16Array.from(places.flatMap((p) => p.toArray().map((x) => Math.round(((x + 1) / 2) * 65535))));
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(units, 3, true));
  const points = Object.assign(new Object3D(), { geometry });
  points.position.set(-1, -1, -1);
  points.scale.set(2, 2, 2);
  return { points, count: places.length, spacing } as unknown as Cloud;
}

function square(spacing: number, at: (x: number, y: number) => Vector3): Vector3[] {
  const places: Vector3[] = [];
  const half = Math.round(0.5 / spacing);
  for (let i = -half; i <= half; i += 1) for (let j = -half; j <= half; j += 1) places.push(at(i * spacing, j * spacing));
  return places;
}

const kDown = new Vector3(0, 0, -1);
const from = (x: number, y: number) => new Ray(new Vector3(x, y, 0.9), kDown.clone());
const level = square(0.01, (x, y) => new Vector3(x, y, 0));

test("a ray meets a level surface and a slanted one where they are, with their normals", () => {
  for (const slope of [0, 0.5, 1.2]) {
    const cloud = cloudOf(square(0.01, (x, y) => new Vector3(x, y, slope * x)), 0.01);
    const normal = new Vector3(-slope, 0, 1).normalize();
    for (const [x, y] of [[0.003, 0.111], [-0.207, 0.052], [0.31, -0.3]] as const) {
      const seen = surfaceAlong(from(x, y), [cloud], 0);
      assert.ok(seen !== undefined);
      assert.ok(Math.abs(seen.position.z - slope * x) < 2e-3, `slope ${slope}: ${seen.position.z} at ${x}`);
      assert.ok(seen.normal.angleTo(normal) < 0.1, `slope ${slope}: ${seen.normal.toArray().join(",")}`);
    }
  }
});

test("of two surfaces the nearer one is met; a stray in front is none, and beside all there is nothing", () => {
  const far = cloudOf(square(0.01, (x, y) => new Vector3(x, y, -0.4)), 0.01);
  const near = cloudOf([...level, new Vector3(0.1, 0.1, 0.5), new Vector3(0.102, 0.1, 0.5)], 0.01);
  const seen = surfaceAlong(from(0.1, 0.1), [far, near], 0);
  assert.ok(Math.abs(seen!.position.z) < 1e-3, `${seen!.position.z}`);
  assert.equal(surfaceAlong(from(0.8, 0.1), [far, near], 0), undefined);
  assert.equal(surfaceAlong(new Ray(new Vector3(0, 0, -0.9), kDown.clone()), [far, near], 0), undefined, "behind the eye");
});

// A surface ends about half a spacing beyond its last points.
test("beside an edge the place is on the surface", () => {
  const cloud = cloudOf(level, 0.01);
  for (const beyond of [0, 0.003, 0.006]) {
    const seen = surfaceAlong(from(0.5 + beyond, 0.013), [cloud], 0);
    assert.ok(seen !== undefined && seen.position.x < 0.503 && seen.position.x > 0.48, `${beyond}: ${seen?.position.x}`);
  }
  const inside = surfaceAlong(from(0.2, 0.013), [cloud], 0);
  assert.ok(inside!.position.distanceTo(new Vector3(0.2, 0.013, 0)) < 1e-3);
});

test("the nearest point of all clouds", () => {
  const clouds = [cloudOf(level, 0.01), cloudOf([new Vector3(0.1, 0.1, 0.2)], 0.02)];
  assert.equal(nearestTo(new Vector3(0.1, 0.1, 0.15), clouds)?.spacing, 0.02);
  const found = nearestTo(new Vector3(0.204, -0.101, 0.08), clouds);
  assert.ok(found!.point.distanceTo(new Vector3(0.2, -0.1, 0)) < 1e-3);
  assert.equal(nearestTo(new Vector3(), []), undefined);
});
