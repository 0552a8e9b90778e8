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

/** Runs in a page before its scripts: counts what it has on the graphics card. */
function countBuffers() {
  const { prototype } = window.WebGL2RenderingContext;
  const { createBuffer, deleteBuffer } = prototype;
  window.buffers = new Set();
  prototype.createBuffer = function () {
    const buffer = createBuffer.call(this);
    window.buffers.add(buffer);
    return buffer;
  };
  prototype.deleteBuffer = function (buffer) {
    window.buffers.delete(buffer);
    return deleteBuffer.call(this, buffer);
  };
}

test("a cloud of which a part is drawn while it changes leaves nothing on the graphics card", async () => {
  const server = await serve({ points: 50_000 }); // more than are drawn of what moves
  const { program } = server;
  const page = await openPage(browser, server.address, kSmall, countBuffers);
  await ready(page);
  const { tellClouds } = program;
  const count = () => page.evaluate(() => window.buffers.size);
  /** Buffers of a run without a cloud, once they are the same for half a second. */
  async function left() {
    program.tellClouds = () => {};
    program.beginAnew();
    let [last, since] = [NaN, Date.now()];
    await until("the cloud before is gone", async () => {
      const now = await count();
      if (now !== last) [last, since] = [now, Date.now()];
      return Date.now() - since > 500;
    });
    program.tellClouds = tellClouds;
    return last;
  }
  await page.waitForTimeout(1000); // clouds come ten times a second
  const first = await left();
  for (let run = 0; run < 4; run += 1) {
    program.beginAnew();
    await until("clouds", async () => (await count()) > first + 8);
    await page.waitForTimeout(1000);
  }
  const last = await left();
  assert.ok(last <= first, `${first}, ${last} buffers: an index more for each of two clouds in each of four runs`);
  await page.context().close();
  await server.close();
});
