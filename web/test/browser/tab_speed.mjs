// How soon the page of a tab is touched, and whether it keeps its rate: PALPATE_SITE=.../build/web/site node test/browser/tab_speed.mjs [CLOUD]
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import { drags } from "./drags.mjs";
import { connected, openBrowser, openPage } from "./browser.mjs";
import { heard, listen } from "./heard.mjs";
import { serveSite, touch } from "./site.mjs";

const file = process.argv[2];
const clouds = file === undefined ? {} : { [basename(file)]: await readFile(file) };
const server = await serveSite(process.env.PALPATE_SITE, clouds);
const browser = await openBrowser();
const begin = performance.now();
const page = await openPage(browser, server.address + (file === undefined ? "" : `?at=${basename(file)}`), { viewport: { width: 900, height: 600 } }, listen, true);
const seconds = () => ((performance.now() - begin) / 1000).toFixed(2);

/** Steps a second over `time` s, as the states' own time tells it. */
async function rate(time, act) {
  const now = () => page.evaluate(() => [window.heard.time, window.performance.now() / 1000]);
  const [simulated, real] = await now();
  await Promise.all([new Promise((done) => setTimeout(done, 1000 * time)), act?.()]);
  const [simulatedThen, realThen] = await now();
  return ((1000 * (simulatedThen - simulated)) / (realThen - real)).toFixed(0);
}

await connected(page);
console.log(`connected after ${seconds()} s`);
await touch(page);
console.log(`touched after ${seconds()} s; its first cloud was drawn ${((await heard(page)).firstCloud / 1000).toFixed(2)} s after the page's start`);
const asked = server.asked.length;
console.log(`${await rate(5)} steps/s at rest`);
const seed = 5;
let found;
console.log(`${await rate(1, async () => (found = await drags(page, 6, seed)))} steps/s in six drags`);
for (const { touching, looks, most } of found) console.log(`  ${touching} of ${looks} looks in contact, at most ${most.toFixed(2)} N`);
if (process.env.PALPATE_PICTURES) await page.screenshot({ path: `${process.env.PALPATE_PICTURES}/tab.png` });
console.log(`${server.asked.length - asked} requests after the first touch; the browser complains of ${JSON.stringify(page.troubles)}`);
await browser.close();
server.close();
