// The page in a headless chromium against the made-up program: npm run build first.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { connected, openPage, until } from "./browser.mjs";
import { picture } from "./picture.mjs";
import { dark, vivid } from "./pixels.mjs";
import { pointAt } from "./touching.mjs";
import { browser, hands, kPhone, kSmall, ready, sent, text, withPage } from "./with_page.mjs";
import "./next_run.mjs";
import "./finer.mjs";
import "./first_hour.mjs";
import "./links.mjs";
import "./moving.mjs";
import "./simple.mjs";
import "./sounds.mjs";
import "./time_line.mjs";
import "./turning.mjs";

test("shows the scene and its force, and the browser has nothing to complain of", () =>
  withPage(kSmall, async (page) => {
    assert.equal(await text(page, "#scene"), "table with a ball");
    await until("force", async () => Number(await text(page, "#force")) > 0);
    await until("sources", async () => /left[\s\S]*running/.test(await text(page, "#sources")));
    assert.equal(await page.locator("#settings .field").count(), 8);
  }));

test("clouds that stand still, without colours and normals, show too", async () => {
  const server = await serve({ points: 4000, still: true });
  const page = await openPage(browser, server.address, kSmall);
  await ready(page);
  await until("sources", async () => /left[\s\S]*still/.test(await text(page, "#sources")));
  const colouring = page.getByRole("combobox", { name: "Colour by" });
  await colouring.selectOption("height");
  await until("by height", () => page.locator("#ramp").isVisible());
  await until("the ramp's colours", async () => (await vivid(page)) > 0.02);
  await colouring.selectOption("automatic");
  await until("by no height", () => page.locator("#ramp").isHidden());
  await until("clay", async () => (await vivid(page)) < 0.01);
  assert.ok(await page.locator(".chart.frames").isHidden(), "no frames to time");
  await until("trust", async () => /\d % of this cloud has low trust/.test(await text(page, "#sources")));
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});

test("trust is shown by colour, with its ends named", () =>
  withPage(kSmall, async (page) => {
    await page.getByRole("combobox", { name: "Colour by" }).selectOption("trust");
    await until("the ramp", async () => /low trust\s*high trust/.test(await text(page, "#ramp")));
  }));

test("keys take the tool, push it against the table, and let go", () =>
  withPage(kSmall, async (page, program) => {
    await page.focus("#view");
    await page.keyboard.press("t");
    await until("held", () => program.servo.taken);
    await page.keyboard.down("Shift");
    await page.keyboard.down("ArrowDown");
    await until("in contact", () => program.servo.contact !== undefined && Math.hypot(...program.servo.force) > 0.5);
    await page.keyboard.up("ArrowDown");
    await page.keyboard.up("Shift");
    const { hip, contact } = program.servo;
    assert.ok(contact.proxy[2] > hip[2], "the proxy stays above the hand");
    await until("words", async () => /touching/.test(await text(page, "#touch")));
    const before = hands(program).at(-1).position;
    await page.keyboard.down("PageUp");
    await until("pushed away", () => Math.hypot(...hands(program).at(-1).position.map((c, i) => c - before[i])) > 0.002);
    await page.keyboard.up("PageUp");
    await page.keyboard.press("Escape");
    await until("released", () => sent(program, "release").length === 1);
  }));

test("a press on the surface takes the tool there and pulls with 1 N; the wheel makes it more, and a drag beside it turns the view", () =>
  withPage(kSmall, async (page, program) => {
    const axis = () => page.locator("line.axis-x").getAttribute("x2");
    const graspable = () => page.evaluate(() => document.querySelector("#view").classList.contains("graspable"));
    await pointAt(page, 300, 240);
    assert.equal(await page.evaluate(() => window.getComputedStyle(document.querySelector("#view")).cursor), "move");
    await page.mouse.down();
    await until("presses with 1 N", () => hands(program).at(-1)?.force === 1);
    const rest = await axis();
    await page.mouse.wheel(0, -200);
    await until("harder", () => hands(program).at(-1).force > 1.4);
    await page.mouse.up();
    await until("hovers", () => hands(program).at(-1).force === undefined);
    assert.equal(await axis(), rest, "the view stays");
    const box = await page.locator("#view").boundingBox();
    const [x, y] = [box.x + 0.45 * box.width, box.y + 8]; // above all that is drawn
    await page.mouse.move(x, y);
    assert.ok(!(await graspable()), "nothing is up there");
    await page.mouse.down();
    await page.mouse.move(x + 70, y + 10, { steps: 8 });
    await page.mouse.up();
    await until("the view turned", async () => (await axis()) !== rest);
  }));

test("free, a drag moves the hand while the tool is held, and turns the view otherwise", () =>
  withPage(kSmall, async (page, program) => {
    await page.focus("#view");
    await page.keyboard.press("m");
    const axis = () => page.locator("line.axis-x").getAttribute("x2");
    const drag = async () => {
      await page.mouse.move(300, 250);
      await page.mouse.down();
      await page.mouse.move(380, 260, { steps: 8 });
      await page.waitForTimeout(100);
    };
    const turned = await axis();
    await drag();
    await page.mouse.up();
    await until("the view turned", async () => (await axis()) !== turned);
    assert.equal(hands(program).length, 0);

    await page.keyboard.press("t");
    await until("held", () => hands(program).length > 0);
    const rest = await axis();
    const begin = hands(program)[0].position;
    await drag();
    await until("moved", () => Math.hypot(...hands(program).at(-1).position.map((c, i) => c - begin[i])) > 0.01);
    const flat = hands(program).at(-1).position;
    await page.mouse.wheel(0, -300);
    await until("deeper", () => Math.hypot(...hands(program).at(-1).position.map((c, i) => c - flat[i])) > 0.004);
    await page.mouse.up();
    assert.equal(await axis(), rest, "the view stays");
  }));

test("on a phone one finger moves the tool and two turn the view", () =>
  withPage(kPhone, async (page, program) => {
    const touch = await page.context().newCDPSession(page);
    const fingers = (type, ...places) =>
      touch.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y], id) => ({ x, y, id })) });
    await page.keyboard.press("m"); // free motion
    await page.tap("#take");
    await until("held", () => program.servo.taken);
    const axis = () => page.locator("line.axis-x").getAttribute("x2");
    await page.waitForTimeout(300);
    const rest = await axis();
    const begin = hands(program).at(-1).position;
    await fingers("touchStart", [150, 250]);
    for (let i = 1; i <= 8; i += 1) await fingers("touchMove", [150 + 6 * i, 250]);
    await fingers("touchEnd");
    await until("moved", () => Math.hypot(...hands(program).at(-1).position.map((c, i) => c - begin[i])) > 0.01);
    assert.equal(await axis(), rest, "the view stays");
    const still = hands(program).at(-1).position;
    await fingers("touchStart", [120, 250], [220, 250]);
    for (let i = 1; i <= 8; i += 1) await fingers("touchMove", [120 + 6 * i, 250], [220 + 6 * i, 250]);
    await fingers("touchEnd");
    await until("the view turned", async () => (await axis()) !== rest);
    assert.deepEqual(hands(program).at(-1).position, still, "the tool stays");
  }));

test("settings, presets and buttons reach the program", () =>
  withPage(kSmall, async (page, program) => {
    const stiffness = () => program.settings.find(({ key }) => key === "stiffness").value;
    await page.getByRole("spinbutton", { name: "Stiffness" }).fill("800");
    await page.keyboard.press("Enter");
    await until("set", () => stiffness() === 800);
    await page.getByRole("slider", { name: /Stiffness/ }).press("ArrowRight");
    await until("slid", () => stiffness() > 800 && stiffness() % 10 === 0);
    await page.getByRole("button", { name: "ice" }).click();
    await until("shown", async () => (await page.getByRole("spinbutton", { name: "Stiffness" }).inputValue()) === "1200");
    await page.getByRole("switch", { name: "Grain" }).click();
    await until("switched", () => program.servo.texture === 1);
    await page.click("#pause");
    await until("paused", async () => program.servo.paused && (await text(page, "#flags")).includes("paused"));
    await page.click("#pause");
    await until("goes on", () => !program.servo.paused);
    await page.click("#record");
    await until("recording", async () => (await page.getAttribute("#record", "aria-pressed")) === "true");
    await page.click("#reset");
    await until("reset", () => sent(program, "reset").length === 1);
    program.tell({ type: "notice", level: "fault", text: "the device is gone" });
    await until("a fault is said", async () => (await page.locator("#urgent").textContent()).includes("the device is gone"));
  }));

test("sound is off until it is asked for, and can be put off again", () =>
  withPage(kSmall, async (page) => {
    const on = () => page.getAttribute("#sound", "aria-pressed");
    assert.equal(await on(), "false");
    await page.click("#sound");
    await until("on", async () => (await on()) === "true");
    await page.waitForTimeout(300);
    await page.click("#sound");
    await until("off", async () => (await on()) === "false");
  }));

test("a picture is saved, sharp and at twice the screen's size, that says what is felt", () =>
  withPage(kSmall, async (page) => {
    await until("force", async () => Number(await text(page, "#force")) > 0);
    const download = page.waitForEvent("download");
    await page.click("#picture");
    const file = await download;
    assert.match(file.suggestedFilename(), /^palpate_table_with_a_ball_.*\.png$/);
    const saved = await readFile(await file.path());
    const shown = await page.evaluate(() => [document.getElementById("view").clientWidth, document.getElementById("view").clientHeight]);
    assert.deepEqual([saved.readUInt32BE(16), saved.readUInt32BE(20)], shown.map((side) => 2 * side), "of a PNG's header");
    assert.ok(await dark(page, saved, [32, -124, 320, 32]) > 0.05, "words");
    assert.ok(await dark(page, saved, [32, -40, 120, 16]) > 0.05, "scale");
    await picture(page, "after-a-saved-picture");
    await until("the view is as it was", () => page.evaluate(() => {
      const canvas = document.getElementById("view");
      return canvas.width <= canvas.clientWidth;
    }));
  }));

test("comes back by itself when the program is gone for a while", async () => {
  const server = await serve({ points: 1000 });
  const page = await openPage(browser, server.address, kSmall);
  await ready(page);
  await server.close();
  await until("says so", async () => /Connection lost/.test(await page.locator("#cover").innerText()));
  await page.focus("#view");
  await page.keyboard.press("t");
  assert.equal(await page.getAttribute("#take", "aria-pressed"), "false", "nobody hears that it is taken");
  const again = await serve({ points: 1000, port: server.port, token: server.token });
  await connected(page);
  assert.ok(await page.locator("#cover").isHidden());
  await page.context().close();
  await again.close();
});

test("without a token, and with a wrong one, says what to do", async () => {
  const server = await serve({ points: 1000 });
  const bare = await openPage(browser, server.address.replace(/#.*/, ""), kSmall);
  await until("asks for the token", async () => /Open the address that palpate printed/.test(await text(bare, "#cover")));
  await bare.fill("#cover-token", server.address);
  await bare.keyboard.press("Enter");
  await ready(bare);
  await bare.context().close();
  const wrong = await openPage(browser, server.address.replace(/#.*/, "#0123"), kSmall);
  await until("refused", async () => /rejected this page/.test(await wrong.locator("#cover").innerText()));
  await wrong.waitForTimeout(1500);
  assert.equal(sent(server.program, "hello").filter(({ token }) => token === "0123").length, 1, "no second try");
  await wrong.context().close();
  await server.close();
});

test("the view follows the window's size", () =>
  withPage(kSmall, async (page) => {
    await page.setViewportSize({ width: 640, height: 700 });
    await until("follows", () => page.evaluate(() => {
      const canvas = document.getElementById("view");
      const shape = canvas.width / canvas.height / (canvas.clientWidth / canvas.clientHeight);
      return canvas.clientWidth === 640 && Math.abs(shape - 1) < 0.02 && document.documentElement.scrollWidth <= 640;
    }));
  }));

test("everything that can be pressed has a name, and Tab reaches it", () =>
  withPage(kSmall, async (page) => {
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll("button, input, select")]
        .filter((one) => !(one.getAttribute("aria-label") || one.textContent.trim() || one.labels?.length))
        .map((one) => one.outerHTML));
    assert.deepEqual(nameless, []);
    const reached = new Set();
    for (let i = 0; i < 60; i += 1) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.textContent));
    }
    for (const id of ["view", "take", "pause", "record", "share", "fit", "freeze"]) assert.ok(reached.has(id), id);
  }));
