// The page of a tab in a browser: PALPATE_SITE=.../build/web/site npm run tab

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { ball } from "./ball.mjs";
import { connected, openBrowser, openPage, until } from "./browser.mjs";
import { heard, listen } from "./heard.mjs";
import { kHome, serveSite, touch } from "./site.mjs";

const kView = { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" };
const scene = (page) => page.locator("#scene").innerText();
const shows = (page, name) => until(`the scene ${name}`, async () => (await scene(page)) === name);
const warned = (page, words) => until(words, async () => (await page.locator("#notices .warning").allTextContents()).join().includes(words));

let browser;
before(async () => (browser = await openBrowser()));
after(() => browser.close());

async function withTab(where, act, clouds) {
  const server = await serveSite(process.env.PALPATE_SITE, clouds);
  const page = await openPage(browser, server.address + where, kView, listen);
  try {
    await connected(page);
    await act(page, server);
    assert.deepEqual(page.troubles, [], "the browser complains");
  } finally {
    await page.context().close();
    server.close();
  }
}

test("the page computes by itself: a cloud is seen and touched, and nothing is asked for after loading", () =>
  withTab("", async (page, { asked }) => {
    await until("a cloud has come", async () => (await heard(page)).points > 2000);
    const loaded = [...asked];
    assert.deepEqual(loaded.map((path) => path.slice(kHome.length)).sort(), ["", "app.css", "app.js", "tab.js", "tab.wasm", "worker.js"]);
    assert.equal(await scene(page), "rabbit");
    assert.ok((await touch(page)) < 20, "no more than the hand pulls");
    assert.ok(await page.locator("#record").isHidden(), "a tab writes no files");
    assert.equal(await page.evaluate(() => window.crossOriginIsolated), false);
    await page.getByLabel("Scene").selectOption("torus");
    await shows(page, "torus");
    await connected(page);
    await touch(page);
    assert.deepEqual(asked, loaded);
  }));

test("a dropped file is touched, one that is no cloud is refused in words, and the page goes on", () =>
  withTab("?cloud=synthetic:torus", async (page, { asked }) => {
    const loaded = asked.length;
    const give = (name, words) => page.setInputFiles("#open-file", { name, mimeType: "text/plain", buffer: Buffer.from(words) });
    await give("notes.txt", "this is no cloud");
    await warned(page, "notes.txt, line 1");
    await give("cut.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nend_header\n");
    await warned(page, "cut.ply");
    assert.equal(await scene(page), "torus");
    await touch(page);
    await give("Größe 点 (1).xyz", ball(0.05));
    await shows(page, "Größe 点 (1)");
    await connected(page);
    await touch(page);
    assert.equal(asked.length, loaded);
  }));

test("a link names a cloud below the site's folder, and settings", () =>
  withTab("?at=clouds/my%20ball.xyz#stiffness=200", async (page) => {
    assert.equal(await scene(page), "my ball");
    await until("its stiffness", async () => Math.abs((await page.getByRole("spinbutton", { name: "Stiffness" }).inputValue()) - 200) < 1);
    await touch(page);
    await page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: { writeText: async (text) => void (window.copied = text) } }));
    await page.locator("#share").click();
    await until("a link", () => page.evaluate(() => window.copied?.includes("stiffness=200")));
    assert.doesNotMatch(await page.evaluate(() => window.copied.split("#")[1]), /^tab|^&/, "no token");
  }, { "clouds/my ball.xyz": ball(0.05) }));

test("a link to elsewhere, or to nothing that can be read, says so and begins with the rabbit", async () => {
  await withTab("?at=../secret.ply", async (page, { asked }) => {
    await warned(page, "../secret.ply is not below this page's folder");
    assert.equal(await scene(page), "rabbit");
    assert.ok(!asked.join().includes("secret"));
  });
  await withTab("?cloud=synthetic:unicorn", (page) => warned(page, "torus"));
  await withTab("?at=clouds/cut.xyz", (page) => warned(page, "cut.xyz"), { "clouds/cut.xyz": "1 2 3\n4 5\n" });
});

test("a worker that dies says why, and starts again", () =>
  withTab("", async (page) => {
    await page.evaluate(() => window.end.dispatchEvent(new ErrorEvent("error", { message: "it was made to fail" })));
    await page.locator("#cover").waitFor();
    assert.match(await page.locator("#cover").innerText(), /it was made to fail/);
    await page.locator("#cover-again").click();
    await connected(page);
    await touch(page);
  }));
