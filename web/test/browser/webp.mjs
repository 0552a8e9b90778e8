// Screenshots become one moving picture, a WebP as browsers play it in place. A browser codes the frames, here they are
// put together: https://developers.google.com/speed/webp/docs/riff_container

const kQuality = 0.86; // of WebP: letters of 13 px have no halo (looked at)
const kBlock = 16; // pixels: WebP's own

/**
 * Runs in a page. Codes a screenshot (base64 of a PNG), but for the blocks in which nothing changed since the last one: they are transparent.
 * Resolves to a WebP in base64 and the size.
 */
export const codeFrame = async ([shot, quality, block]) => {
  const image = new window.Image();
  image.src = `data:image/png;base64,${shot}`;
  await image.decode();
  const { width, height } = image;
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  pen.drawImage(image, 0, 0);
  const pixels = new Uint32Array(pen.getImageData(0, 0, width, height).data.buffer);
  const { before } = window;
  window.before = pixels;
  const same = (left, top) => {
    for (let y = top; y < Math.min(top + block, height); y += 1) {
      for (let i = y * width + left; i < y * width + Math.min(left + block, width); i += 1) if (pixels[i] !== before[i]) return false;
    }
    return true;
  };
  for (let top = 0; before && top < height; top += block) {
    for (let left = 0; left < width; left += block) if (same(left, top)) pen.clearRect(left, top, block, block);
  }
  return { webp: canvas.toDataURL("image/webp", quality).split(",")[1], width, height };
};

/** Bytes of an unsigned number, the lowest first. */
const number = (value, bytes) => Array.from({ length: bytes }, (_, i) => (value >> (8 * i)) & 255);

function chunk(name, ...parts) {
  const body = Buffer.concat(parts.map((part) => Buffer.from(part)));
  return Buffer.concat([Buffer.from(name), Buffer.from(number(body.length, 4)), body, Buffer.alloc(body.length % 2)]);
}

/** A still's own chunks: its opacity and its picture. */
function pictureOf(webp) {
  const chunks = [];
  for (let at = 12; at < webp.length; ) {
    const end = at + 8 + webp.readUInt32LE(at + 4);
    if (/^(ALPH|VP8 |VP8L)$/.test(webp.toString("latin1", at, at + 4))) chunks.push(webp.subarray(at, end + (end % 2)));
    at = end + (end % 2);
  }
  return chunks;
}

/** Screenshots, each { shot: PNG in base64, milliseconds: how long it is seen }, as one WebP that plays for ever; `page`: any, to code them in. */
export async function movingPicture(page, shots) {
  await page.evaluate(() => delete window.before);
  const frames = [];
  let size;
  for (const { shot, milliseconds } of shots) {
    const { webp, width, height } = await page.evaluate(codeFrame, [shot, kQuality, kBlock]);
    size = [...number(width - 1, 3), ...number(height - 1, 3)];
    frames.push(chunk("ANMF", number(0, 6), size, number(milliseconds, 3), [0], ...pictureOf(Buffer.from(webp, "base64"))));
  }
  const kAnimatedWithOpacity = 0x12;
  return chunk("RIFF", Buffer.from("WEBP"), chunk("VP8X", number(kAnimatedWithOpacity, 4), size), chunk("ANIM", number(0, 6)), ...frames);
}
