// What becomes of a page whose program goes on to another run. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { connected, openPage, until } from "./browser.mjs";
import { browser, kSmall, ready } from "./with_page.mjs";

test("a link's settings wait while clouds are read, also for a page that is loaded again", async () => {
  const server = await serve({ points: 1000 });
  const { program } = server;
  const { welcome } = program;
  program.welcome = function () {
    return { ...welcome.call(this), run: "reading", devices: [], sources: [], settings: [], presets: [] };
  };
  const page = await openPage(browser, `${server.address}&stiffness=900`, kSmall);
  await connected(page);
  await page.reload();
  await connected(page);
  program.welcome = welcome;
  program.beginAnew();
  await until("set", () => program.settings.find(({ key }) => key === "stiffness").value === 900);
  assert.equal(await page.evaluate(() => location.href), server.address, "not again when it is loaded again");
  assert.equal(await page.locator("#notices").innerText(), "");
  await page.context().close();
  await server.close();
});

/** Runs in a page before its scripts: counts what it has on the graphics card, and points that are drawn by an index. */
function countBuffers() {
  const { prototype } = window.WebGL2RenderingContext;
  const { createBuffer, deleteBuffer, drawElements } = prototype;
  window.buffers = new Set();
  window.parts = 0;
  prototype.createBuffer = function () {
    const buffer = createBuffer.call(this);
    window.buffers.add(buffer);
    return buffer;
  };
  prototype.deleteBuffer = function (buffer) {
    window.buffers.delete(buffer);
    return deleteBuffer.call(this, buffer);
  };
  prototype.drawElements = function (...how) {
    if (how[0] === this.POINTS) window.parts += 1;
    return drawElements.apply(this, how);
  };
}

const kClouds = 2; // of the made-up program

test("a cloud of which a part is drawn while it changes leaves nothing on the graphics card", async () => {
  const server = await serve({ points: 50_000 }); // more than are drawn of what moves
  const { program } = server;
  const { welcome } = program;
  const page = await openPage(browser, server.address, kSmall, countBuffers);
  await ready(page);
  const left = []; // buffers of a run of nothing, which comes after each run
  for (let run = 0; run < 5; run += 1) {
    const before = await page.evaluate(() => window.parts);
    await until("parts of clouds", async () => (await page.evaluate(() => window.parts)) > before + 3 * kClouds);
    const scene = `nothing ${run}`;
    program.welcome = function () {
      return { ...welcome.call(this), scene, devices: [], sources: [] };
    };
    program.beginAnew();
    await until("nothing", async () => (await page.title()).startsWith(scene));
    left.push(await page.evaluate(() => window.buffers.size));
    program.welcome = welcome;
    program.beginAnew();
  }
  // What is made once may be made late; a leak is one of each run, and a picture may begin a run with one cloud alone.
  const kept = left.slice(1).map((count, i) => count - left[i]);
  assert.ok(kept.some((more) => more <= 0), `${left} buffers after each run`);
  await page.context().close();
  await server.close();
});
