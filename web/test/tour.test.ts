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
    under: (at: Vector2) => (meets(at) ? { place: new Vector3(at.x, at.y, 0), normal: new Vector3(0, 0, 1), reach: 0.02 } : undefined),
    aim: (at: Vector2) => stroke.places.push(at.x), press: (on: boolean) => stroke.presses.add(on), rest: () => void (stroke.led = false),
  };
  const values = new Map<string, number>([["stiffness", 800], ["friction", 0]]);
  const session = { values, welcome: { presets: ["default", "paper", "soft", "glass"] } };
  const sent: ToProgram[] = [];
  const words: string[] = [];
  const tour = new Tour(session as unknown as Session, hand as unknown as Hand, stroke as unknown as Stroke,
    () => (hand.held = true), (message) => {
      sent.push(message);
      if (message.type === "preset") values.set("stiffness", 500).set("friction", 0);
    }, (text) => words.push(text));
  return { tour, hand, stroke, sent, words, page };
}

test("a tour presses, strokes, shows two materials and leaves everything as it was", () => {
  const { tour, hand, stroke, sent, words } = setUp(() => true);
  assert.ok(tour.start(0));
  for (let now = 0; now < 40_000; now += 16) tour.update(now);
  assert.deepEqual(sent.map((one) => (one.type === "preset" ? one.name : one.type)),
    ["default", "default", "soft", "glass", "default", "default", "set"], "friction is as it was");
  assert.deepEqual(sent.at(-1), { type: "set", key: "stiffness", value: 800 });
  assert.equal(words.length, 6);
  assert.equal(words.at(-1), "");
  assert.ok(stroke.presses.has(true) && Math.max(...stroke.places) > 0.1);
  assert.ok(!hand.held && !stroke.led);
});

test("whatever the person does ends it, and so does another page that takes the tool", () => {
  const { tour, hand, sent, words, page } = setUp(() => true);
  tour.start(0);
  page.dispatchEvent(Object.assign(new Event("keydown"), { key: "t" })); // lets go by itself
  assert.ok(hand.held);
  page.dispatchEvent(new Event("pointerdown"));
  assert.ok(!hand.held && words.at(-1) === "" && sent.at(-1)?.type === "set");
  const count = sent.length;
  page.dispatchEvent(new Event("pointerdown"));
  assert.equal(sent.length, count, "it listens no longer");
  tour.start(0);
  hand.held = false;
  tour.update(16);
  assert.equal(words.at(-1), "");
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
