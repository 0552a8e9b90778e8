// A press on the surface under the pointer, with a made-up tool.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Vector2, Vector3 } from "three";
import type { Hand } from "../src/input/hand";
import { Stroke } from "../src/input/stroke";
import type { World } from "../src/view/world";

const kReach = 0.01; // m

function setUp(lift = 0) {
  const camera = new PerspectiveCamera();
  camera.position.set(0, 0, 1);
  const tool = {
    hipPosition: new Vector3(0, 0, lift + 2 * kReach), proxyPosition: new Vector3(0, 0, lift), normal: new Vector3(0, 0, 1), force: new Vector3(0, 0, 0.1),
    touching: false, behind: false, weak: false, faulty: false, reach: () => lift,
  };
  const seen = () => ({ position: new Vector3(), normal: new Vector3(0, 0, 1), reach: kReach, inward: new Vector3() });
  const world = { tools: [tool], stage: { camera }, surfaceAlong: seen } as unknown as World;
  const aims: number[] = []; // heights that the hand is asked to go to, m
  const forces: (number | undefined)[] = []; // that it comes down with, where the program leads it
  const hand = {
    device: 0, held: true, moveTo: (place: Vector3) => aims.push(place.z),
    goTo: (place: Vector3, eye: Vector3, force?: number) => {
      assert.equal(eye.z, 1);
      forces.push(force);
      aims.push(place.z);
    },
  };
  const stroke = new Stroke(world, hand as unknown as Hand, () => undefined);
  stroke.aim(new Vector2(0, 0), false);
  stroke.press(true);
  const at = (now: number, height: number, touching: boolean, weak: boolean) => {
    Object.assign(tool, { touching, weak });
    tool.hipPosition.z = height;
    stroke.update(now);
    return aims.at(-1)!;
  };
  assert.ok(at(1000, lift + 2 * kReach, false, false) < lift, "from above it presses");
  return { at, tool, stroke, forces };
}

test("a press that is soft and deep is lifted, and presses again once it is out", () => {
  const { at } = setUp();
  assert.ok(at(1016, -kReach, true, true) < 0, "not deep yet");
  at(1032, -2.5 * kReach, true, true);
  assert.ok(at(1200, -2.5 * kReach, true, true) > kReach, "up");
  assert.ok(at(1216, -0.5 * kReach, true, false) > kReach, "all the way up");
  assert.ok(at(1400, 2 * kReach, false, false) < 0, "and again");
});

test("a press on what is as stiff as asked for stays", () => {
  const { at } = setUp();
  assert.ok(at(1032, -2.5 * kReach, true, false) < 0);
});

test("a tool is pressed until what is lowest of it would be below the surface, and hovers with it above", () => {
  const lift = 0.05;
  const { at } = setUp(lift);
  const pressed = at(1016, lift + 0.2 * kReach, false, false);
  const point = setUp().at(1016, 0.2 * kReach, false, false);
  assert.ok(Math.abs(pressed - lift - point) < 1e-9, `the handle goes to ${pressed}, a point to ${point}`);
  at(1032, lift - 2.5 * kReach, true, true);
  assert.ok(at(1200, lift - 2.5 * kReach, true, true) > lift + kReach, "soft and deep: up");
});

test("a new press first goes above its place, and comes down there with its force", () => {
  const { at, tool, stroke, forces } = setUp();
  assert.equal(forces.at(-1), 1, "down, with the force of the press");
  at(1016, -0.1 * kReach, true, false);
  stroke.press(false);
  tool.hipPosition.x = 20 * kReach;
  tool.proxyPosition.x = 20 * kReach;
  at(1032, -0.1 * kReach, true, false);
  assert.equal(forces.at(-1), undefined, "through free space");
  stroke.press(true);
  assert.ok(at(1048, -0.1 * kReach, true, false) > kReach, "above, although it still touches elsewhere");
  assert.ok(at(1064, 0, false, false) > kReach);
  tool.hipPosition.x = 0;
  assert.ok(at(1800, 2 * kReach, false, false) < 0);
  assert.equal(forces.at(-1), 1);
});
