import assert from "node:assert/strict";
import { test } from "node:test";
import { Keys, type Actions } from "../src/input/keys";

const page = new EventTarget();
Object.assign(globalThis, { window: page, document: { querySelector: () => null }, Element: class {} });

function key(type: "keydown" | "keyup", name: string, timeStamp: number, more = {}): void {
  const event = Object.assign(new Event(type), { key: name, ...more });
  Object.defineProperty(event, "timeStamp", { value: timeStamp });
  page.dispatchEvent(event);
}

const near = (found: number[], wanted: number[]) =>
  found.forEach((value, i) => assert.ok(Math.abs(value - wanted[i]!) < 1e-9, `${String(found)}, not ${String(wanted)}`));

test("a key counts for as long as it was held down, however seldom one looks", () => {
  const often = new Keys({} as Actions);
  const seldom = new Keys({} as Actions);
  const sum = [0, 0, 0, 0, 0, 0, 0];
  const look = (now: number) => often.take(now).forEach((part, axis) => (sum[axis]! += part));
  key("keydown", "ArrowRight", 1000);
  for (let now = 1000; now < 1300; now += 10) look(now);
  key("keydown", "ArrowRight", 1150); // the keyboard repeats it
  key("keyup", "ArrowRight", 1300);
  look(1310);
  near(sum, [0.3, 0, 0, 0, 0, 0, 0]);
  near(seldom.take(1400), [0.3, 0, 0, 0, 0, 0, 0]);
  near(seldom.take(1500), [0, 0, 0, 0, 0, 0, 0]);
});

test("a key that is let go between two pictures has moved the tool", () => {
  const keys = new Keys({} as Actions);
  key("keydown", "PageUp", 1010, { shiftKey: true });
  key("keyup", "PageUp", 1060);
  near(keys.take(1200), [0, 0, 4 * 0.05, 0, 0, 0, 0]);
});

test("a page that stood still moves the tool no farther than half a second's way", () => {
  const keys = new Keys({} as Actions);
  key("keydown", "ArrowDown", 0);
  near(keys.take(60_000), [0, -0.5, 0, 0, 0, 0, 0]);
  key("keyup", "ArrowDown", 60_100);
  near(keys.take(60_200), [0, -0.1, 0, 0, 0, 0, 0]);
});

test("arrows and the space bar go through a recording, and up and down still turn the view", () => {
  const keys = new Keys({} as Actions);
  const steps: number[] = [];
  let toggled = 0;
  keys.timeLine = { step: (seconds) => steps.push(seconds), toggle: () => (toggled += 1) };
  key("keydown", "ArrowRight", 1000);
  key("keydown", "ArrowLeft", 1010, { shiftKey: true });
  key("keydown", "ArrowLeft", 1020, { altKey: true });
  key("keydown", " ", 1030);
  key("keydown", " ", 1040, { repeat: true });
  assert.deepEqual(steps, [1, -10, -0.05]);
  assert.equal(toggled, 1);
  key("keydown", "ArrowUp", 1100);
  key("keyup", "ArrowUp", 1200);
  near(keys.take(1200), [0, 0.1, 0, 0, 0, 0, 0]);
});

test("letters turn a tool and open its gripper while they are down, also with Shift, and not without single letters", () => {
  const keys = new Keys({} as Actions);
  key("keydown", "l", 1000);
  key("keydown", "I", 1000, { shiftKey: true });
  key("keyup", "I", 1100);
  key("keyup", "L", 1100);
  key("keydown", "o", 1200);
  key("keyup", "o", 1300);
  near(keys.take(1300), [0, 0, 0, -0.4, 0.4, 0, 0.1]);
  keys.single = false;
  key("keydown", "l", 2000);
  near(keys.take(2100), [0, 0, 0, 0, 0, 0, 0]);
});

test("a key that comes up under another name, as with Shift, is up", () => {
  const keys = new Keys({} as Actions);
  key("keydown", ",", 1000, { code: "Comma" });
  key("keyup", "<", 1100, { code: "Comma", shiftKey: true });
  near(keys.take(1100), [0, 0, 0, 0, 0, 0.1, 0]);
  near(keys.take(1500), [0, 0, 0, 0, 0, 0, 0]);
});
