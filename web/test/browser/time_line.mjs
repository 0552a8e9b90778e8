// A recording on the page, against the made-up program.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { openPage, until } from "./browser.mjs";
import { picture } from "./picture.mjs";
import { browser, kPhone, kSmall, sent, text } from "./with_page.mjs";

async function withRecording(options, act) {
  const server = await serve({ points: 2000, length: 125 });
  const page = await openPage(browser, server.address, options);
  try {
    await until("the time line", () => page.locator("#time-line").isVisible());
    await until("a state", async () => /free|touching/.test(await text(page, "#touch")));
    await act(page, server.program);
    assert.deepEqual(page.troubles, [], "the browser complains");
  } finally {
    await page.context().close();
    await server.close();
  }
}

test("a time line seeks, plays and says where it is", () =>
  withRecording(kSmall, async (page, program) => {
    assert.equal(await text(page, "#time-words"), "0:00.00 / 2:05.00");
    const box = await page.locator("#time").boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await until("sought", () => Math.abs(program.moment.time - 62.5) < 2);
    await until("says so", async () => /^1:0\d\.\d\d/.test(await text(page, "#time-words")));
    const middle = program.moment.time;
    await page.keyboard.press("ArrowRight");
    await until("a second on", () => Math.abs(program.moment.time - middle - 1) < 0.01);
    await page.keyboard.press("Shift+ArrowLeft");
    await until("ten back", () => Math.abs(program.moment.time - middle + 9) < 0.01);
    await page.selectOption("#time-speed", "4");
    await page.keyboard.press("Tab");
    await page.focus("#view");
    await page.keyboard.press(" ");
    await until("plays", () => program.moment.playing && program.moment.speed === 4);
    await until("goes on", () => program.moment.time > middle);
    await until("a button to stop it", async () => (await page.getAttribute("#play", "aria-label")) === "Pause");
    await page.click("#play");
    await until("stands still", () => !program.moment.playing);
    await picture(page, "time-line");
  }));

test("the forces are drawn where they are", () =>
  withRecording(kSmall, async (page) => {
    const row = await page.evaluate(() => {
      const canvas = document.getElementById("time-forces");
      return [...canvas.getContext("2d").getImageData(0, 4, canvas.width, 1).data].filter((_, i) => i % 4 === 3);
    });
    const at = (share) => row[Math.round(share * row.length)];
    assert.ok(at(0.5) > 0, "contact in the middle");
    assert.deepEqual([at(0.2), at(0.8)], [0, 0]);
  }));

test("nothing of a recording can be moved or set", () =>
  withRecording(kSmall, async (page, program) => {
    for (const id of ["pause", "reset", "record", "take", "panel-settings", "panel-input"]) {
      assert.ok(await page.locator(`#${id}`).isHidden(), id);
    }
    await page.focus("#view");
    for (const key of ["t", "p", "r"]) await page.keyboard.press(key);
    await page.keyboard.press("ArrowRight");
    await until("sought", () => sent(program, "seek").length === 1);
    for (const type of ["hand", "pause", "reset"]) assert.equal(sent(program, type).length, 0, type);
  }));

test("on a phone the time line has its row", () =>
  withRecording(kPhone, async (page) => {
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 390), "nothing is wider than the screen");
    const box = await page.locator("#time").boundingBox();
    assert.ok(box.width > 120, `${box.width} pixels for the slider`);
    await picture(page, "time-line-phone");
  }));

// WebGL has no pictures without a height, and a window can be so low that all else would fill it.
for (const [name, width] of [["wide", 900], ["narrow", 390]]) {
  test(`in a low window that is ${name} the picture keeps a height`, () =>
    withRecording({ viewport: { width, height: 300 }, reducedMotion: "reduce" }, async (page) => {
      const box = await page.locator("#view").boundingBox();
      assert.ok(box.height > 90, `${box.height} pixels for the picture`);
      await picture(page, `low-${name}`);
    }));
}
