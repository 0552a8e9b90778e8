// The page of a tab in a browser: PALPATE_SITE=.../build/web/site npm run tab

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ball } from "./ball.mjs";
import { connected, openBrowser, openPage, until } from "./browser.mjs";
import { felt, heard, listen } from "./heard.mjs";
import { picture } from "./picture.mjs";
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

const unit = (page, name) => page.getByLabel(`Unit of ${name}`).inputValue();

test("the unit of a file is asked for, and the file is read again in the one that is chosen", () =>
  withTab("?cloud=synthetic:torus", async (page, { asked }) => {
    const loaded = asked.length;
    await page.setInputFiles("#open-file", { name: "scan.xyz", mimeType: "text/plain", buffer: Buffer.from(ball(250)) });
    await shows(page, "scan");
    await page.locator("#panels").click(); // the simple page
    await page.locator("#ask").getByText(/^scan: 500 x 500 x 500 mm\?/).waitFor();
    await picture(page, "tab-unit");
    await page.locator("#ask").getByText("mm", { exact: true }).click();
    await until("millimetres", async () => (await unit(page, "scan")) === "mm");
    await connected(page);
    assert.ok(await page.locator("#ask").isHidden(), "it is said");
    await touch(page);
    assert.equal(asked.length, loaded);
  }));

test("a link holds the unit of its file", () =>
  withTab("?at=clouds/scan.xyz#unit.scan=mm&stiffness=200", async (page) => {
    await until("millimetres", async () => (await unit(page, "scan")) === "mm");
    await connected(page);
    await until("its stiffness", async () => Math.abs((await page.getByRole("spinbutton", { name: "Stiffness" }).inputValue()) - 200) < 1);
    await touch(page);
  }, { "clouds/scan.xyz": ball(250) }));

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

// A hand that dips 2 mm into a floor for 1.5 s, as palpate recorded it: 1 N at most, at 0.75 s.
const dip = await readFile(new URL("../../../tests/tab/module/dip.mcap", import.meta.url));

/** Lets go of a file over the page. */
function drop(page, name, bytes) {
  return page.evaluate(([called, data]) => {
    const files = new DataTransfer();
    files.items.add(new File([Uint8Array.from(window.atob(data), (sign) => sign.charCodeAt(0))], called));
    document.dispatchEvent(new window.DragEvent("drop", { dataTransfer: files, bubbles: true, cancelable: true }));
  }, [name, bytes.toString("base64")]);
}

const seek = (page, time) => page.locator("#time").evaluate((slider, value) => {
  slider.value = String(value);
  slider.dispatchEvent(new Event("input", { bubbles: true }));
}, time);
const feels = (page, force) => until(`${force} N`, async () => Math.abs((await felt(page)).force - force) < 1e-3);

test("a dropped recording is replayed with its forces and time line; one that is none is refused in words", () =>
  withTab("?cloud=synthetic:torus", async (page, { asked }) => {
    const loaded = asked.length;
    for (const [name, bytes, words] of [["empty.mcap", dip.subarray(0, 0), "empty.mcap: is no MCAP file"],
      ["head.mcap", dip.subarray(0, 3000), "head.mcap: no recording of a run"]]) {
      await drop(page, name, bytes);
      await warned(page, words);
    }
    assert.equal(await scene(page), "torus");
    await touch(page);
    await drop(page, "dip.mcap", dip);
    await shows(page, "dip.mcap");
    await connected(page);
    await until("the time line", () => page.locator("#time-line").isVisible());
    await until("a cloud", async () => (await heard(page)).points === 400);
    for (const [time, force] of [[0.75, 1], [0.3, 0.3815], [0.6, 0.9265], [0, 0]]) {
      await seek(page, time);
      await feels(page, force);
    }
    await seek(page, 0.75);
    await until("forces are drawn", () => page.evaluate(() => {
      const canvas = document.getElementById("time-forces");
      const { data } = canvas.getContext("2d").getImageData(0, 4, canvas.width, canvas.height - 8);
      return data.some((value) => value > 0);
    }));
    await picture(page, "tab-replay");
    assert.ok(await page.locator("#take").isHidden() && (await page.locator("#record").isHidden()));
    await page.selectOption("#time-speed", "2");
    await page.click("#play");
    await feels(page, 0);
    await until("it stops at the end", async () => (await page.locator("#time-words").innerText()) === "0:01.50 / 0:01.50");
    await until("a button to play again", async () => (await page.getAttribute("#play", "aria-label")) === "Play");
    await drop(page, "ball.xyz", Buffer.from(ball(0.05)));
    await shows(page, "ball");
    await connected(page);
    assert.ok(await page.locator("#time-line").isHidden(), "a cloud has none");
    await touch(page);
    assert.equal(asked.length, loaded);
  }));

test("a link names a recording", () =>
  withTab("?at=runs/dip.mcap", async (page) => {
    await shows(page, "dip.mcap");
    await seek(page, 0.75);
    await feels(page, 1);
    await page.locator("#panels").click(); // the simple page
    assert.ok(await page.locator("#time-line").isVisible());
    await page.locator("#examples").getByText("torus").click();
    await shows(page, "torus");
    await connected(page);
    await touch(page);
  }, { "runs/dip.mcap": dip }));

test("what a simulated camera sees is drawn as it comes, and touched", () =>
  withTab("", async (page) => {
    await page.getByLabel("Scene").selectOption("desk");
    await shows(page, "desk");
    await connected(page);
    const { clouds } = await heard(page);
    await until("frames", async () => (await heard(page)).clouds > clouds + 10);
    assert.ok((await touch(page)) < 20, "no more than the hand pulls");
    await picture(page, "tab-desk");
  }));

test("another page includes it as the documents show, and gives it a file, at once or later", async () => {
  const shown = /```html\n(.*?)```/s.exec(await readFile(new URL("../../../docs/try.md", import.meta.url), "utf8"))[1];
  const host = shown.replace("<title>", '<link rel="icon" href="data:,"><title>'); // else the browser asks for one
  const early = shown.replace("touched =", "touched = window.touched =").replace("</script>", 'touched.open(new File(["0 0 0\\n"], "point.xyz"));</script>');
  const server = await serveSite(join(process.env.PALPATE_SITE, ".."), { "host.html": host, "early.html": early });
  const page = await openPage(browser, `${server.address}host.html`, kView, listen);
  try {
    const framed = async () => (await page.waitForSelector("#here iframe")).contentFrame();
    const frame = await framed();
    await connected(frame);
    await shows(frame, "torus");
    assert.equal(await frame.getByRole("spinbutton", { name: "Stiffness" }).inputValue(), "300");
    await touch(page, frame);
    await page.setInputFiles("#scan", { name: "ball.xyz", mimeType: "text/plain", buffer: Buffer.from(ball(0.05)) });
    await shows(frame, "ball");
    await connected(frame);
    await touch(page, frame);
    assert.deepEqual(page.troubles, [], "the browser complains");
    await page.goto(`${server.address}early.html`);
    await shows(await framed(), "point");
    await page.evaluate(() => window.touched.close());
    assert.equal(await page.locator("iframe").count(), 0);
  } finally {
    await page.context().close();
    server.close();
  }
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
