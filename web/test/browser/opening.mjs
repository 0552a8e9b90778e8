// A file that is dropped on the page, or chosen, is touched next.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { ball } from "./ball.mjs";
import { connected, openPage, until } from "./browser.mjs";
import { e57 } from "./e57.mjs";
import { felt, listen } from "./heard.mjs";
import { startProgram } from "./real_program.mjs";

/** A cube as OBJ: eight vertices and six faces. */
function cube(side) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => `v ${side * (k & 1)} ${(side / 2) * (k & 2)} ${(side / 4) * (k & 4)}`);
  const faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"].map((face) => `f ${face}`);
  return [...corners, ...faces].join("\n");
}

/** A floor as E57: three scans of 6 x 6 cm, each from 1 m above its middle. */
function floor() {
  const points = Array.from({ length: 31 * 31 }, (_, i) => [0.002 * (i % 31) - 0.03, 0.002 * Math.floor(i / 31) - 0.03, -1]);
  return e57([0, 0.04, 0.08].map((x) => ({ points, scanner: [x, 0, 1] })));
}

const seed = (path) => readFile(new URL(`../../../fuzz/corpus/${path}`, import.meta.url));

/** As a person does who drags a file from elsewhere over the page: first it is over it, then it is let go. */
async function drag(page, name, text, types) {
  const files = await page.evaluateHandle(([name, text]) => {
    const files = new DataTransfer();
    files.items.add(new File([text], name));
    return files;
  }, [name, text]);
  for (const type of types) await page.dispatchEvent("#view", type, { dataTransfer: files });
}

const said = (page, words) => until(words, async () => (await page.locator("#notices .warning").allTextContents()).join().includes(words));

/** A cube of 20 is 20 mm, until somebody says otherwise; then an example. */
async function unitsAndExamples(page, scene) {
  const unit = (name) => until(`the unit ${name}`, async () => (await page.getByLabel("Unit of part").inputValue().catch(() => "")) === name);
  await page.setInputFiles("#open-file", { name: "part.obj", mimeType: "text/plain", buffer: Buffer.from(cube(20)) });
  await unit("mm");
  await until("its scale", async () => /^\d+ mm$/.test(await page.locator("#scale-label").innerText()));
  assert.match(await page.locator("#ask").innerText(), /^part: 20 x 20 x 20 mm\?/);
  await page.locator("#ask").getByRole("button", { name: "m", exact: true }).click();
  await until("its scale in metres", async () => /^\d+ m$/.test(await page.locator("#scale-label").innerText()));
  assert.ok(await page.locator("#ask").isHidden(), "it is answered");
  await unit("m");
  await connected(page);
  await page.getByLabel("Scene").selectOption("desk");
  await until("the desk", async () => (await scene()) === "desk");
  assert.equal(await page.locator("#units select").count(), 0, "a camera's unit is its own");
}

export async function opens(browser) {
  const program = await startProgram(["touch", "table.xyz", "--view", "--port", "0"]);
  const page = await openPage(browser, program.address, { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" }, listen);
  const scene = () => page.locator("#scene").innerText();
  try {
    await connected(page);
    await drag(page, "notes.txt", "this is no cloud", ["dragenter", "dragover"]);
    await page.locator("#drop").waitFor({ state: "visible" });
    await drag(page, "notes.txt", "this is no cloud", ["drop"]);
    await page.locator("#drop").waitFor({ state: "hidden" });
    await said(page, "notes.txt, line 1");
    assert.equal(await scene(), "table", "what cannot be read has ended the run");
    await drag(page, "Größe 点 (1).xyz", ball(0.05), ["dragenter", "dragover", "drop"]);
    await until("the dropped cloud", async () => (await scene()) === "Größe 点 (1)");
    await connected(page);
    await until("steps", async () => /steps\/s/.test(await page.locator("#link-words").innerText()));
    await until("its scale", async () => / mm$/.test(await page.locator("#scale-label").innerText()));
    await page.setInputFiles("#open-file", { name: "Größe 点 (1).xyz", mimeType: "text/plain", buffer: Buffer.from(ball(50)) });
    await until("the whole of a larger one", async () => / m$/.test(await page.locator("#scale-label").innerText()));
    assert.equal(await scene(), "Größe 点 (1)", "of the same name");
    await connected(page);
    await until("it is felt", async () => Number(await page.locator("#force").innerText()) > 0);
    await page.setInputFiles("#open-file", { name: "house.e57", mimeType: "application/octet-stream", buffer: floor() });
    await until("a source of each scan", async () => (await scene()) === "house-1 + house-2 + house-3");
    await connected(page);
    await until("its floor is felt", async () => {
      const { force, proxy } = await felt(page);
      return force > 0 && Math.hypot(...proxy) < 0.15; // the ball before is larger
    });
    const others = { "cube.obj": Buffer.from(cube(0.1)), "survey.laz": await seed("laz/format_8"), "room.spz": await seed("spz/version3") };
    for (const [name, buffer] of Object.entries(others)) {
      await page.setInputFiles("#open-file", { name, mimeType: "application/octet-stream", buffer });
      await until(name, async () => (await scene()).startsWith(name.split(".")[0]));
      await connected(page);
    }
    await unitsAndExamples(page, scene);
  } finally {
    await page.context().close();
    assert.equal(await program.stop(), 0);
  }
}
