// Drags over what a demo shows, seeded: how many touch it. PALPATE_PROGRAM=... node test/browser/drags.mjs [SCENE...] [SEED]
import assert from "node:assert/strict";
import { pathToFileURL } from "node:url";
import { openBrowser, openPage, until } from "./browser.mjs";
import { felt, listen } from "./heard.mjs";
import { randomFrom } from "../fake/scene.mjs";
import { startProgram } from "./real_program.mjs";

const graspable = (page, at) =>
  page.evaluate((at) => document.elementFromPoint(...at)?.classList.contains("graspable") ?? false, at);

/** Of `count` drags that begin on a surface, those in which it was touched: share of looks in contact and largest force, N.
 * `patience`: looks more, back at the beginning, for one that has not touched: a busy machine needs longer to get there. */
export async function drags(page, count, seed, patience = 0) {
  const next = randomFrom(seed);
  const { x, y, width, height } = await page.locator("#view").boundingBox();
  const looks = [];
  for (let tries = 0; looks.length < count && tries < 40 * count; tries += 1) {
    const [fromX, fromY, angle] = [x + width * (0.1 + 0.8 * next()), y + height * (0.1 + 0.8 * next()), 2 * Math.PI * next()];
    await page.mouse.move(fromX, fromY);
    if (!(await graspable(page, [fromX, fromY]))) continue;
    await page.mouse.down();
    const look = { from: [Math.round(fromX), Math.round(fromY)], looks: 0, touching: 0, most: 0 };
    for (let i = 0; i <= 40; i += 1) {
      const way = (0.15 * height * Math.max(0, i - 10)) / 30;
      await page.mouse.move(fromX + way * Math.cos(angle), fromY + way * Math.sin(angle));
      await new Promise((done) => setTimeout(done, 40));
      const { touching, force } = await felt(page);
      if (i < 10) continue;
      look.looks += 1;
      look.touching += touching && force > 0.05 ? 1 : 0;
      look.most = Math.max(look.most, force);
    }
    if (look.touching === 0) await page.mouse.move(fromX, fromY);
    for (let i = 0; look.touching === 0 && i < patience; i += 1) {
      await new Promise((done) => setTimeout(done, 40));
      look.touching += (await felt(page)).touching ? 1 : 0;
    }
    await page.mouse.up();
    looks.push(look);
  }
  return looks;
}

/** As a test: four drags over the scan of `palpate demo scan`. */
export async function dragsTouch(context, browser) {
  const program = await startProgram(["demo", "scan", "--headless", "--port", "0"]);
  context.after(() => program.stop());
  const page = await openPage(browser, program.address, { viewport: { width: 900, height: 600 } }, listen);
  await until("the tool can be taken", () => page.locator("#take").isEnabled());
  const found = await drags(page, 4, 5, 500);
  assert.equal(found.length, 4);
  for (const { from, touching, looks } of found) assert.ok(touching > 0, `from ${from}: ${touching} of ${looks} looks in contact`);
  await page.context().close();
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const scenes = process.argv.slice(2).filter((word) => !/^\d+$/.test(word));
  const seed = Number(process.argv.slice(2).find((word) => /^\d+$/.test(word)) ?? 1);
  const browser = await openBrowser();
  for (const scene of scenes.length > 0 ? scenes : ["scan", "desk", "room"]) {
    const program = await startProgram(["demo", scene, "--headless", "--port", "0"]);
    const page = await openPage(browser, program.address, { viewport: { width: 1280, height: 720 } }, listen);
    await until("the tool can be taken", () => page.locator("#take").isEnabled());
    await new Promise((done) => setTimeout(done, 4000));
    const found = await drags(page, 6, seed);
    console.log(scene, `${found.filter(({ touching }) => touching > 0).length} of ${found.length} touch`);
    for (const { from, looks, touching, most } of found) console.log("  ", from.join(","), `${touching} of ${looks} looks in contact, at most ${most.toFixed(2)} N`);
    await page.context().close();
    await program.stop();
  }
  await browser.close();
}
