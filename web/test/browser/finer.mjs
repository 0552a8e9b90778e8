// What a person would stumble over: keys, words beside settings, other pages, narrow screens. Part of run.mjs.

import assert from "node:assert/strict";
import { once } from "node:events";
import { test } from "node:test";
import { WebSocket } from "ws";
import { serve } from "../fake_server.mjs";
import { openPage, until } from "./browser.mjs";
import { firstPaint, listen } from "./heard.mjs";
import { browser, hands, kPhone, kSmall, ready, sent, text, withPage } from "./with_page.mjs";

test("letters act while a switch or a slider has the focus, and not while one writes", () =>
  withPage(kSmall, async (page, program) => {
    await page.getByRole("switch", { name: "Grain" }).focus();
    await page.keyboard.press("p");
    await until("paused", async () => (await text(page, "#flags")).includes("paused"));
    await page.getByRole("slider", { name: /Stiffness/ }).focus();
    await page.keyboard.press("p");
    await until("goes on", () => !program.servo.paused);
    await page.getByRole("spinbutton", { name: "Stiffness" }).focus();
    await page.keyboard.press("p");
    await page.getByRole("switch", { name: "Grain" }).focus();
    await page.keyboard.press("r");
    await until("reset", () => sent(program, "reset").length === 1);
    assert.equal(sent(program, "pause").length, 2, "a letter that was written is no command");
  }));

test("letters can be switched off", () =>
  withPage(kSmall, async (page, program) => {
    const letters = page.getByRole("switch", { name: "Single-letter shortcuts" });
    await letters.click();
    await page.focus("#view");
    await page.keyboard.press("t");
    await page.keyboard.press("p");
    await letters.click();
    await page.focus("#view");
    await page.keyboard.press("t");
    await until("held", () => program.servo.taken);
    assert.equal(sent(program, "pause").length, 0);
    assert.equal(sent(program, "release").length, 0, "taken once");
  }));

test("a page that nobody sees draws nothing until it is seen again", () =>
  withPage(kSmall, async (page, program) => {
    const see = (hidden) => page.evaluate((value) => {
      Object.defineProperty(document, "hidden", { value, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }, hidden);
    const [{ points }] = sent(program, "hello");
    assert.ok(points > 0);
    await see(true);
    await until("no points", () => sent(program, "points").at(-1)?.points === 0);
    await see(false);
    await until("as before", () => sent(program, "points").at(-1)?.points === points);
  }));

test("a number field takes any value within its bounds and shows the one that holds", () =>
  withPage(kSmall, async (page, program) => {
    const field = page.getByRole("spinbutton", { name: "Stiffness" });
    const stiffness = () => program.settings.find(({ key }) => key === "stiffness").value;
    const shows = (text) => until(`it shows ${text}`, async () => (await field.inputValue()) === text);
    for (const [typed, value, shown] of [["2.504", 10, "10"], ["505", 505, "505"], ["50,5", 50.5, "50.5"], ["99999", 2000, "2000"], ["512.25", 512.25, "512"]]) {
      await field.fill(typed);
      await page.keyboard.press("Enter");
      await until(`${typed} is set`, () => stiffness() === value);
      await page.focus("#view");
      await shows(shown);
    }
    await field.fill("700");
    await page.keyboard.press("Escape");
    await shows("512");
    await field.fill("much");
    await page.keyboard.press("Enter");
    await shows("512");
    await field.fill("");
    await page.focus("#view");
    await shows("512");
    const before = sent(program, "set").length;
    await page.getByRole("slider", { name: /Stiffness/ }).evaluate((slider) => slider.dispatchEvent(new Event("input")));
    await until("the slider is where it was", () => sent(program, "set").length > before);
    assert.equal(stiffness(), 512.25);
  }));

test("where motors push, a stiffness that is asked for in contact and not felt yet is said beside it", () =>
  withPage(kSmall, async (page, program) => {
    const softer = page.locator("#settings [role=status]");
    program.servo.exploring = () => [0.05, 0.1, -0.004];
    await until("in contact", () => program.servo.contact !== undefined);
    const stiffen = async (stiffness) => {
      await page.getByRole("spinbutton", { name: "Stiffness" }).fill(stiffness);
      await page.keyboard.press("Enter");
      await until("softer", () => program.servo.felt < 0.9 * program.servo.stiffness);
    };
    await stiffen("900");
    await page.waitForTimeout(500);
    assert.equal(await softer.innerText(), "", "of a page's hand it is over at once");
    program.motors = true;
    program.beginAnew();
    await until("said", async () => /lift and touch again/.test(await softer.innerText()));
    program.servo.exploring = () => [0.05, 0.1, 0.1];
    await until("no more", async () => (await softer.innerText()) === "");
  }));

test("a phone that holds the tool is not told that another page does", () =>
  withPage(kPhone, async (page, program) => {
    await page.tap("#take");
    await until("held", () => program.servo.taken);
    await until("told how to touch", async () => /two fingers/.test(await text(page, "#hint")));
  }));

test("a page whose tool another takes is told, and holds it no more", () =>
  withPage(kSmall, async (page, program, server) => {
    await page.keyboard.press("t");
    await until("held", () => program.servo.taken);
    const other = new WebSocket(`ws://127.0.0.1:${server.port}/live`);
    await once(other, "open");
    for (const message of [
      { type: "hello", token: server.token, points: 0 },
      { type: "hand", device: 0, position: [0, 0, 0.1], buttons: 0 },
    ]) other.send(JSON.stringify(message));
    await until("said", async () => /another page took the tool/.test(await text(page, "#notices")));
    assert.equal(await page.getAttribute("#take", "aria-pressed"), "false");
    assert.ok(program.servo.taken);
    await until("answered", () => sent(program, "release").length === 1);
    assert.ok(program.servo.taken, "it is the other's");
    other.close();
  }));

test("drawn in software, the picture of a moving eye is coarse; it becomes sharp once the eye stands still", async () => {
  const server = await serve({ points: 4000, still: true });
  const page = await openPage(browser, server.address, { ...kSmall, reducedMotion: "no-preference" }); // the view glides
  await ready(page);
  const sharpness = () => page.locator("#view").evaluate((view) => view.width / view.clientWidth);
  await page.hover("#view");
  for (let round = 0; round < 2; round += 1) {
    await until("sharp", async () => (await sharpness()) > 0.99);
    await page.mouse.wheel(0, 100);
    await until("coarse", async () => (await sharpness()) < 0.51);
  }
  await page.mouse.move(30, 250);
  await page.mouse.down();
  await page.mouse.move(80, 250, { steps: 4 });
  await until("coarse", async () => (await sharpness()) < 0.51);
  await page.mouse.up();
  await until("sharp after a drag", async () => (await sharpness()) > 0.99);
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});

test("scale and ramp stand beside one another on the narrowest phone", async () => {
  for (const width of [320, 390]) {
    await withPage({ ...kPhone, viewport: { width, height: 700 } }, async (page) => {
      await page.evaluate(() => localStorage.clear());
      await page.tap('[data-tab="settings"]');
      await page.getByLabel("Colour by").selectOption({ label: "height" });
      await until("the ramp", () => page.locator("#ramp").isVisible());
      for (let zoom = 0; zoom < 12; zoom += 1) {
        await page.mouse.move(width / 2, 250);
        await page.mouse.wheel(0, 60);
        await page.waitForTimeout(60);
        const [scale, ramp] = await Promise.all(["#scale", ".ramp"].map((name) => page.locator(name).boundingBox()));
        assert.ok(scale.x + scale.width <= ramp.x, `${width}: ${scale.x + scale.width} and ${ramp.x}`);
        assert.ok(ramp.x + ramp.width <= width, `${width}: the ramp ends at ${ramp.x + ramp.width}`);
      }
    });
  }
});

test("tells how long the first paint and the first cloud take", async (t) => {
  const server = await serve({ points: 4000 });
  const page = await openPage(browser, server.address, kSmall, listen);
  await until("both", async () => Object.values(await firstPaint(page)).every((time) => time > 0));
  const { paint, cloud } = await firstPaint(page);
  t.diagnostic(`first paint after ${paint.toFixed(0)} ms, first cloud after ${cloud.toFixed(0)} ms`);
  assert.ok(paint <= cloud, "the page is there before its cloud");
  await page.context().close();
  await server.close();
});

test("a browser without WebGL 2 is told so", async () => {
  const server = await serve({ points: 1000 });
  const page = await openPage(browser, server.address, kSmall, () => {
    const plain = window.HTMLCanvasElement.prototype.getContext;
    window.HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind === "webgl2" ? null : plain.call(this, kind, ...rest);
    };
  });
  await until("said", async () => /cannot render[\s\S]*WebGL 2/.test(await page.locator("#cover").innerText()));
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});

test("a scale bar is true from the first one on", async () => {
  const server = await serve({ points: 4000 });
  const page = await openPage(browser, server.address, kSmall, () => {
    window.scales = new Set();
    document.addEventListener("DOMContentLoaded", () => {
      const look = () => {
        const label = document.getElementById("scale-label");
        if (label.offsetParent !== null && label.textContent !== "") window.scales.add(label.textContent);
        requestAnimationFrame(look);
      };
      look();
    });
  });
  await until("a bar", async () => (await page.evaluate(() => window.scales.size)) > 0);
  await page.waitForTimeout(1000);
  const lengths = await page.evaluate(() => [...window.scales]);
  for (const length of lengths) assert.match(length, /^(20|50|100|200) mm$/, `of a table of 0.7 m: ${lengths}`);
  await page.context().close();
  await server.close();
});

test("two hands are told apart, and why one is silent is said", async () => {
  const why = "no client is heard on '/run/hand'; start one";
  const server = await serve({ points: 4000, silent: why });
  const page = await openPage(browser, server.address, kSmall);
  const tags = page.locator("#tags span:not([hidden])");
  await until("tags", async () => (await tags.allInnerTexts()).sort().join() === "remote,simulated");
  await until("a notice", async () => (await text(page, "#notices")).includes(`remote: ${why}`));
  await page.getByRole("combobox", { name: "Tool" }).selectOption({ label: "remote (silent)" });
  await until("the reason", async () => (await text(page, "#touch")) === `silent: ${why}`);
  assert.equal(await tags.filter({ hasText: "remote" }).getAttribute("class"), "chosen");
  server.program.silent = undefined;
  await until("heard", async () => (await text(page, "#notices")).includes("remote is back"));
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});

test("after the watchdog it is said beside the force how soft it is, and that what motors push has to be lifted", () =>
  withPage(kSmall, async (page, program) => {
    program.servo.exploring = () => [0.05, 0.1, -0.004];
    await until("in contact", () => program.servo.contact !== undefined);
    program.servo.starting = true;
    await until("said", async () => /^soft: \d+ %$/.test(await text(page, "#lift")));
    program.motors = true;
    program.beginAnew();
    await until("said", async () => /^soft: \d+ %; lift the tool to feel full force again$/.test(await text(page, "#lift")));
    program.servo.starting = false;
    await until("gone", async () => (await text(page, "#lift")) === "");
  }));

test("plots are drawn ten times a second at most, and those that change slowly twice", () =>
  withPage(kSmall, async (page) => {
    const { times, passed } = await page.evaluate(async () => {
      const times = { force: [], spectrum: [], steps: [] };
      const begin = performance.now();
      const clear = window.CanvasRenderingContext2D.prototype.clearRect;
      window.CanvasRenderingContext2D.prototype.clearRect = function (...box) {
        times[this.canvas.closest("figure")?.classList[1]]?.push(performance.now());
        return clear.apply(this, box);
      };
      await new Promise((done) => setTimeout(done, 3000));
      return { times, passed: (performance.now() - begin) / 1000 }; // longer on a busy machine
    });
    const most = { force: 10, spectrum: 2, steps: 2 };
    for (const [name, rate] of Object.entries(most)) {
      const drawn = times[name].length;
      assert.ok(drawn > 0 && drawn <= passed * rate + 1, `${name}: ${drawn} pictures in ${passed} s`);
    }
  }));

test("a game controller takes the tool, moves it and shakes with the force", () =>
  withPage(kSmall, async (page, program) => {
    await page.evaluate(() => {
      window.pad = { connected: true, id: "Standard", axes: [0, 0, 0, 0], buttons: [{ pressed: false }, { pressed: false }] };
      window.shakes = 0;
      window.pad.vibrationActuator = { playEffect: async () => void (window.shakes += 1) };
      navigator.getGamepads = () => [window.pad];
    });
    await page.evaluate(() => (window.pad.buttons[0].pressed = true));
    await until("held", () => program.servo.taken);
    const begin = hands(program).at(-1).position;
    await page.evaluate(() => (window.pad.axes = [0, 0, 0, -1]));
    await until("moved", () => Math.hypot(...hands(program).at(-1).position.map((c, i) => c - begin[i])) > 0.01);
    await until("shakes", () => page.evaluate(() => window.shakes > 0));
    await page.evaluate(() => (window.pad.buttons[1].pressed = true));
    await until("released", () => sent(program, "release").length === 1);
  }));

test("a tour takes the tool and presses; Escape ends it, and the settings are as they were", () =>
  withPage(kSmall, async (page, program) => {
    const stiffness = () => program.settings.find(({ key }) => key === "stiffness").value;
    await page.getByRole("spinbutton", { name: "Stiffness" }).fill("800");
    await page.keyboard.press("Enter");
    await until("set", () => stiffness() === 800);
    await page.click("#help");
    await page.click("#tour-start");
    await until("says what it does", async () => /presses/.test(await text(page, "#tour")));
    await until("presses", () => hands(program).at(-1)?.force === 1);
    await until("shows fur", () => stiffness() === 240);
    await page.keyboard.press("Escape");
    await until("released", () => !program.servo.taken);
    await until("as before", () => stiffness() === 800);
    assert.equal(await text(page, "#tour"), "");
  }));
