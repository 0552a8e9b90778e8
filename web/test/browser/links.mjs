// Links that hold settings and a view. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { connected, openPage, until } from "./browser.mjs";
import { heard, listen } from "./heard.mjs";
import { browser, kSmall, ready, text } from "./with_page.mjs";

test("a link brings its settings, says what it cannot, and a link gives them back", async () => {
  const server = await serve({ points: 1000 });
  const page = await openPage(browser, `${server.address}&stiffness=900&grain=true&weather=fine`, kSmall);
  await ready(page);
  const value = (key) => server.program.settings.find((one) => one.key === key).value;
  await until("set", () => value("stiffness") === 900 && value("grain") === true);
  await until("says so", async () => /weather = fine/.test(await text(page, "#notices")));
  assert.equal(await page.evaluate(() => location.href), server.address, "not again when it is loaded again");
  await page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: undefined }));
  await page.click("#share");
  const link = await page.inputValue("#share-link");
  assert.ok(link.startsWith(`${server.address}&stiffness=900`) && link.includes("grain=true"));
  assert.match(link, /&view=([^,&]+,){8}[^,&]+$/);
  await page.context().close();
  await server.close();
});

test("a link brings its view, which holds while clouds come, until the scene is framed anew", async () => {
  const server = await serve({ points: 1000 });
  const asked = "view=0.4,-0.9,0.5,0.1,0.05,0.02,0,1,0";
  const page = await openPage(browser, `${server.address}&${asked}`, kSmall, listen);
  await ready(page);
  await page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: { writeText: async (link) => void (window.copied = link) } }));
  const view = async () => {
    await page.click("#share");
    return (await page.evaluate(() => window.copied)).replace(/.*&/, "");
  };
  assert.equal(await view(), asked);
  await until("clouds", async () => (await heard(page)).clouds > 4);
  await until("cameras", () => page.locator("#sources").innerText().then((words) => words.includes("running")));
  assert.equal(await view(), asked);
  await server.close();
  await until("lost", async () => /Connection lost/.test(await page.locator("#cover").innerText()));
  const again = await serve({ points: 1000, port: server.port, token: server.token });
  await connected(page);
  const { clouds } = await heard(page);
  await until("clouds again", async () => (await heard(page)).clouds > clouds + 4);
  assert.equal(await view(), asked, "also of a connection that comes back");
  await page.focus("#view");
  await page.keyboard.press("f");
  await until("the scene is framed", async () => (await view()) !== asked);
  assert.match(await view(), /,0,1,0$/, "up stays");
  await page.context().close();
  await again.close();
});
