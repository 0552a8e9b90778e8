// The page of a tab, served as any server of files does it.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { until } from "./browser.mjs";
import { felt } from "./heard.mjs";
import { pointAt } from "./touching.mjs";

const kTypes = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
export const kHome = "/some/where/"; // of the site on its server

/** Serves the site, and `clouds` by their paths below it; remembers what it was asked for. */
export async function serveSite(site, clouds = {}) {
  const asked = [];
  const server = createServer((request, response) => void answer(request, response));
  async function answer(request, response) {
    const path = decodeURIComponent(new URL(request.url, "http://x").pathname);
    asked.push(path);
    try {
      const name = path.startsWith(kHome) ? path.slice(kHome.length) || "index.html" : assert.fail("outside");
      const body = clouds[name] ?? (await readFile(join(site, name)));
      response.writeHead(200, { "Content-Type": kTypes[extname(name)] ?? "application/octet-stream" }).end(body);
    } catch {
      response.writeHead(404).end();
    }
  }
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { asked, address: `http://127.0.0.1:${server.address().port}${kHome}`, close: () => server.close() };
}

/** Presses the mouse on what is in the middle of the view until it is felt; resolves to the force, N. `frame`: of the page that has the view. */
export async function touch(page, frame = page) {
  const { x, y, width, height } = await frame.locator("#view").boundingBox();
  await pointAt(page, x + width / 2, y + height / 2, frame);
  await page.mouse.down();
  let force = 0;
  await until("the mouse presses it", async () => {
    const state = await felt(frame);
    force = state.force;
    return state.taken && state.touching && force > 0.05;
  });
  await page.mouse.up();
  return force;
}
