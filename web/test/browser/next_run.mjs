// What becomes of a page whose program goes on to another run. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { openPage, until } from "./browser.mjs";
import { browser, kSmall, ready } from "./with_page.mjs";

test("a link's settings wait while clouds are read, also for a page that is loaded again", async () => {
  const server = await serve({ points: 1000 });
  const { program } = server;
  const { welcome } = program;
  program.welcome = function () {
    return { ...welcome.call(this), run: "reading", devices: [], sources: [], settings: [], presets: [] };
  };
  const page = await openPage(browser, `${server.address}&stiffness=900`, kSmall);
  const connected = () => until("connected", async () => (await page.getAttribute("#link-state", "data-phase")) === "open");
  await connected();
  await page.reload();
  await connected();
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

/** Runs in a page: the fewest buffers that it had within one and a half seconds, in which clouds come ten times a second. */
async function leastBuffers() {
  let least = Infinity;
  for (const end = Date.now() + 1500; Date.now() < end; ) {
    await new Promise((resolve) => setTimeout(resolve, 20));
    least = Math.min(least, window.buffers.size);
  }
  return least;
}

test("a cloud of which a part is drawn while it changes leaves nothing on the graphics card", async () => {
  const server = await serve({ points: 50_000 }); // more than are drawn of what moves
  const page = await openPage(browser, server.address, kSmall, countBuffers);
  await ready(page);
  const held = []; // the least of each run: a cloud that is replaced holds the buffers of both for a moment
  for (let i = 0; i < 6; i += 1) {
    server.program.beginAnew();
    held.push(await page.evaluate(leastBuffers));
  }
  const most = Math.max(...held.slice(2));
  assert.ok(most < held[1] + 8, `${held.join(", ")} buffers: an index more for each of two clouds in each of four runs`);
  await page.context().close();
  await server.close();
});
