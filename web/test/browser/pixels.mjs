// Pictures read and compared by the browser, which can. Where a test can do without words and panels it looks at the
// view's canvas alone, in small: that takes no screenshot, which a processor that draws needs long for.

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

/** The view in small, 220 by 140 cells of red, green, blue and opacity, of a picture that is drawn after this is asked for. */
const view = () => new Promise((done) => {
  const small = document.createElement("canvas");
  Object.assign(small, { width: 220, height: 140 });
  const context = small.getContext("2d", { willReadFrequently: true });
  const look = () => {
    context.drawImage(document.getElementById("view"), 0, 0, small.width, small.height);
    const { data } = context.getImageData(0, 0, small.width, small.height);
    // The canvas keeps its picture until it is shown: it is black where nothing was drawn since.
    if (data.some((value, i) => i % 4 < 3 && value > 0)) done(data);
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
});

/** It stays in the page. */
export const viewOf = (page) => page.evaluateHandle(view);

/** Which part of the view is clearly of another colour than its upper left corner, 0 to 1. */
export async function filled(page) {
  return (await viewOf(page)).evaluate((data) => {
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (Math.max(...[0, 1, 2].map((c) => Math.abs(data[i + c] - data[c]))) > 24) count += 1;
    }
    return (4 * count) / data.length;
  });
}

/** Which part of the view is of a strong colour: more than a third of what a channel can hold from grey. */
export async function vivid(page) {
  return (await viewOf(page)).evaluate((data) => {
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [least, most] = [Math.min, Math.max].map((of) => of(data[i], data[i + 1], data[i + 2]));
      if (most - least > 85) count += 1;
    }
    return (4 * count) / data.length;
  });
}

/** How many cells of one view are in shadow that are not in another: darker, but not black, and of the same colour. */
export function shaded(page, one, other) {
  return page.evaluate(([first, second]) => {
    let count = 0;
    for (let i = 0; i < first.length; i += 4) {
      const shares = [0, 1, 2].map((c) => first[i + c] / second[i + c]);
      const [least, most] = [Math.min(...shares), Math.max(...shares)];
      if (most < 0.88 && least > 0.4 && most - least < 0.05) count += 1;
    }
    return count;
  }, [one, other]);
}

/** Which part of an area's pixels is dark. */
export async function dark(page, picture, area) {
  const [data] = await page.evaluate(pixels, [coded([picture]), area]);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (Math.max(data[i], data[i + 1], data[i + 2]) < 96) count += 1;
  return (4 * count) / data.length;
}
