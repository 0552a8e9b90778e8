// Debian's chromium without a screen, drawing in software.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const kPlaces = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

export async function openBrowser() {
  const executablePath = kPlaces.find((place) => place && existsSync(place));
  if (executablePath === undefined) {
    throw new Error("no chromium: install it, or say with CHROMIUM where it is");
  }
  return chromium.launch({
    executablePath,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-audio-output"],
  });
}

const kPatience = 30_000; // ms, where the machine is busy

/** Waits for something to become true. */
export async function until(what, condition) {
  const end = Date.now() + kPatience;
  while (!(await condition())) {
    if (Date.now() > end) assert.fail(`waited in vain: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** Waits until a page is connected with its program. */
export const connected = (page) => until("connected", async () => (await page.getAttribute("#link-state", "data-phase")) === "open");

/** Does something become true within `patience` ms? */
export async function soon(condition, patience = 2000) {
  const end = Date.now() + patience;
  while (Date.now() < end) {
    if (await condition()) return true;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  return false;
}

/** Runs in a page before its scripts: the browser remembers that all panels were asked for. */
function askForAll() {
  const key = "palpate.panels";
  if (location.protocol === "http:" && localStorage.getItem(key) === null) localStorage.setItem(key, '"all"');
}

/** A page that remembers what went wrong on it; `before` is run in it before its own scripts. `first`: it is a first visit. */
export async function openPage(browser, address, options, before, first = false) {
  const context = await browser.newContext(options);
  if (!first) await context.addInitScript(askForAll);
  if (before !== undefined) await context.addInitScript(before);
  const page = await context.newPage();
  page.troubles = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) page.troubles.push(message.text());
  });
  page.on("pageerror", (error) => page.troubles.push(String(error)));
  await page.goto(address, { waitUntil: "domcontentloaded", timeout: 120_000 });
  return page;
}
