// The page in a headless chromium against palpate itself: PALPATE_PROGRAM=.../palpate npm run program.

import assert from "node:assert/strict";
import { readdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { connected, openBrowser, openPage, until } from "./browser.mjs";
import { dragsTouch } from "./drags.mjs";
import { distance, felt, heard, listen } from "./heard.mjs";
import { opens } from "./opening.mjs";
import { picture } from "./picture.mjs";
import { changed } from "./pixels.mjs";
import { kTable, kTwoHands, run, startProgram } from "./real_program.mjs";
import { relayTo } from "./relay.mjs";
import { scrub } from "./scrub.mjs";
import { feelsStore } from "./store.mjs";
import { hold, lift, press, pressUntil, staysOnTable, touchDown } from "./touching.mjs";

const kStiffness = 500; // N/m, of kTable
const kSmall = { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" };
const kPhone = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true, reducedMotion: "reduce" };
let browser, table;
before(async () => {
  browser = await openBrowser();
  table = await startProgram(kTable);
});
after(() => Promise.all([browser?.close(), table?.stop()]));

const text = (page, selector) => page.locator(selector).innerText();

async function open(address, options = kSmall, where = browser) {
  const page = await openPage(where, address, options, listen);
  await connected(page);
  await until("the tool can be taken", () => page.locator("#take").isEnabled());
  return page;
}

async function onTable(act, options) {
  const page = await open(table.address, options);
  try {
    await act(page);
    assert.deepEqual(page.troubles, [], "the browser complains");
  } finally {
    await page.context().close();
  }
}

test("the page comes from the program, connects and draws its cloud", () =>
  onTable(async (page) => {
    await until("says how it goes", async () => /steps\/s/.test(await text(page, "#link-words")));
    assert.equal(await text(page, "#scene"), "table");
    await until("sources", async () => /table[\s\S]*still/.test(await text(page, "#sources")));
    await until("a cloud", async () => (await heard(page)).clouds > 0);
    const { points } = await heard(page);
    assert.ok(points > 5000 && points <= 10_000, `${points} points for a page that draws 10 000`);
    await page.click("#pause"); // little but the cloud is to change
    await until("paused", async () => (await felt(page)).paused);
    const canvas = () => page.locator("#view").screenshot({ timeout: 120_000 });
    const shownPoints = page.getByRole("switch", { name: "Points" });
    let part = 0;
    await until("the cloud to be seen", async () => {
      const shown = await canvas();
      await shownPoints.click();
      part = await changed(page, shown, await canvas());
      await shownPoints.click();
      return part > 0.05;
    });
    assert.ok(part < 0.95, `the cloud fills ${part} of the view`);
    await page.click("#pause");
    await until("no more", async () => !(await felt(page)).paused);
  }));

test("held by keys, the hand goes into the table, the proxy stays on it and the force grows", () =>
  onTable(async (page) => {
    const first = await press(page, 1);
    const then = await felt(page);
    staysOnTable(first, then);
    await until("words", async () => /touching/.test(await text(page, "#touch")) && Number(await text(page, "#force")) > 1);
    await picture(page, "touching");
  }));

test("a drag moves the program's hand", () =>
  onTable(async (page) => {
    await page.keyboard.press("t");
    await until("taken", async () => (await felt(page)).taken);
    const begin = (await felt(page)).hip;
    await page.mouse.move(300, 250);
    await page.mouse.down();
    await page.mouse.move(360, 200, { steps: 6 });
    await page.mouse.up();
    await until("moved", async () => distance((await felt(page)).hip, begin) > 0.02);
    await page.keyboard.press("Escape");
    await until("let go", async () => !(await felt(page)).taken);
  }));

test("drags over a scan touch it, wherever they begin", (context) => dragsTouch(context, browser));
test("a cloud that is dropped on the page is touched next", () => opens(browser));
test("of a store on disk all is seen and what is around the tool is felt", () => feelsStore(browser));

test("a changed stiffness is felt at the next touch, and a pause takes the force away", () =>
  onTable(async (page) => {
    const near = (stiffness) => async () => Math.abs((await felt(page)).stiffness / stiffness - 1) < 0.1;
    await touchDown(page);
    await pressUntil(page, "as stiff as it began", near(kStiffness));
    await page.getByRole("spinbutton", { name: "Stiffness" }).fill(String(1.5 * kStiffness));
    await page.keyboard.press("Enter");
    await page.focus("#view");
    await lift(page); // a hand that rests in contact is given no energy, so nothing gets stiffer there
    await pressUntil(page, "half as stiff again", near(1.5 * kStiffness));
    await page.getByRole("button", { name: "default" }).click();
    await page.focus("#view");
    await pressUntil(page, "as before", near(kStiffness));
    const { force } = await felt(page);
    await page.click("#pause");
    await until("paused", async () => (await felt(page)).paused && (await felt(page)).force === 0);
    await page.click("#pause");
    await page.focus("#view");
    await lift(page); // in contact a force comes back only as far as the hand has paid for it
    await hold(page, "ArrowDown", "felt again", async () => (await felt(page)).force > 0.3 * force);
  }));

test("plots move, and stand still when they are held", () =>
  onTable(async (page) => {
    const drawn = () => page.evaluate(() => document.querySelector("#strip canvas").toDataURL());
    const first = await drawn();
    await until("drawn anew", async () => (await drawn()) !== first);
    await page.click("#freeze");
    const held = await drawn();
    const { states } = await heard(page);
    await until("a second of states", async () => (await heard(page)).states > states + 60);
    assert.equal(await drawn(), held);
    await page.click("#freeze");
    await until("moving again", async () => (await drawn()) !== held);
  }));

test("a recording is written while it is asked for, can be read, and is shown again", async (context) => {
  const { folder } = table;
  await onTable(async (page) => {
    await page.click("#record");
    await until("recording", async () => (await page.getAttribute("#record", "aria-pressed")) === "true");
    const { states } = await heard(page);
    await until("five seconds", async () => (await heard(page)).states > states + 300);
    await page.click("#record");
    await until("at its end", async () => (await page.getAttribute("#record", "aria-pressed")) === "false");
  });
  const files = (await readdir(folder)).filter((name) => /^palpate-\d{8}-\d{6}\.mcap$/.test(name));
  assert.equal(files.length, 1);
  const file = join(folder, files[0]);
  const said = async () => (await run(["bag", "info", file, "--json", "-"])).out;
  await until("closed", async () => JSON.parse(await said()).closed);
  const ticks = JSON.parse(await said()).topics.find(({ topic }) => topic === "/palpate/hand/tick");
  assert.ok(ticks.messages > 2000, `${ticks.messages} steps`);
  const replay = await run(["replay", file]);
  assert.match(replay.out, /recorded from step .* of its run on: it can be viewed/);
  const shown = await startProgram(["replay", file, "--view", "--headless", "--port", "0"]);
  context.after(() => shown.stop());
  await scrub(await openPage(browser, shown.address, kSmall, listen), file);
});

test("a run that is recorded from its beginning shows so; the button ends that file and begins another", async (context) => {
  const program = await startProgram([...kTable, "--record", "run.mcap"]);
  context.after(() => program.stop());
  const page = await open(program.address);
  const pressed = (wanted) => until(`recording: ${wanted}`, async () =>
    (await page.getAttribute("#record", "aria-pressed")) === String(wanted));
  await pressed(true);
  await page.click("#record");
  await pressed(false);
  await until("told", async () => /recorded run\.mcap/.test(await text(page, "#notices")));
  await page.click("#record");
  await pressed(true);
  const files = (await readdir(program.folder)).filter((name) => name.endsWith(".mcap")).sort();
  assert.equal(files.length, 2);
  assert.match(files[0], /^palpate-/);
  const first = await run(["replay", join(program.folder, "run.mcap"), "--json", "-"]);
  assert.ok(JSON.parse(first.out).exact, "done again bit for bit");
  await page.context().close();
});

test("two pages see the same; one holds the tool, and it is free when that one is gone", () =>
  onTable(async (first) => {
    const second = await open(table.address);
    await touchDown(first);
    await until("the other sees who holds it", async () => (await felt(second)).taken);
    await until("at one place", async () => distance((await felt(first)).hip, (await felt(second)).hip) < 1e-4);
    await second.getByRole("spinbutton", { name: "Friction" }).fill("0.4");
    await second.keyboard.press("Enter");
    await until("the other is told", async () => (await first.getByRole("spinbutton", { name: "Friction" }).inputValue()) === "0.4");
    await first.getByRole("button", { name: "default" }).click();
    await second.focus("#view");
    await second.keyboard.press("t");
    await until("who held it is told", async () => /another page took the tool/.test(await text(first, "#notices")));
    assert.equal(await first.getAttribute("#take", "aria-pressed"), "false");
    assert.ok((await felt(first)).taken, "it is the other's now");
    await first.focus("#view");
    await first.keyboard.press("t");
    await until("taken back", async () => (await second.getAttribute("#take", "aria-pressed")) === "false");
    await first.reload();
    await until("free again", async () => !(await felt(second)).taken);
    const { states } = await heard(second);
    await until("the other goes on", async () => (await heard(second)).states > states + 30);
    assert.deepEqual(second.troubles, []);
    await second.context().close();
  }));

test("two pages hold two hands of one scene at once, and each sees the other's", async (context) => {
  const program = await startProgram(kTwoHands);
  const small = { ...kSmall, viewport: { width: 720, height: 480 } };
  const other = await openBrowser();
  context.after(() => Promise.all([other.close(), program.stop()]));
  const pages = [await open(program.address, small), await open(program.address, small, other)];
  assert.deepEqual(await pages[1].locator("#device option").allInnerTexts(), ["simulated 1", "simulated 2"]);
  await pages[1].selectOption("#device", { label: "simulated 2" });
  const first = await Promise.all(pages.map(async (page, device) => {
    // A hand that explores comes to the edges, too.
    await until("in the middle", async () => {
      const { hip } = await felt(page, device);
      return hip !== undefined && Math.hypot(hip[0], hip[1]) < 0.1;
    });
    return press(page, 1, device);
  }));
  for (const device of [0, 1]) {
    staysOnTable(first[device], await felt(pages[device], device));
    await until("the other page sees it in contact, at one place and with one force", async () => {
      const own = await felt(pages[device], device);
      const seen = await felt(pages[1 - device], device);
      return seen.taken && seen.touching && Math.abs(seen.force - own.force) < 0.1 && distance(seen.hip, own.hip) < 1e-4;
    });
  }
  await picture(pages[0], "two-hands");
  await other.close();
  await until("its hand is free", async () => !(await felt(pages[0], 1)).taken);
  assert.ok((await felt(pages[0], 0)).taken, "and the other is still held");
  await pages[0].context().close();
});

/** A page that holds the tool over a relay, and one that watches. */
async function heldOverRelay(act) {
  const relay = await relayTo(table.address);
  const page = await open(relay.address);
  const watcher = await open(table.address);
  await touchDown(page);
  await until("held", async () => (await felt(watcher)).taken);
  await act(relay, page, watcher);
  await Promise.all([page.context().close(), watcher.context().close()]);
  await relay.close();
}

test("a cut connection comes back by itself, and the tool is let go meanwhile", () =>
  heldOverRelay(async (relay, page, watcher) => {
    relay.cut();
    await until("says so", async () => /Connection lost[\s\S]*tool is released[\s\S]*reconnects/.test(await text(page, "#cover")));
    await until("let go", async () => !(await felt(watcher)).taken);
    relay.mend();
    await connected(page);
    assert.ok(await page.locator("#cover").isHidden());
    const { states } = await heard(page);
    await until("states come", async () => (await heard(page)).states > states);
  }));

test("the tool is let go when nothing is heard of its page any more", () =>
  heldOverRelay(async (relay, page, watcher) => {
    relay.freeze();
    await until("let go", async () => !(await felt(watcher)).taken);
    await until("the page knows", async () => /Connection lost/.test(await text(page, "#cover")));
  }));

test("live cameras are shown; a program that ends and one that follows are told apart", async () => {
  const desk = (port) => startProgram(["demo", "desk", "--headless", "--port", String(port)]);
  const one = await desk(0);
  const page = await open(one.address, { viewport: { width: 1440, height: 900 } });
  await until("a camera runs", async () => /desk[\s\S]*running/.test(await text(page, "#sources")));
  const { clouds } = await heard(page);
  await until("its clouds follow one another", async () => (await heard(page)).clouds > clouds + 2);
  await picture(page, "desktop");
  assert.equal(await one.stop(), 0);
  await until("says so", async () => /Connection lost/.test(await text(page, "#cover")));
  const two = await desk(one.port);
  await until("tells what to do", async () =>
    /rejected this page[\s\S]*open the address that it printed last/.test(await text(page, "#cover")));
  await page.fill("#cover-token", two.address);
  await page.keyboard.press("Enter");
  await connected(page);
  await page.context().close();
  assert.equal(await two.stop(), 0);
});

test("on a phone everything is in reach, and a touch of the button takes the tool", () =>
  onTable(async (page) => {
    await page.tap("#take");
    await until("taken", async () => (await felt(page)).taken);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 390), "nothing is wider than the screen");
    for (const name of ["timing", "settings", "sources", "force"]) {
      await page.tap(`.tabs [data-tab="${name}"]`);
      assert.equal(await page.getAttribute(`.tabs [data-tab="${name}"]`, "aria-current"), "true");
    }
    await picture(page, "phone");
  }, kPhone));
