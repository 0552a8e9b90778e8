// Time of a picture with many points: node test/browser/speed.mjs [POINTS...]. What draws is said first:
// without a graphics card it is software on the processor.

import { serve } from "../fake_server.mjs";
import { openBrowser, openPage } from "./browser.mjs";

const kSeconds = 8;
const counts = process.argv.slice(2).map(Number);
const browser = await openBrowser();
for (const points of counts.length > 0 ? counts : [300_000]) {
  const server = await serve({ points });
  const page = await openPage(browser, "about:blank", { viewport: { width: 1440, height: 900 } });
  await page.addInitScript((most) => {
    if (location.protocol === "http:") localStorage.setItem("palpate.points", String(most));
  }, points);
  await page.goto(server.address, { waitUntil: "domcontentloaded", timeout: 120_000 });
  await page.waitForFunction(() => !document.getElementById("take").disabled, null, { timeout: 120_000 });
  await page.waitForTimeout(6000);
  const cdp = await page.context().newCDPSession(page);
  await cdp.send("Performance.enable");
  const metrics = async () =>
    (await cdp.send("Performance.getMetrics")).metrics.find(({ name }) => name === "TaskDuration").value;
  const scriptBefore = await metrics();
  const [renderer, times] = await page.evaluate(async (seconds) => {
    const gl = document.createElement("canvas").getContext("webgl2");
    const name = gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info").UNMASKED_RENDERER_WEBGL);
    const intervals = [];
    const begin = performance.now();
    let last = begin;
    while (performance.now() - begin < 1000 * seconds) {
      const now = await new Promise(requestAnimationFrame);
      intervals.push(now - last);
      last = now;
    }
    return [name, intervals.slice(1).sort((a, b) => a - b)];
  }, kSeconds);
  const at = (q) => times[Math.floor(q * (times.length - 1))]?.toFixed(1);
  const script = (await metrics()) - scriptBefore;
  console.log(`${points} points on ${renderer}: ${times.length} pictures, median ${at(0.5)} ms, 90 % ${at(0.9)} ms; ` +
    `page's own work ${((1000 * script) / times.length).toFixed(1)} ms a picture, ${((100 * script) / kSeconds).toFixed(0)} % of the time`);
  await page.context().close();
  await server.close();
}
await browser.close();
