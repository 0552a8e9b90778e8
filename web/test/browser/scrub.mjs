// The page of a recording, against palpate itself.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { until } from "./browser.mjs";
import { distance, felt, heard } from "./heard.mjs";
import { picture } from "./picture.mjs";
import { run } from "./real_program.mjs";

/** On the page of a recording: the slider leads the hand to where it was, and it goes on from there. */
export async function scrub(page, file) {
  await until("the time line", () => page.locator("#time-line").isVisible());
  await until("a cloud", async () => (await heard(page)).points > 5000);
  const recorded = await stepsOf(file);
  const length = recorded.at(-1).t;
  for (const time of [0.8 * length, 0.3 * length, 0.6 * length]) {
    await page.locator("#time").evaluate((slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, time);
    const step = recorded.findLast(({ t }) => t <= time);
    await until(`the hand where it was at ${time} s`, async () => {
      const { hip } = await felt(page);
      return hip !== undefined && distance(hip, step.hip) < 2e-6; // single precision around the origin
    });
  }
  assert.ok(await page.locator("#take").isHidden() && (await page.locator("#record").isHidden()));
  await until("forces are drawn", () => page.evaluate(() => {
    const { width, height } = document.getElementById("time-forces");
    const { data } = document.getElementById("time-forces").getContext("2d").getImageData(0, 4, width, height - 8);
    return data.some((value) => value > 0);
  }));
  await picture(page, "replay");
  const before = await page.locator("#time-words").innerText();
  const { hip } = await felt(page);
  await page.focus("#view");
  await page.keyboard.press(" ");
  await until("it goes on", async () => distance((await felt(page)).hip, hip) > 1e-4);
  await until("says so", async () => (await page.locator("#time-words").innerText()) !== before);
  await page.keyboard.press(" ");
  assert.deepEqual(page.troubles, []);
  await page.context().close();
}

/** Time and place of every step, as palpate writes them. */
async function stepsOf(file) {
  await run(["replay", file, "--log", "steps.csv"], dirname(file));
  const [head, ...rows] = (await readFile(join(dirname(file), "steps.csv"), "utf8")).trim().split("\n");
  const at = ["t", "hip_x", "hip_y", "hip_z"].map((name) => head.split(",").indexOf(name));
  return rows.map((row) => row.split(",")).map((cells) => {
    const [t, ...hip] = at.map((column) => Number(cells[column]));
    return { t, hip };
  });
}
