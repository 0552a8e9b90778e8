// Presses on and beside the surface, with a made-up view.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Hand } from "../src/input/hand";
import { PointerInput } from "../src/input/pointer";
import type { Stroke } from "../src/input/stroke";
import type { World } from "../src/view/world";

function setUp() {
  const canvas = Object.assign(new EventTarget(), {
    getBoundingClientRect: () => ({ left: 0, top: 0, width: 200, height: 100 }), setPointerCapture: () => undefined,
  }) as unknown as HTMLCanvasElement;
  const world = { navigation: { turnByDrag: () => undefined }, dragging: false } as unknown as World;
  // The left half shows a surface.
  const stroke = { under: ({ x }: { x: number }) => (x < 0 ? {} : undefined), press: () => undefined, aim: () => undefined };
  const pointer = new PointerInput(
    canvas, canvas, world, { held: false } as Hand, stroke as unknown as Stroke, () => true, () => true);
  const send = (type: string, clientX: number) => {
    const what = { pointerId: 1, pointerType: "mouse", button: 0, clientX, clientY: 50 };
    canvas.dispatchEvent(Object.assign(new Event(type), what));
  };
  return { pointer, send };
}

test("a press beside the surface is a miss, unless it was a drag or the browser took it away", () => {
  const { pointer, send } = setUp();
  for (const [end, to] of [["pointercancel", 150], ["pointerup", 170]] as const) {
    send("pointerdown", 150);
    send(end, to);
    assert.equal(pointer.missed, -Infinity, `${end} at ${to}`);
  }
  send("pointerdown", 150);
  send("pointerup", 151);
  assert.ok(pointer.missed > 0);
});

test("a press on the surface ends what is said of a miss before it", () => {
  const { pointer, send } = setUp();
  send("pointerdown", 150);
  send("pointerup", 150);
  send("pointerdown", 50);
  assert.equal(pointer.missed, -Infinity);
});
