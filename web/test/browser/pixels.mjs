// Pictures read and compared by the browser, which can.

/** Red, green, blue and opacity of each pixel of pictures (PNG), of an area of them: x, y (negative: from below), width, height. */
const pixels = async ([pictures, area]) => Promise.all(pictures.map(async (picture) => {
  const image = new window.Image();
  image.src = `data:image/png;base64,${picture}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const [x, y, width, height] = area ?? [0, 0, image.width, image.height];
  return [...context.getImageData(x, y < 0 ? image.height + y : y, width, height).data];
}));

const coded = (pictures) => pictures.map((picture) => picture.toString("base64"));

/** Which part of the pixels of two pictures differs clearly, 0 to 1. */
export async function changed(page, one, other) {
  const [first, second] = await page.evaluate(pixels, [coded([one, other])]);
  let count = 0;
  for (let i = 0; i < first.length; i += 4) {
    const off = [0, 1, 2].map((c) => Math.abs(first[i + c] - second[i + c]));
    if (Math.max(...off) > 24) count += 1;
  }
  return (4 * count) / first.length;
}

/** How many pixels of an area are darker in one picture than in another, in the same colour. */
export async function shaded(page, one, other, area) {
  const [first, second] = await page.evaluate(pixels, [coded([one, other]), area]);
  let count = 0;
  for (let i = 0; i < first.length; i += 4) {
    const shares = [0, 1, 2].map((c) => first[i + c] / second[i + c]);
    if (Math.max(...shares) < 0.88 && Math.max(...shares) - Math.min(...shares) < 0.05) count += 1;
  }
  return count;
}

/** Which part of an area's pixels is dark. */
export async function dark(page, picture, area) {
  const [data] = await page.evaluate(pixels, [coded([picture]), area]);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (Math.max(data[i], data[i + 1], data[i + 2]) < 96) count += 1;
  return (4 * count) / data.length;
}
