// What a person meets in the first hour.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { openPage, until } from "./browser.mjs";
import { distance, felt, listen } from "./heard.mjs";
import { picture } from "./picture.mjs";
import { shaded, viewOf } from "./pixels.mjs";
import { pointAt } from "./touching.mjs";
import { browser, kPhone, kSmall, ready, text, withPage } from "./with_page.mjs";

test("a press beside what is seen says that there is no surface; a drag turns the view and says nothing", () =>
  withPage(kSmall, async (page) => {
    const hint = () => text(page, "#hint");
    const { x, y, width } = await page.locator("#view").boundingBox();
    const beside = [x + 0.45 * width, y + 8]; // above all that is drawn
    await page.mouse.move(...beside);
    await page.mouse.down();
    await page.mouse.move(beside[0] + 30, beside[1], { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(300);
    assert.match(await hint(), /^Press on the surface/);
    await page.mouse.click(...beside);
    await until("said", async () => /^No surface here/.test(await hint()));
    await until("no more", async () => /^Press on the surface/.test(await hint()));
  }));

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
    window.pointsDrawn = {}; // by the picture's size
    window.drawn = 0;
    const draw = window.WebGL2RenderingContext.prototype.drawArrays;
    window.WebGL2RenderingContext.prototype.drawArrays = function (mode, ...rest) {
      const { width } = this.canvas;
      if (mode === this.POINTS) window.pointsDrawn[width] = (window.pointsDrawn[width] ?? 0) + 1;
      return draw.call(this, mode, ...rest);
    };
    const elements = window.WebGL2RenderingContext.prototype.drawElements;
    window.WebGL2RenderingContext.prototype.drawElements = function (...rest) {
      window.drawn += 1;
      return elements.apply(this, rest);
    };
  });
  await ready(page);
  const points = () => page.evaluate(() => Object.entries(window.pointsDrawn).join("; "));
  let settled = "";
  await until("the picture is settled", async () => {
    const before = settled;
    await page.waitForTimeout(1000);
    settled = await points();
    return settled !== "" && settled === before;
  });
  await page.evaluate(() => Object.assign(window, { pointsDrawn: {}, drawn: 0 }));
  await until("the tool is drawn on", () => page.evaluate(() => window.drawn > 100));
  // Where drawing is slow the picture may get smaller meanwhile, and then both clouds are drawn once in the new size.
  const again = await page.evaluate(() => Math.max(0, ...Object.values(window.pointsDrawn)));
  assert.ok(again <= 2, `points were drawn ${again} times more: ${await points()}`);
  await page.context().close();
  await server.close();
});

test("a first visit says that the tool explores by itself, and offers to show how while nobody holds the tool", () =>
  withPage(kSmall, async (page, program) => {
    assert.ok(await page.locator("#by-itself").isVisible());
    assert.ok(await page.locator("#tour-offer").isVisible());
    await page.focus("#view");
    await page.keyboard.press("t");
    await until("taken", () => program.servo.taken);
    await until("no more", async () => !(await page.locator("#by-itself").isVisible()) && !(await page.locator("#tour-offer").isVisible()));
    await page.keyboard.press("Escape");
    await until("by itself again", () => page.locator("#by-itself").isVisible());
    assert.ok(await page.locator("#tour-offer").isVisible(), "it stays within reach");
  }));

test("where a cloud is seen but nothing is felt, the page says so, until something is", () =>
  withPage(kSmall, async (page, program) => {
    program.servo.hole = true;
    await pointAt(page, 300, 240);
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
      const names = [".actions", ".readout", ".grips", ".eye", "#scale", ".tabs"];
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

test("a tool in the air throws a shadow on the cloud below it, which goes when the tool does", async () => {
  const server = await serve({ points: 30000, still: true });
  const page = await openPage(browser, server.address, kSmall, listen);
  await ready(page);
  await page.getByRole("switch", { name: "Trail" }).click(); // it is no shadow
  const seenAt = async (place) => {
    server.program.servo.exploring = () => place;
    await until("the page knows where the tool is", async () => {
      const { hip } = await felt(page);
      return hip !== undefined && distance(hip, place) < 1e-3;
    });
    return viewOf(page);
  };
  const kShadow = 8; // cells of the view
  const kAway = [-0.25, 0.2, 0.4];
  const kAbove = [0.15, -0.1, 0.04];
  // Where drawing is slow pictures may become less sharp between two looks: then the next are compared.
  await until("a shadow below the tool", async () => {
    const away = await seenAt(kAway);
    const above = await seenAt(kAbove);
    const gone = await seenAt(kAway);
    const cells = [await shaded(page, above, away), await shaded(page, gone, away)];
    return cells[0] >= kShadow && cells[1] < kShadow / 4;
  });
  await seenAt(kAbove);
  await picture(page, "shadow");
  await page.context().close();
  await server.close();
});
