import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff } from "../src/protocol/backoff";
import { applyLink, readLink, settingFromText, writeLink, type View } from "../src/protocol/link";
import { parseMessage, type Setting } from "../src/protocol/messages";

const kNumber: Setting = { key: "k", label: "Stiffness", kind: "number", least: 0, most: 2000, value: 500 };
const kChoice: Setting = { key: "f", label: "Surface", kind: "choice", choices: ["a", "b"], value: "a" };
const kSwitch: Setting = { key: "s", label: "Texture", kind: "switch", value: false };

test("a link gives back what was put into it", () => {
  const values: [string, string | number | boolean][] = [
    ["stiffness", 812.5], ["field", "point set & more = 100 %"], ["texture", true],
  ];
  const link = readLink(writeLink("0f3a", values));
  assert.equal(link.token, "0f3a");
  assert.deepEqual([...link.values], values.map(([key, value]) => [key, String(value)]));
});

test("a link holds the view, to a billionth; what is none is said to be no setting", () => {
  const view: View = { eye: [1.23456789012, 0, -2e-7], target: [0, 0.5, 0], up: [0, 0, 1] };
  const link = readLink(writeLink("t", [["k", 4]], view));
  assert.deepEqual(link, { token: "t", values: new Map([["k", "4"]]), view: { ...view, eye: [1.23456789, 0, -2e-7] } });
  for (const text of ["", "1", "1,2,3,4,5,6,7,8,", "1,2,3,1,2,3,0,0,1", "1,2,3,4,5,6,0,0,0", "1,2,3,4,5,6,7,8,NaN", "1,2,3,4,5,1e300,0,0,1", "1,2,3,4,5,6,1e200,0,0", "1000,0,0,1000.0001,0,0,0,0,1", "1,2,3,4,5,6,7,8,9,10"]) {
    const { values, view: none } = readLink(`#t&view=${text}`);
    assert.equal(none, undefined);
    assert.deepEqual([...values], [["view", text]]);
  }
  assert.equal(applyLink(readLink(writeLink("t", [], view)), { settings: [] }, assert.fail, assert.fail), true, "it waits for clouds");
});

test("a token alone, nothing, and nonsense are borne", () => {
  assert.deepEqual(readLink("#abc"), { token: "abc", values: new Map() });
  assert.deepEqual(readLink(""), { token: "", values: new Map() });
  assert.deepEqual(readLink("#stiffness=3&k=4"), { token: "", values: new Map([["stiffness", "3"], ["k", "4"]]) });
  assert.equal(writeLink("", [["k", 4]]), "#k=4");
  assert.deepEqual([...readLink("#t&&=3&x&k=%zz").values], [["k", "%zz"]]);
});

test("a link's text becomes a value of the setting's kind, within its bounds", () => {
  assert.equal(settingFromText(kNumber, "812.5"), 812.5);
  assert.equal(settingFromText(kNumber, "2001"), undefined);
  assert.equal(settingFromText(kNumber, ""), undefined);
  assert.equal(settingFromText(kNumber, "Infinity"), undefined);
  assert.equal(settingFromText(kChoice, "b"), "b");
  assert.equal(settingFromText(kChoice, "c"), undefined);
  assert.equal(settingFromText(kSwitch, "true"), true);
  assert.equal(settingFromText(kSwitch, "1"), undefined);
});

test("what begins the run anew is set first and alone, and once", () => {
  const settings: Setting[] = [
    { ...kNumber, value: 500 },
    { key: "scene", label: "Scene", kind: "choice", choices: ["desk", "cube"], value: "cube", restarts: true },
    { key: "unit.cube", label: "Unit", kind: "choice", choices: ["mm", "inch"], value: "mm", restarts: true },
  ];
  const link = readLink(`#t&${kNumber.key}=700&scene=cube&unit.cube=inch`);
  const asked: unknown[] = [];
  const apply = (now: Setting[]) => applyLink(link, { settings: now }, (key, value) => asked.push([key, value]), (text) => asked.push(text));
  assert.equal(apply(settings), true, "the rest waits for the next run");
  assert.deepEqual(asked.splice(0), [["unit.cube", "inch"]]);
  assert.equal(apply(settings), false, "a run that begins as the one before is not begun again");
  assert.deepEqual(asked, [[kNumber.key, 700]]);
});

test("while there is nothing to set, a link waits", () => {
  const link = readLink("#t&k=700");
  const asked: unknown[] = [];
  const apply = (now: Setting[]) => applyLink(link, { settings: now }, (key, value) => asked.push([key, value]), (text) => asked.push(text));
  assert.equal(apply([]), true, "clouds are still read");
  assert.deepEqual(asked, []);
  assert.equal(apply([kNumber]), false);
  assert.deepEqual(asked, [["k", 700]]);
  assert.equal(applyLink(readLink("#t"), { settings: [] }, () => undefined, () => undefined), false, "there is nothing to wait for");
});

test("a recording has no settings for good: a link that asks for one is told so, and does not wait", () => {
  const said: string[] = [];
  const recording = { settings: [], timeline: { length: 4 } };
  assert.equal(applyLink(readLink("#t&k=700"), recording, () => assert.fail("nothing can be set"), (text) => said.push(text)), false);
  assert.deepEqual(said, ["the link's k = 700 is not a setting of this run"]);
});

test("waiting doubles up to its bound, scattered, and begins anew", () => {
  const slow = new Backoff(() => 1);
  assert.deepEqual(Array.from({ length: 7 }, () => slow.next()), [0.5, 1, 2, 4, 8, 10, 10]);
  const quick = new Backoff(() => 0);
  quick.next();
  assert.equal(quick.next(), 0.75);
  quick.reset();
  assert.equal(quick.next(), 0.375);
});

test("messages of unknown types are left aside, broken ones are errors", () => {
  assert.equal(parseMessage('{"type":"weather"}'), undefined);
  assert.equal(parseMessage("null"), undefined);
  assert.deepEqual(parseMessage('{"type":"pong","id":3}'), { type: "pong", id: 3 });
  assert.throws(() => parseMessage("{"), SyntaxError);
});
