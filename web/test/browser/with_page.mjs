// The page against the made-up program, for tests in a browser.

import assert from "node:assert/strict";
import { after, before } from "node:test";
import { serve } from "../fake_server.mjs";
import { openBrowser, openPage, until } from "./browser.mjs";

export const kSmall = { viewport: { width: 900, height: 600 }, reducedMotion: "reduce" };
export const kPhone = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };
export let browser;

const kGrace = 3000; // ms

before(async () => (browser = await openBrowser()));
after(async () => {
  await browser.close();
  setTimeout(() => process.exit(), kGrace).unref(); // a test that failed may have left its server
});

export const text = (page, selector) => page.locator(selector).innerText();
export const ready = (page) => until("the tool can be taken", () => page.locator("#take").isEnabled());

/** Unless it is a `first` visit, all panels are shown. */
export const withPage = (options, act, points = 4000, first = false) => withProgram({ points }, options, act, first);

/** The same of another made-up program. */
export async function withProgram(program, options, act, first = false) {
  const server = await serve(program);
  const page = await openPage(browser, server.address, options, undefined, first);
  try {
    await ready(page);
    await act(page, server.program, server);
    assert.deepEqual(page.troubles, [], "the browser complains");
  } finally {
    await page.context().close();
    await server.close();
  }
}

export const hands = (program) => program.received.filter(({ type }) => type === "hand");
export const sent = (program, type) => program.received.filter((message) => message.type === type);
