// The simple page of a first visit. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { openPage, until } from "./browser.mjs";
import { picture } from "./picture.mjs";
import { browser, kPhone, kSmall, ready, sent, text, withPage, withProgram } from "./with_page.mjs";

const kRest = ["side", "strip", "legend", "axes", "parts", "ramp", "follow", "upright", "pause", "reset", "record", "picture", "share"];
const kShown = ["view", "force", "touch", "hint", "take", "tour-offer", "presets", "sound", "link-state", "help", "fit", "panels"];

const firstVisit = (options, act) => withPage(options, act, 4000, true);
const panels = (page) => page.evaluate(() => document.body.dataset.panels);
const presetsIn = (page, place) => page.locator(`${place} #presets button`).count();

async function showsSimple(page) {
  assert.equal(await panels(page), "simple");
  for (const id of kRest) assert.ok(await page.locator(`#${id}`).isHidden(), `${id} is hidden`);
  for (const id of kShown) assert.ok(await page.locator(`#${id}`).isVisible(), `${id} is shown`);
}

/** What Tab reaches, and that all of it is seen. */
async function reachedByTab(page) {
  const reached = [];
  for (let i = 0; i < 40; i += 1) {
    await page.keyboard.press("Tab");
    const [name, seen] = await page.evaluate(() => {
      const { activeElement: one } = document;
      return [one.id || one.textContent, one === document.body || one.checkVisibility({ visibilityProperty: true })];
    });
    assert.ok(seen, `${name} has the focus and is not seen`);
    reached.push(name);
  }
  return reached;
}

/** Boxes within the screen, none over another. */
async function stayApart(page, width, names) {
  const boxes = await Promise.all(names.map((name) => page.locator(name).boundingBox()));
  boxes.forEach((a, i) => {
    assert.ok(a.x >= 0 && a.x + a.width <= width + 0.5, `${names[i]}: ${a.x} to ${a.x + a.width}`);
    boxes.slice(0, i).forEach((b, k) => {
      const apart = a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
      assert.ok(apart, `${names[i]} covers ${names[k]}`);
    });
  });
}

test("a first visit sees the simple page: force, tool, presets, and one button for the rest", () =>
  firstVisit({ viewport: { width: 1440, height: 900 } }, async (page) => {
    await until("force", async () => Number(await text(page, "#force")) > 0);
    await showsSimple(page);
    assert.equal(await text(page, "#link-words"), "connected");
    assert.equal(await presetsIn(page, ".hold"), await presetsIn(page, "body"), "once, in the picture");
    const { width } = await page.locator("#view").boundingBox();
    assert.equal(width, 1440, "the view has the room");
    await stayApart(page, 1440, [".readout", ".hold", ".eye", "#scale"]);
    await picture(page, "simple");
  }));

test("a preset of the simple page reaches the program, and is marked until a value changes", () =>
  firstVisit(kSmall, async (page, program) => {
    const marked = () => page.locator('#presets [aria-pressed="true"]').allInnerTexts();
    assert.deepEqual(await marked(), [], "what was set before is not known");
    await page.locator("#presets").getByRole("button", { name: "fur" }).click();
    await until("set", () => sent(program, "preset").at(-1)?.name === "fur");
    await until("marked", async () => (await marked()).join() === "fur");
    program.set("stiffness", 700); // as another page may
    program.tellSettings();
    await until("no more", async () => (await marked()).length === 0);
  }));

test("the button and its key bring all panels and take them away, which the browser remembers", () =>
  firstVisit(kSmall, async (page) => {
    const button = page.getByRole("button", { name: "All panels instead of the simple page" });
    assert.equal(await button.getAttribute("aria-pressed"), "false");
    await button.click();
    assert.equal(await button.getAttribute("aria-pressed"), "true");
    assert.equal(await button.innerText(), "Simple");
    for (const id of ["side", "strip", "legend", "axes", "parts", "share"]) assert.ok(await page.locator(`#${id}`).isVisible(), id);
    assert.equal(await presetsIn(page, "#panel-settings"), await presetsIn(page, "body"), "once, in their panel");
    await until("said", async () => (await page.locator("#polite").textContent()) === "All panels are shown.");
    await page.reload();
    await ready(page);
    assert.equal(await panels(page), "all", "as chosen last");
    await page.focus("#view");
    await page.keyboard.press("a");
    await showsSimple(page);
    await page.reload();
    await ready(page);
    await showsSimple(page);
  }));

test("on the simple page the focus is never on what is hidden", () =>
  firstVisit(kSmall, async (page) => {
    const reached = new Set(await reachedByTab(page));
    for (const id of ["view", "take", "tour-offer", "sound", "help", "fit", "panels", "fur"]) assert.ok(reached.has(id), id);
    for (const id of ["freeze", "record", "device", "follow"]) assert.ok(!reached.has(id), id);
    await page.locator("#presets button").first().focus();
    await page.keyboard.press("a");
    assert.equal(await page.evaluate(() => document.activeElement.parentElement.id), "presets", "it moved with its focus");
    await page.getByRole("switch", { name: "Grain" }).focus();
    await page.keyboard.press("a");
    assert.equal(await page.evaluate(() => document.activeElement.id), "view", "what had it is hidden");
  }));

test("plots that are hidden are not drawn, and are there with their past when all is shown", () =>
  firstVisit(kSmall, async (page) => {
    await page.evaluate(() => {
      window.drawn = 0;
      const clear = window.CanvasRenderingContext2D.prototype.clearRect;
      window.CanvasRenderingContext2D.prototype.clearRect = function (...box) {
        window.drawn += 1;
        return clear.apply(this, box);
      };
    });
    await page.waitForTimeout(1500);
    await page.keyboard.press("h");
    assert.equal(await page.evaluate(() => window.drawn), 0);
    await page.click("#panels");
    await until("drawn", () => page.evaluate(() => window.drawn > 3));
    assert.equal(await page.getAttribute("#freeze", "aria-pressed"), "false", "H freezes nothing that is hidden");
  }));

test("warnings, faults and work under way are shown; what is only good to know is listed", () =>
  firstVisit(kSmall, async (page, program) => {
    const tell = (level, words, share) => program.tell({ type: "notice", level, text: words, share });
    tell("info", "the right camera is back");
    tell("info", "reading survey.laz", 0.3);
    tell("warning", "left: late");
    tell("fault", "the device is gone");
    await until("shown", async () => /survey[\s\S]*late[\s\S]*gone/.test(await text(page, "#notices")));
    assert.doesNotMatch(await text(page, "#notices"), /is back/);
    assert.match(await page.locator("#log").textContent(), /the right camera is back/);
  }));

test("Reset is there while a fault needs it, and Pause while the run is paused", () =>
  firstVisit(kSmall, async (page, program) => {
    program.servo.fault = true;
    await until("Reset", () => page.locator("#reset").isVisible());
    await page.click("#reset");
    await until("reset", () => sent(program, "reset").length === 1);
    program.servo.fault = false;
    await until("no more", () => page.locator("#reset").isHidden());
    program.servo.paused = true; // by another page
    await until("a way on", () => page.locator("#pause").isVisible());
    await page.click("#pause");
    await until("no more", () => page.locator("#pause").isHidden());
    assert.ok(!program.servo.paused);
  }));

/** A first visit to a run of a mesh whose unit is guessed, and that may be followed by another. */
const visitMesh = (options, act) => withProgram({ points: 4000, anew: true }, options, act, true);

test("a guessed unit is asked for, once; another one reaches the program", () =>
  visitMesh(kSmall, async (page, program) => {
    const ask = page.locator("#ask");
    assert.match(await ask.innerText(), /^cube: 20 x 20 x 20 mm\?/);
    assert.equal(await ask.locator('[aria-pressed="true"]').innerText(), "mm");
    await stayApart(page, 900, [".readout", ".hold", ".eye", "#scale"]);
    await picture(page, "simple-unit");
    await ask.getByRole("button", { name: "inch" }).click();
    await until("set", () => sent(program, "set").some(({ key, value }) => key === "unit.cube" && value === "inch"));
    assert.ok(await ask.isVisible(), "nobody knows yet whether the file can be read again");
    const unit = program.settings.find(({ key }) => key === "unit.cube");
    Object.assign(unit, { value: "inch", question: undefined });
    program.beginAnew();
    await until("answered", () => ask.isHidden());
    await page.click("#panels");
    assert.equal(await page.locator("#panel-sources").getByLabel("Unit of cube").inputValue(), "inch");
  }));

test("examples and a file to open are offered while nobody holds the tool", () =>
  visitMesh(kSmall, async (page, program) => {
    await page.locator("#ask .close").click();
    assert.match(await text(page, "#offer"), /^Drop a scan or a mesh, or\s+open\s+or try\s+rabbit\s+desk\s+room$/);
    const chooser = page.waitForEvent("filechooser");
    await page.click("#open-here");
    await chooser;
    await page.locator("#examples").getByRole("button", { name: "room" }).click();
    await until("set", () => sent(program, "set").some(({ key, value }) => key === "scene" && value === "room"));
    await page.focus("#view");
    await page.keyboard.press("t");
    await until("out of the way", () => page.locator("#offer").isHidden());
  }));

test("on a phone the card and the examples cover nothing", () =>
  visitMesh(kPhone, async (page) => {
    const parts = [".actions", ".readout", ".hold", ".eye"];
    await stayApart(page, 390, parts);
    await page.locator("#ask .close").click();
    assert.match(await text(page, "#offer"), /^open\s*a scan or a mesh/);
    await stayApart(page, 390, parts);
    await picture(page, "simple-phone-examples");
  }));

test("the paper's preset and words of the servo are for those who ask for all", () =>
  firstVisit(kSmall, async (page) => {
    const paper = page.locator('[data-preset="paper"]');
    assert.ok(await paper.isHidden());
    await page.click("#panels");
    assert.ok(await paper.isVisible());
  }));

test("the tour's words stand above the buttons", () =>
  firstVisit(kPhone, async (page) => {
    await page.tap("#tour-offer");
    await until("it speaks", () => page.locator("#tour").isVisible());
    await stayApart(page, 390, [".readout", "#tour", "#grips", ".eye"]);
    await picture(page, "simple-tour");
  }));

for (const standard of [16, 32]) {
  test(`on phones the simple page covers nothing, letters of ${standard} pixels`, async () => {
    for (const width of [390, 360]) {
      await firstVisit({ ...kPhone, viewport: { width, height: width === 390 ? 844 : 740 } }, async (page) => {
        await (await page.context().newCDPSession(page)).send("Page.setFontSizes", { fontSizes: { standard } });
        await until("letters have that size", async () =>
          parseFloat(await page.evaluate(() => window.getComputedStyle(document.documentElement).fontSize)) > 0.9 * standard);
        assert.ok(await page.locator(".tabs").isHidden());
        assert.ok(await page.evaluate((most) => document.documentElement.scrollWidth <= most, width), "nothing is wider than the screen");
        await stayApart(page, width, [".actions", ".readout", "#presets", "#grips", ".eye", "#scale"]);
        const { y, height } = await page.locator("#view").boundingBox();
        assert.ok(y + height > (await page.evaluate(() => window.innerHeight)) - 1, "the view goes to the bottom");
        await picture(page, `simple-phone-${width}-${standard}`);
      });
    }
  });
}

for (const [name, options] of [["dark", { ...kSmall, colorScheme: "dark" }], ["forced", { ...kSmall, forcedColors: "active" }]]) {
  test(`the simple page in ${name} colours`, () =>
    firstVisit(options, async (page) => {
      await showsSimple(page);
      await stayApart(page, 900, [".readout", ".hold", ".eye", "#scale"]);
      await picture(page, `simple-${name}`);
    }));
}

test("a recording opens with all panels; simple, its time line stays", async () => {
  const server = await serve({ points: 2000, length: 125 });
  const page = await openPage(browser, server.address, kSmall, undefined, true);
  await until("all panels", async () => (await panels(page)) === "all");
  assert.ok(await page.locator("#strip").isVisible());
  await page.click("#panels");
  assert.ok(await page.locator("#time-line").isVisible() && (await page.locator("#strip").isHidden()));
  await page.locator("#time").focus();
  await picture(page, "simple-recording");
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});

test("a link with settings opens with all panels, once", async () => {
  const server = await serve({ points: 2000 });
  const page = await openPage(browser, `${server.address}&stiffness=900`, kSmall, undefined, true);
  await ready(page);
  assert.equal(await panels(page), "all");
  await page.reload();
  await ready(page);
  assert.equal(await panels(page), "simple", "the address has no settings any more");
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});
