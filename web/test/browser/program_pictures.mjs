// Pictures of the page with palpate behind it, in contact:
// PALPATE_PROGRAM=.../palpate node test/browser/program_pictures.mjs [FOLDER] [NAME...]

import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { openBrowser, openPage, until } from "./browser.mjs";
import { felt, firstPaint, listen } from "./heard.mjs";
import { startProgram } from "./real_program.mjs";

const folder = process.argv[2] ?? "../docs/images";
const wanted = process.argv.slice(3);
const nearer = (page) => turnWheel(page, -3);
const closeBy = async (page) => {
  await page.click("#follow");
  await page.waitForTimeout(1000);
  await turnWheel(page, 9);
};
const kPictures = [
  ["page", "desk", "60 000", nearer, { viewport: { width: 1440, height: 900 } }],
  ["page-simple", "scan", "60 000", (page) => page.locator("#presets").getByText("wood").click(), { viewport: { width: 1440, height: 900 } }],
  ["page-phone", "scan", "30 000", closeBy, { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true }],
];
const kTouch = 1; // N
const kFirm = 2; // N
const kSettled = 1500; // ms, for what is drawn to be what is felt
const kPast = 12_000; // ms, for the plots to fill

async function turnWheel(page, notches) {
  await page.hover("#view");
  for (let i = 0; i < Math.abs(notches); i += 1) await page.mouse.wheel(0, 100 * Math.sign(notches));
}

/** Takes the tool where it touches something from above, and presses. */
async function press(page) {
  await until("in contact", async () => {
    const { force, normal } = await felt(page);
    return force > kTouch && normal[2] > 0.8;
  });
  await page.keyboard.press("t");
  await until("taken", async () => (await felt(page)).taken);
  await page.keyboard.down("ArrowDown");
  await until("firmly", async () => (await felt(page)).force > kFirm);
  await page.keyboard.up("ArrowDown");
  await page.waitForTimeout(kSettled);
  await until("nothing to note", async () => (await page.locator("#flags li:not([hidden])").count()) === 0);
  if ((await felt(page)).force < kTouch) throw new Error("the tool slid off: once more, please");
}

/** A setting of the view that is a choice; in the page, since a phone shows one panel at a time. */
async function choose(page, label, wanted) {
  await page.evaluate(([name, text]) => {
    const row = [...document.querySelectorAll("#look .field")].find((one) => one.textContent.startsWith(name));
    const select = row.querySelector("select");
    const plain = (words) => words.replace(/\s/g, " ");
    select.value = [...select.options].find((option) => plain(option.textContent) === text).value;
    select.dispatchEvent(new window.Event("change"));
  }, [label, wanted]);
}

await mkdir(folder, { recursive: true });
const browser = await openBrowser();
for (const [name, scene, points, look, options] of kPictures) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const program = await startProgram(["demo", scene, "--headless", "--port", "0"]);
  const page = await openPage(browser, program.address, { ...options, reducedMotion: "reduce" }, listen, name === "page-simple");
  await until("the page is connected", () => page.locator("#take").isEnabled());
  await choose(page, "Maximum points", points);
  await look(page);
  await page.waitForTimeout(kPast);
  const first = await firstPaint(page);
  await press(page);
  await page.evaluate(() => document.querySelectorAll("#notices button").forEach((close) => close.click()));
  await page.screenshot({ path: join(folder, `${name}.png`), timeout: 120_000 });
  console.log(`${name}: first paint after ${first.paint.toFixed(0)} ms, first cloud after ${first.cloud.toFixed(0)} ms`, ...page.troubles);
  await page.context().close();
  await program.stop();
}
await browser.close();
