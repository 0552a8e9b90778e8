// Pictures of the page to look at: node test/browser/pictures.mjs [FOLDER] [NAME...]

import { mkdir } from "node:fs/promises";
import { serve } from "../fake_server.mjs";
import { openBrowser, openPage } from "./browser.mjs";

const folder = process.argv[2] ?? "pictures";
const wanted = process.argv.slice(3);
const kDesktop = { viewport: { width: 1440, height: 900 } };
const kPhone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };
const tab = (name) => (page) => page.click(`.tabs [data-tab="${name}"]`);
const kPictures = [
  ["desktop_light", kDesktop, "light"],
  ["desktop_dark", kDesktop, "dark"],
  ["laptop_light", { viewport: { width: 1180, height: 660 } }, "light"],
  ["phone_light", kPhone, "light"],
  ["phone_dark", kPhone, "dark", tab("settings")],
  ["phone_sources", kPhone, "light", tab("sources")],
  ["phone_timing", kPhone, "dark", tab("timing")],
  ["desktop_held", kDesktop, "light", async (page) => {
    await page.keyboard.press("t");
    await page.selectOption("#look select", { label: "automatic" });
    await page.click("#record");
  }],
  ["phone_landscape", { ...kPhone, viewport: { width: 844, height: 390 } }, "light"],
  ["light_to_dark", kDesktop, "light", (page) => page.emulateMedia({ colorScheme: "dark" })],
  ["still_desktop", kDesktop, "light"],
  ["desktop_hover", kDesktop, "light", async (page) => {
    await page.keyboard.press("h");
    await page.mouse.move(250, 800);
  }],
  ["desktop_notices", kDesktop, "dark", async () => {
    for (const [level, text] of [["info", "the right camera is back"], ["warning", "left: 12 of 30 frames came too late"],
      ["fault", "the device answers no more: check its cable, then press Reset"]]) {
      server.program.tell({ type: "notice", level, text });
    }
    server.program.servo.bound = 0.5;
  }],
  ["desktop_cover", kDesktop, "light", async (page) => {
    await page.goto("about:blank");
    await page.goto(server.address.replace(/#.*/, ""));
  }],
  ["desktop_close", kDesktop, "light", (page) => page.click("#follow")],
  ["desktop_close_dark", kDesktop, "dark", async (page) => {
    await page.selectOption("#look select", { label: "height" });
    await page.click("#follow");
  }],
  ["desktop_source", kDesktop, "dark", (page) => page.selectOption("#look select", { label: "source" })],
  ["silent_light", kDesktop, "light"],
  ["silent_dark", kDesktop, "dark", (page) => page.selectOption("#device", "1")],
  ["silent_phone", kPhone, "light", (page) => page.selectOption("#device", "1")],
  ["desktop_lift", kDesktop, "light", () => trip()],
  ["phone_lift", kPhone, "dark", () => trip()],
  ["simple_light", kDesktop, "light"],
  ["simple_phone", kPhone, "dark"],
  ["desktop_help", kDesktop, "light", (page) => page.click("#help")],
];

/** The watchdog, in contact; the tool stays down. */
function trip() {
  server.program.servo.exploring = () => [0.05, 0.1, -0.004];
  setTimeout(() => (server.program.servo.starting = true), 1000);
}

await mkdir(folder, { recursive: true });
const server = await serve();
const still = await serve({ still: true });
const silent = await serve({ silent: "no client is heard on '/run/user/1000/palpate-device'; start one" });
const browser = await openBrowser();
for (const [name, options, scheme, act] of kPictures) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const of = name.startsWith("still") ? still : name.startsWith("silent") ? silent : server;
  const page = await openPage(browser, of.address, { ...options, colorScheme: scheme }, undefined, name.startsWith("simple"));
  await page.waitForTimeout(6500);
  await act?.(page);
  await page.waitForTimeout(1800);
  await page.screenshot({ path: `${folder}/${name}.png`, timeout: 120_000 });
  console.log(name, ...page.troubles);
  await page.context().close();
}
await browser.close();
await server.close();
await still.close();
await silent.close();
