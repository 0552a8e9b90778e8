// What a hand on keys does with the table, and a mouse with what it points at.

import assert from "node:assert/strict";
import { soon, until } from "./browser.mjs";
import { felt, waysInto } from "./heard.mjs";

const kPress = 6000; // ms

/** Moves the mouse there until a surface is under it; `frame`: of the page that has the view. */
export async function pointAt(page, x, y, frame = page) {
  await until("a surface is under the pointer", async () => {
    await page.mouse.move(x + 1, y);
    await page.mouse.move(x, y);
    return frame.evaluate(() => document.getElementById("view").classList.contains("graspable"));
  });
}

/** Holds a key until something is true. */
export async function hold(page, key, what, condition) {
  await page.keyboard.down(key);
  await until(what, condition);
  await page.keyboard.up(key);
}

export async function lift(page, device = 0) {
  const free = ({ touching, force }) => !touching && force === 0;
  await hold(page, "ArrowUp", "lifted, and no force in the air", async () => free(await felt(page, device)));
}

async function touchAnew(page, device) {
  await lift(page, device);
  await hold(page, "ArrowDown", "in contact", async () => (await felt(page, device)).touching);
  return felt(page, device);
}

/** Takes the tool, lifts it off and lowers it until it feels a little. */
export async function touchDown(page, device = 0) {
  await page.focus("#view");
  await page.keyboard.press("t");
  await until("taken", async () => (await felt(page, device)).taken);
  return touchAnew(page, device);
}

/**
 * Takes the tool and presses until it is 1.5 mm deeper and feels `more` newtons than at first; resolves to
 * what it felt at first. Both, as a guard that has just let go gives force back while the hand rests.
 */
export async function press(page, more, device = 0) {
  let first = await touchDown(page, device);
  for (let tries = 0; tries < 5; ++tries) {
    await page.keyboard.down("ArrowDown");
    const strong = await soon(async () => {
      const now = await felt(page, device);
      return now.force > first.force + more && waysInto(first, now).hip > 1.5e-3;
    }, kPress);
    await page.keyboard.up("ArrowDown");
    if (strong) return first;
    first = await touchAnew(page, device); // a step that came late has taken the force away
  }
  return assert.fail("pressed in vain");
}

/** From one state to the other the hand went in, and the proxy stayed on the level table. */
export function staysOnTable(first, then) {
  const ways = waysInto(first, then);
  assert.ok(ways.hip > 0.001, `the hand went ${ways.hip} m`);
  assert.ok(Math.abs(ways.proxy) < 0.1 * ways.hip, `the proxy went ${ways.proxy} m, the hand ${ways.hip}`);
  assert.ok(then.normal[2] > 0.99, "the table is level");
}

/**
 * Presses until something is true of what is felt. A step that came late takes the force away until the
 * hand has been lifted, as it should: then it is lifted and pressed again.
 */
export async function pressUntil(page, what, condition) {
  for (let tries = 0; tries < 6; ++tries) {
    await hold(page, "ArrowDown", "deeper", async () => (await felt(page)).depth > 1.5e-3);
    if (await soon(condition)) return;
    await lift(page);
  }
  assert.fail(`pressed in vain: ${what}`);
}
