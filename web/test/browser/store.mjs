// A store on disk: all of it is seen, and what is around the tool is read and felt.

import assert from "node:assert/strict";
import { mkdtemp, rm, truncate } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { openPage, soon, until } from "./browser.mjs";
import { felt, heard, listen } from "./heard.mjs";
import { picture } from "./picture.mjs";
import { run, startProgram } from "./real_program.mjs";

const kSize = { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" };
const kFar = [600, 215]; // pixels: on the ground, far from where the tool begins

export async function feelsStore(browser) {
  const folder = await mkdtemp(join(tmpdir(), "palpate-store-"));
  const site = join(folder, "site");
  assert.equal((await run(["tile", "synthetic:terrain:4e6", "--out", site])).code, 0);
  const program = await startProgram(["touch", site, "--cache", "64M", "--device", "simulated", "--view", "--port", "0"]);
  const page = await openPage(browser, program.address, kSize, listen);
  try {
    await until("the tool can be taken", () => page.locator("#take").isEnabled());
    await until("a cloud", async () => (await heard(page)).points > 3000);
    assert.match(await page.locator("#sources").innerText(), /site/);
    await until("it is felt", async () => (await felt(page)).force > 0.2);
    await picture(page, "store");
    await truncate(join(site, "octree.bin"), 1000); // what is not there yet never comes
    await until("the tool is where nothing is loaded", async () => {
      await page.mouse.move(...kFar);
      await page.mouse.down();
      const isFree = async () => (await felt(page)).force === 0; // once it is let go, it goes back to what is loaded
      const isTold = await soon(async () => /not loaded/.test(await page.locator("#flags").innerText()) && (await isFree()), 3000);
      await page.mouse.up();
      return isTold;
    });
    await until("why", async () => /octree\.bin, byte \d+: the file ends here, inside node r/.test(await page.locator("#notices").innerText()));
    await picture(page, "store-not-loaded");
    assert.deepEqual(page.troubles, [], "the browser complains");
  } finally {
    await page.context().close();
    await program.stop();
    await rm(folder, { recursive: true, force: true });
  }
}
