// What a person meets in the first hour.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { openPage, until } from "./browser.mjs";
import { picture } from "./picture.mjs";
import { shaded } from "./pixels.mjs";
import { browser, kPhone, kSmall, ready, text, withPage } from "./with_page.mjs";

test("work under way has one notice that stays, with a percentage, until it is done", () =>
  withPage(kSmall, async (page, program) => {
    const tell = (words, share) => program.tell({ type: "notice", level: "info", text: words, share });
    tell("reading survey.laz", 0);
    await until("no share yet", async () => /reading survey.laz\s*…/.test(await text(page, "#notices")));
    tell("reading survey.laz", 0.42);
    await until("a share", async () => /reading survey.laz\s*42 %/.test(await text(page, "#notices")));
    for (const words of ["one", "two", "three"]) program.tell({ type: "notice", level: "info", text: words });
    await until("three others", async () => /three/.test(await text(page, "#notices")));
    assert.match(await text(page, "#notices"), /reading survey/, "others do not push it out");
    tell("preparing survey.laz", 0.1);
    await until("another", async () => /preparing survey.laz\s*10 %/.test(await text(page, "#notices")));
    assert.doesNotMatch(await text(page, "#notices"), /reading/, "one at a time");
    tell("preparing survey.laz", 1);
    await until("gone", async () => !/preparing/.test(await text(page, "#notices")));
  }));

test("while nothing of a cloud changes, its points are drawn once", async () => {
  const server = await serve({ points: 4000, still: true });
  const page = await openPage(browser, server.address, kSmall, () => {
    window.pointsDrawn = 0;
    window.drawn = 0;
    const draw = window.WebGL2RenderingContext.prototype.drawArrays;
    window.WebGL2RenderingContext.prototype.drawArrays = function (mode, ...rest) {
      if (mode === this.POINTS) window.pointsDrawn += 1;
      return draw.call(this, mode, ...rest);
    };
    const elements = window.WebGL2RenderingContext.prototype.drawElements;
    window.WebGL2RenderingContext.prototype.drawElements = function (...rest) {
      window.drawn += 1;
      return elements.apply(this, rest);
    };
  });
  await ready(page);
  const counts = () => page.evaluate(() => ({ points: window.pointsDrawn, others: window.drawn }));
  let settled = await counts();
  await until("the picture is settled", async () => {
    const before = settled;
    await page.waitForTimeout(1000);
    settled = await counts();
    return settled.points > 0 && settled.points === before.points;
  });
  await until("the tool is drawn on", async () => (await counts()).others > settled.others + 100);
  const { points } = await counts();
  assert.ok(points <= settled.points + 2, `points were drawn ${points - settled.points} times more`);
  await page.context().close();
  await server.close();
});

test("a first visit says that the tool explores by itself, and offers to show how, until the tool is taken", () =>
  withPage(kSmall, async (page, program) => {
    assert.ok(await page.locator("#by-itself").isVisible());
    assert.ok(await page.locator("#tour-offer").isVisible());
    await page.focus("#view");
    await page.keyboard.press("t");
    await until("taken", () => program.servo.taken);
    await until("no more", async () => !(await page.locator("#by-itself").isVisible()) && !(await page.locator("#tour-offer").isVisible()));
    await page.keyboard.press("Escape");
    await until("by itself again", () => page.locator("#by-itself").isVisible());
    assert.ok(!(await page.locator("#tour-offer").isVisible()), "offered once");
  }));

test("where a cloud is seen but nothing is felt, the page says so, until something is", () =>
  withPage(kSmall, async (page, program) => {
    program.servo.hole = true;
    await until("a surface is under the pointer", async () => {
      await page.mouse.move(301, 240);
      await page.mouse.move(300, 240);
      return page.evaluate(() => document.querySelector("#view").classList.contains("graspable"));
    });
    assert.doesNotMatch(await text(page, "#touch"), /no surface/);
    await page.mouse.down();
    await until("said", async () => (await text(page, "#touch")) === "no surface here");
    program.servo.hole = false;
    await until("felt", async () => /touching/.test(await text(page, "#touch")));
    program.servo.hole = true;
    await until("said again", async () => (await text(page, "#touch")) === "no surface here");
    await page.mouse.up();
    await until("no longer, without a press", async () => /free/.test(await text(page, "#touch")));
  }));

test("on a narrow phone nothing covers anything else, with letters twice as large, too", async () => {
  for (const standard of [16, 32]) {
    await withPage({ ...kPhone, viewport: { width: 360, height: 740 } }, async (page) => {
      await page.evaluate(() => localStorage.clear());
      await (await page.context().newCDPSession(page)).send("Page.setFontSizes", { fontSizes: { standard } });
      await until("letters have that size", async () => parseFloat(await page.evaluate(() => window.getComputedStyle(document.documentElement).fontSize)) > 0.9 * standard);
      const names = [".actions", ".readout", ".grips", ".eye", ".measures .scale", ".tabs"];
      const boxes = await Promise.all(names.map((name) => page.locator(name).boundingBox()));
      boxes.forEach((a, i) => {
        assert.ok(a.x >= 0 && a.x + a.width <= 360.5, `${names[i]} is ${a.width} wide`);
        boxes.slice(0, i).forEach((b, k) => {
          const apart = a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
          assert.ok(apart, `${standard}: ${names[i]} covers ${names[k]}`);
        });
      });
    });
  }
});

test("where the system forces its colours, switches and sources are still told apart", () =>
  withPage({ ...kSmall, forcedColors: "active" }, async (page) => {
    const ground = (selector) => page.locator(selector).first().evaluate((element) => window.getComputedStyle(element).backgroundColor);
    const switches = ["#panel-settings", "#panel-look"].map((panel) => ground(`${panel} input[role="switch"]`));
    assert.notEqual(...(await Promise.all(switches)));
    await until("sources", () => page.locator(".swatch").first().isVisible());
    assert.notEqual(await ground(".swatch"), await page.evaluate(() => window.getComputedStyle(document.body).backgroundColor));
  }));

test("a tool in the air throws a shadow on the cloud below it", async () => {
  const server = await serve({ points: 30000, still: true });
  const page = await openPage(browser, server.address, kSmall);
  await ready(page);
  const seenAt = async (place) => {
    server.program.servo.exploring = () => place;
    await page.waitForTimeout(2000); // and its trail has faded
    return page.locator("#view").screenshot({ timeout: 120_000 });
  };
  let pixels = 0;
  // A processor that draws slowly is late with either of the two.
  for (let tries = 0; tries < 4 && pixels <= 100; tries += 1) {
    const away = await seenAt([-0.25, 0.2, 0.4]);
    const above = await seenAt([0.15, -0.1, 0.04]);
    pixels = await shaded(page, above, away, [300, 100, 340, 170]); // no words there
  }
  await picture(page, "shadow");
  assert.ok(pixels > 100, `${pixels} pixels are darker`);
  await page.context().close();
  await server.close();
});
