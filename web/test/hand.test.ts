import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import { Hand } from "../src/input/hand";
import type { ToProgram } from "../src/protocol/messages";
import type { ToolShape } from "../src/view/tool_shape";

const toolAt = (x: number, y: number, z: number) =>
  ({ hipPosition: new Vector3(x, y, z), shape: undefined, turn: new Quaternion(), opening: 0 });

// A clock of our own: timers ring when the test lets time pass.
let now = 0;
let timers: { at: number; ring: () => void; id: number }[] = [];
let sent: { at: number; message: ToProgram }[] = [];

function pass(ms: number): void {
  const until = now + ms;
  for (;;) {
    const next = timers.filter(({ at }) => at <= until).sort((a, b) => a.at - b.at)[0];
    if (next === undefined) break;
    now = next.at;
    timers = timers.filter(({ id }) => id !== next.id);
    next.ring();
  }
  now = until;
}

beforeEach(() => {
  now = 1000;
  timers = [];
  sent = [];
  let last = 0;
  mock.method(performance, "now", () => now);
  mock.method(globalThis, "clearTimeout", (id: number) => (timers = timers.filter((timer) => timer.id !== id)));
  const setTimeout = (ring: () => void, wait: number) => (timers.push({ at: now + wait, ring, id: (last += 1) }), last);
  Object.defineProperty(globalThis, "window", { value: { setTimeout }, configurable: true });
});
afterEach(() => mock.restoreAll());

function newHand(): Hand {
  return new Hand((message) => sent.push({ at: now, message }), () => undefined);
}

test("the hand speaks 125 times a second at most, and the last place is told", () => {
  const hand = newHand();
  hand.take(0, toolAt(0, 0, 0));
  for (let i = 1; i <= 1000; i += 1) {
    pass(1);
    hand.moveTo(new Vector3(i, 0, 0));
  }
  pass(20);
  const gaps = sent.slice(1).map(({ at }, i) => at - sent[i]!.at);
  assert.ok(Math.min(...gaps) >= 8, `${Math.min(...gaps)} ms between two`);
  assert.ok(sent.length > 100, `${sent.length} messages in a second`);
  const { message } = sent.at(-1)!;
  assert.ok(message.type === "hand" && message.position[0] === 1000);
});

test("where the program leads it, it tells from where the place is seen, until something else moves it", () => {
  const hand = newHand();
  hand.take(0, toolAt(0, 0, 0));
  pass(10);
  hand.goTo(new Vector3(1, 0, 0), new Vector3(0, 0, 5), 2);
  pass(10);
  const led = sent.at(-1)!.message;
  assert.ok(led.type === "hand");
  assert.deepEqual([led.eye, led.force], [[0, 0, 5], 2]);
  hand.moveTo(new Vector3(2, 0, 0));
  pass(10);
  const { message } = sent.at(-1)!;
  assert.ok(message.type === "hand" && message.eye === undefined && message.force === undefined);
});

test("a hand that is let go says so at once, and nothing after", () => {
  const hand = newHand();
  hand.take(0, toolAt(0, 0, 0));
  hand.moveTo(new Vector3(1, 0, 0));
  hand.letGo();
  pass(100);
  hand.moveTo(new Vector3(2, 0, 0));
  assert.deepEqual(sent.map(({ message }) => message.type), ["hand", "release"]);
});

test("places that are no numbers are not told, and a nudge goes as the eye sees it", () => {
  const hand = newHand();
  hand.take(0, toolAt(0, 0, 1));
  pass(10);
  hand.moveTo(new Vector3(NaN, 0, 0));
  pass(10);
  assert.equal(sent.length, 1);
  hand.nudge(new PerspectiveCamera(), 0.5, 0.25, 2);
  const { message } = sent.at(-1)!;
  assert.ok(message.type === "hand");
  assert.deepEqual(message.position, [0.5, 0.25, -1]);
});

const near = (found: readonly number[], wanted: readonly number[]) =>
  found.forEach((value, i) => assert.ok(Math.abs(value - wanted[i]!) < 1e-12, `${String(found)}, not ${String(wanted)}`));

test("a tool that turns begins as it is held, and turns about directions that the eye sees", () => {
  const hand = newHand();
  const turn = new Quaternion(0, 0, Math.sin(0.2), Math.cos(0.2));
  hand.take(0, { ...toolAt(0, 0, 0), shape: { extent: 0.1 } as ToolShape, turn, opening: 0.02 });
  pass(10);
  const first = sent.at(-1)!.message;
  assert.ok(first.type === "hand");
  near(first.orientation!, turn.toArray());
  assert.equal(first.opening, 0.02);
  const camera = new PerspectiveCamera();
  camera.quaternion.set(0, Math.SQRT1_2, 0, Math.SQRT1_2); // it looks along -x: towards the eye is x, right is -z
  hand.turn(camera, 0, 0, 0.3);
  hand.turn(camera, -0.1, 0, 0);
  hand.open(0.5);
  pass(10);
  const last = sent.at(-1)!.message;
  assert.ok(last.type === "hand");
  const wanted = new Quaternion(0, 0, Math.sin(0.05), Math.cos(0.05))
    .multiply(new Quaternion(Math.sin(0.15), 0, 0, Math.cos(0.15))).multiply(turn);
  near(last.orientation!, wanted.toArray());
  near([last.opening!], [0.07]);
  hand.open(-10);
  pass(10);
  const closed = sent.at(-1)!.message;
  assert.ok(closed.type === "hand" && closed.opening === 0, "no farther than closed");
});

test("a point is not turned, and its messages say nothing of turns", () => {
  const hand = newHand();
  hand.take(0, toolAt(0, 0, 0));
  pass(10);
  const count = sent.length;
  hand.turn(new PerspectiveCamera(), 1, 0, 0);
  hand.open(1);
  pass(10);
  assert.equal(sent.length, count);
  assert.ok(!("orientation" in sent[0]!.message));
});
