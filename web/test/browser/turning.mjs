// A tool that turns, in a hand that turns it. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./browser.mjs";
import { hands, kSmall, text, withProgram } from "./with_page.mjs";

const withBox = (act) => withProgram({ points: 4000, box: [0.06, 0.04, 0.02] }, kSmall, act);

const angle = ([, , , w]) => 2 * Math.acos(Math.min(1, Math.abs(w)));

test("a drag with Shift turns the tool and leaves view and hand where they are; the wheel rolls it, keys turn it", () =>
  withBox(async (page, program) => {
    const axis = () => page.locator("line.axis-x").getAttribute("x2");
    const newest = () => hands(program).at(-1);
    await page.focus("#view");
    await page.keyboard.press("m");
    await page.keyboard.press("t");
    await until("held", () => newest()?.orientation !== undefined);
    assert.ok(angle(newest().orientation) < 1e-6);
    const [view, place] = [await axis(), newest().position];
    await page.keyboard.down("Shift");
    await page.mouse.move(300, 250);
    await page.mouse.down();
    await page.mouse.move(400, 250, { steps: 5 });
    await page.mouse.up();
    await until("turned", () => angle(newest().orientation) > 0.3);
    const { height } = await page.locator("#view").boundingBox();
    await until("as far as it was dragged", () => Math.abs(angle(newest().orientation) - (Math.PI * 100) / height) < 1e-3);
    assert.equal(await axis(), view, "the view stays");
    assert.deepEqual(newest().position, place, "and the hand");
    const before = newest().orientation;
    await page.mouse.wheel(0, 300);
    await until("rolled", () => newest().orientation.some((part, i) => Math.abs(part - before[i]) > 0.05));
    await page.keyboard.up("Shift");
    const rolled = newest().orientation;
    await page.keyboard.down("k");
    await until("pitched", () => newest().orientation.some((part, i) => Math.abs(part - rolled[i]) > 0.05));
    await page.keyboard.up("k");
  }));

test("the button turns with plain drags; torque is read and drawn", () =>
  withBox(async (page, program) => {
    await page.focus("#view");
    await page.keyboard.press("t");
    await until("held", () => program.servo.taken);
    assert.ok(await page.locator("#grip").isHidden(), "nothing that opens");
    await page.locator("#turn").click();
    await page.mouse.move(300, 250);
    await page.mouse.down();
    await page.mouse.move(300, 300, { steps: 5 });
    await page.mouse.up();
    await until("turned", () => angle(hands(program).at(-1).orientation) > 0.2);
    await until("a torque to see", () => page.locator(".chart.torque").isVisible());
    await page.locator("#turn").click();
    await page.mouse.move(250, 200); // over the middle of the table, whose edge keys would lead it past
    await until("over the table", () => Math.hypot(...hands(program).at(-1).position.slice(0, 2)) < 0.15);
    await page.keyboard.press("m");
    await page.keyboard.down("Shift");
    await page.keyboard.down("ArrowDown");
    await until("words", async () => /torque 20 N mm/.test(await text(page, "#touch")));
    await page.keyboard.up("ArrowDown");
    await page.keyboard.up("Shift");
  }));
