// Debian's chromium without a screen, drawing in software.

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

/** A page that remembers what went wrong on it. */
export async function openPage(browser, address, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.troubles = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) page.troubles.push(message.text());
  });
  page.on("pageerror", (error) => page.troubles.push(String(error)));
  await page.goto(address, { waitUntil: "domcontentloaded", timeout: 120_000 });
  return page;
}
