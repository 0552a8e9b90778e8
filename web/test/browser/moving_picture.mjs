// The README's moving picture: a scan is dropped on the page, pressed and stroked, and its force runs.
// PALPATE_PROGRAM=.../palpate node test/browser/moving_picture.mjs [FILE] [FOLDER for the frames as PNG]

import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { openBrowser, openPage, until } from "./browser.mjs";
import { movingPicture } from "./webp.mjs";
import { rabbit } from "./rabbit.mjs";
import { startProgram } from "./real_program.mjs";

const file = process.argv[2] ?? "../docs/images/palpate.webp";
const folder = process.argv[3];
const kView = { viewport: { width: 1000, height: 625 }, bypassCSP: true };
const kPace = 80; // ms between two frames, at least
const kStall = 200; // ms that one is seen, at most: the machine that is filmed draws, films and feels at once
const kSettled = 4000; // ms, for a page to be as sharp as it gets
const kLast = 1200; // ms that the last one is seen

const wait = (ms) => new Promise((done) => setTimeout(done, ms));

/** Draws a pointer, and beside it the name of what it drags, where there is something. */
const showPointer = (name) => {
  const arrow = '<svg width="22" height="30"><path d="M1 1v21l5-5 4 9 4-2-4-9h7z" fill="#111" stroke="#fff" stroke-width="1.5"/></svg>';
  const card = `<span style="position:absolute;left:16px;top:20px;padding:6px 12px;border-radius:8px;background:#fff;box-shadow:0 3px 12px #0005;font:600 15px system-ui">${name}</span>`;
  const pointer = document.createElement("div");
  pointer.style.cssText = "position:fixed;left:0;top:0;z-index:99;pointer-events:none";
  pointer.innerHTML = arrow + card;
  document.body.append(pointer);
  const follow = ({ clientX, clientY }) => (pointer.style.translate = `${clientX}px ${clientY}px`);
  for (const type of ["mousemove", "dragover"]) window.addEventListener(type, follow, true);
  window.addEventListener("drop", () => pointer.querySelector("span").remove(), true);
};

/** Moves from one place to another as a hand does, `act` at each of its places. */
async function glide(from, to, ms, act) {
  const begin = Date.now();
  for (let part = 0; part < 1; ) {
    part = Math.min(1, (Date.now() - begin) / ms);
    const way = part * part * (3 - 2 * part);
    await act(from.map((x, i) => x + way * (to[i] - x)));
    await wait(15);
  }
}

async function drop(page, name, text, from, to) {
  const files = await page.evaluateHandle(([name, text]) => {
    const files = new DataTransfer();
    files.items.add(new File([text], name));
    return files;
  }, [name, text]);
  const drag = (type) => ([clientX, clientY]) => page.dispatchEvent("#view", type, { dataTransfer: files, clientX, clientY });
  await drag("dragenter")(from);
  await glide(from, to, 900, drag("dragover"));
  await drag("drop")(to);
}

/** What is painted, from now until `stop` is called: PNGs and when, ms. */
async function film(page) {
  const cast = await page.context().newCDPSession(page);
  const shots = [];
  cast.on("Page.screencastFrame", ({ data, metadata, sessionId }) => {
    shots.push({ shot: data, at: 1000 * metadata.timestamp });
    void cast.send("Page.screencastFrameAck", { sessionId });
  });
  await cast.send("Page.startScreencast", { format: "png" });
  return async () => {
    await cast.send("Page.stopScreencast");
    return shots;
  };
}

/** Of shots those that are far enough apart, with how long each is seen. */
function paced(shots) {
  const kept = [];
  for (const shot of shots) if (kept.length === 0 || shot.at - kept.at(-1).at >= kPace) kept.push(shot);
  return kept.map(({ shot, at }, i) => ({ shot, milliseconds: i + 1 < kept.length ? Math.min(Math.round(kept[i + 1].at - at), kStall) : kLast }));
}

/** The story: 10 s. */
async function play(page, begin) {
  const move = ([x, y]) => page.mouse.move(x, y);
  const wheel = async (notches) => {
    for (let i = 0; i < notches; i += 1) {
      await page.mouse.wheel(0, -100);
      await wait(80);
    }
  };
  await drop(page, "rabbit.xyz", rabbit(), begin, [470, 300]);
  await until("the rabbit", async () => (await page.locator("#scene").innerText()) === "rabbit");
  await until("its scale", async () => / mm$/.test(await page.locator("#scale-label").innerText()));
  await wait(400);
  await glide([470, 300], [420, 360], 500, move);
  await page.mouse.down();
  await wait(500);
  await wheel(7);
  await glide([420, 360], [520, 330], 1000, move);
  await page.mouse.up();
  const { x, y, width, height } = await page.locator("#panels").boundingBox();
  const button = [x + width / 2, y + height / 2];
  await glide([520, 330], button, 600, move);
  await page.mouse.click(...button);
  await glide(button, [300, 250], 600, move);
  await page.mouse.down();
  await wheel(5);
  await glide([300, 250], [400, 260], 1200, move);
  await page.mouse.up();
  await wait(300);
}

const browser = await openBrowser();
const program = await startProgram(["demo", "room", "--headless", "--port", "0"]);
const page = await openPage(browser, program.address, kView, () => localStorage.setItem("palpate.points", "60000"), true);
await until("the tool can be taken", () => page.locator("#take").isEnabled());
await until("its scale", async () => / m$/.test(await page.locator("#scale-label").innerText()));
await page.evaluate(showPointer, "rabbit.xyz");
const kBegin = [60, 600];
await page.mouse.move(...kBegin);
await wait(kSettled);
const stop = await film(page);
await play(page, kBegin);
const shots = paced(await stop());
if (folder !== undefined) {
  await mkdir(folder, { recursive: true });
  await Promise.all(shots.map(({ shot }, i) => writeFile(join(folder, `${String(i).padStart(3, "0")}.png`), Buffer.from(shot, "base64"))));
}
const picture = await movingPicture(page, shots);
await writeFile(file, picture);
console.log(`${file}: ${shots.length} frames, ${(shots.reduce((sum, { milliseconds }) => sum + milliseconds, 0) / 1000).toFixed(1)} s, ${picture.length} bytes`, ...page.troubles);
await browser.close();
await program.stop();
