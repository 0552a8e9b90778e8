import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import { Hand } from "../src/input/hand";
import { Input } from "../src/input/input";
import type { Keys } from "../src/input/keys";
import type { SpaceMouse } from "../src/input/space_mouse";
import { Stroke } from "../src/input/stroke";
import type { ToProgram } from "../src/protocol/messages";
import type { World } from "../src/view/world";

const tool = { hipPosition: new Vector3(), shape: undefined, turn: new Quaternion(), opening: 0 };

function pad(buttons: number): object {
  const held = (k: number) => ({ pressed: (buttons & (1 << k)) !== 0 });
  return { connected: true, id: "pad", axes: [0, 0, 0, 0], buttons: [0, 1, 2, 3].map(held) };
}

test("with a controller and a 3D mouse, a button that is held is pressed once", () => {
  Object.defineProperty(globalThis, "window", { value: globalThis, configurable: true });
  let pads = [pad(0)];
  Object.defineProperty(globalThis, "navigator", { value: { getGamepads: () => pads }, configurable: true });
  const said: ToProgram[] = [];
  const hand = new Hand((message) => void said.push(message), () => undefined);
  const stage = { pixelAt: () => 1e-3, height: 600, camera: new PerspectiveCamera() };
  const world = { stage, navigation: { turn: () => undefined } } as unknown as World;
  const keys = { take: () => [0, 0, 0, 0, 0, 0, 0] } as unknown as Keys;
  const mouse = { read: () => ({ right: 0, up: 0, away: 0, depth: 0, turn: [0, 0, 0], open: 0, buttons: 4 }) } as unknown as SpaceMouse;
  let taken = 0;
  const input = new Input(world, hand, keys, mouse, new Stroke(world, hand, () => undefined), () => {
    taken += 1;
    hand.take(0, tool);
    return true;
  });
  input.update(0);
  pads = [pad(1)];
  for (let i = 1; i < 5; i += 1) input.update(16 * i);
  assert.equal(taken, 1);
  hand.letGo();
  for (let i = 5; i < 9; i += 1) input.update(16 * i);
  assert.equal(taken, 1, "held since it was let go");
  pads = [pad(8)];
  hand.take(0, tool);
  const pressed: number[] = [];
  hand.press = (buttons) => void pressed.push(buttons);
  for (let i = 9; i < 12; i += 1) input.update(16 * i);
  assert.deepEqual(pressed, [12, 12, 12], "the buttons of both");
});
