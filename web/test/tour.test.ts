import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3, type Vector2 } from "three";
import type { Hand } from "../src/input/hand";
import type { Stroke } from "../src/input/stroke";
import { Tour } from "../src/input/tour";
import type { Session } from "../src/model/session";
import type { ToProgram } from "../src/protocol/messages";

function setUp(meets: (at: Vector2) => boolean) {
  const page = new EventTarget();
  Object.assign(globalThis, { window: page });
  const hand = { held: false, letGo: () => (hand.held = false) };
  const stroke = {
    led: false, presses: new Set<boolean>(), places: [] as number[],
    under: (at: Vector2) => (meets(at) ? { position: new Vector3(at.x, at.y, 0), normal: new Vector3(0, 0, 1), reach: 0.02 } : undefined),
    aim: (at: Vector2) => stroke.places.push(at.x), press: (on: boolean) => stroke.presses.add(on), rest: () => void (stroke.led = false),
  };
  const values = new Map<string, number>([["stiffness", 800], ["friction", 0.2]]);
  const session = { values, welcome: { settings: [{ key: "stiffness", least: 100, most: 1500 }, { key: "friction", least: 0, most: 1 }] } };
  const sent: ToProgram[] = [];
  const line = { open: true };
  const words: string[] = [];
  const tour = new Tour(session as unknown as Session, hand as unknown as Hand, stroke as unknown as Stroke,
    () => (hand.held = true), (message) => {
      if (!line.open) return false;
      sent.push(message);
      if (message.type === "set") values.set(message.key, message.value as number);
      return true;
    }, (text) => words.push(text));
  return { tour, hand, stroke, values, sent, line, words, page };
}

test("a tour presses, strokes, shows two materials and leaves everything as it was", () => {
  const { tour, hand, stroke, values, sent, words } = setUp(() => true);
  assert.ok(tour.start(0));
  for (let now = 0; now < 40_000; now += 16) tour.update(now);
  assert.deepEqual(sent.map((one) => (one.type === "set" ? [one.key, one.value] : one.type)),
    [["stiffness", 240], ["friction", 0.5], ["stiffness", 1500], ["friction", 0.02], ["stiffness", 800], ["friction", 0.2]]);
  assert.deepEqual([...values], [["stiffness", 800], ["friction", 0.2]]);
  assert.equal(words.length, 6);
  assert.equal(words.at(-1), "");
  assert.ok(stroke.presses.has(true) && Math.max(...stroke.places) > 0.1);
  assert.ok(!hand.held && !stroke.led);
});

test("whatever the person does ends it, and so does another page that takes the tool", () => {
  const { tour, hand, sent, words, page } = setUp(() => true);
  tour.start(0);
  page.dispatchEvent(Object.assign(new Event("keydown"), { key: "T" }));
  assert.ok(!hand.held && words.at(-1) === "");
  const count = words.length;
  page.dispatchEvent(new Event("pointerdown"));
  assert.equal(words.length, count, "it listens no longer");
  assert.deepEqual(sent, [], "nothing was changed yet");
  tour.start(0);
  hand.held = false;
  tour.update(16);
  assert.equal(words.at(-1), "");
});

test("what a lost connection kept it from putting back is put back when there is another", () => {
  const { tour, hand, values, line } = setUp(() => true);
  tour.start(0);
  for (let now = 0; now < 14_000; now += 16) tour.update(now);
  assert.equal(values.get("stiffness"), 240);
  line.open = false;
  hand.held = false;
  tour.update(14_016);
  tour.putBack();
  assert.equal(values.get("stiffness"), 240);
  line.open = true;
  tour.putBack();
  assert.equal(values.get("stiffness"), 800);
});

test("it begins where there is a surface, and not where there is none", () => {
  assert.ok(!setUp(() => false).tour.start(0));
  const { tour, stroke } = setUp((at) => at.x < -0.3);
  assert.ok(tour.start(0));
  tour.update(16);
  assert.ok(stroke.places[0]! < -0.3 - 0.15, "where a stroke stays on it");
  const thin = setUp((at) => Math.abs(at.x + 0.4) < 0.05);
  assert.ok(thin.tour.start(0), "where there is nothing wider");
});
