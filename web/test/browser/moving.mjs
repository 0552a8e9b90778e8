// A moving picture made of screenshots. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "../fake_server.mjs";
import { openPage } from "./browser.mjs";
import { movingPicture } from "./webp.mjs";
import { browser, kSmall } from "./with_page.mjs";

/** What a browser makes of a moving picture: its frames' ms, and of each the colours at two places. */
const played = async ([webp, places]) => {
  const bytes = Uint8Array.from(window.atob(webp), (letter) => letter.charCodeAt(0));
  const decoder = new window.ImageDecoder({ data: bytes, type: "image/webp" });
  await decoder.tracks.ready;
  const frames = [];
  for (let frameIndex = 0; frameIndex < decoder.tracks.selectedTrack.frameCount; frameIndex += 1) {
    const { image } = await decoder.decode({ frameIndex });
    const { displayWidth: width, displayHeight: height } = image;
    const pen = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
    pen.drawImage(image, 0, 0);
    frames.push({ width, height, ms: image.duration / 1000, colours: places.map(([x, y]) => [...pen.getImageData(x, y, 1, 1).data]) });
  }
  return { frames, repeats: decoder.tracks.selectedTrack.repetitionCount };
};

test("screenshots become a moving picture that a browser plays, each frame with what changed", async () => {
  const server = await serve({ points: 10 });
  const page = await openPage(browser, new URL("app.css", server.address).href, kSmall); // of an origin that may decode, without a script
  try {
    const shots = [];
    for (const colour of ["rgb(0, 0, 0)", "rgb(250, 250, 250)"]) {
      await page.evaluate((colour) => {
        document.body.style.background = colour;
        const still = document.createElement("p");
        still.style.cssText = "position: fixed; left: 0; top: 0; margin: 0; width: 160px; height: 160px; background: rgb(200, 0, 0)";
        document.body.replaceChildren(still);
      }, colour);
      shots.push({ shot: (await page.screenshot()).toString("base64"), milliseconds: 70 + shots.length });
    }
    const picture = await movingPicture(page, shots);
    const { frames, repeats } = await page.evaluate(played, [picture.toString("base64"), [[80, 80], [600, 400]]]);
    assert.equal(repeats, Infinity);
    assert.deepEqual(frames.map(({ width, height, ms }) => [width, height, ms]), [[900, 600, 70], [900, 600, 71]]);
    const near = (colour, wanted) => wanted.every((value, i) => Math.abs(colour[i] - value) < 8);
    for (const [i, background] of [0, 250].entries()) {
      const [red, rest] = frames[i].colours;
      assert.ok(near(red, [200, 0, 0, 255]), `what stays is ${red}`);
      assert.ok(near(rest, [background, background, background, 255]), `what changes is ${rest}`);
    }
  } finally {
    await page.context().close();
    await server.close();
  }
});
