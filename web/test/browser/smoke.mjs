// The shortest proof that the page works: palpate serves it, its cloud is seen, and a press of the mouse is felt.
// PALPATE_PROGRAM=.../palpate npm run smoke

import assert from "node:assert/strict";
import { test } from "node:test";
import { connected, openBrowser, openPage, until } from "./browser.mjs";
import { felt, heard, listen } from "./heard.mjs";
import { filled } from "./pixels.mjs";
import { kTable, startProgram } from "./real_program.mjs";
import { pointAt } from "./touching.mjs";

const kLeastFilled = 0.1; // of the view: a tool alone fills less

test("the program's page shows its cloud, and a press of the mouse on it is felt as a force", async () => {
  const [browser, program] = await Promise.all([openBrowser(), startProgram(kTable)]);
  try {
    const page = await openPage(browser, program.address, { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" }, listen, true);
    await connected(page);
    await until("a cloud has come", async () => (await heard(page)).points > 5000);
    await until("the cloud is seen", async () => (await filled(page)) > kLeastFilled);
    const { width, height } = await page.locator("#view").boundingBox();
    await pointAt(page, width / 2, height / 2);
    await page.mouse.down();
    await until("the mouse presses the table", async () => {
      const { taken, touching, force } = await felt(page);
      return taken && touching && force > 0;
    });
    await until("a force is shown", async () => Number(await page.locator("#force").innerText()) > 0);
    await page.mouse.up();
    assert.deepEqual(page.troubles, [], "the browser complains");
  } finally {
    await browser.close();
    assert.equal(await program.stop(), 0, "the program ends well");
  }
});
