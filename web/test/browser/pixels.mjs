// Pictures compared by the browser, which can read them.

/** Which part of the pixels of two pictures (PNG) differs clearly, 0 to 1. */
export function changed(page, one, other) {
  return page.evaluate(async (pictures) => {
    const [first, second] = await Promise.all(pictures.map(async (picture) => {
      const image = new window.Image();
      image.src = `data:image/png;base64,${picture}`;
      await image.decode();
      const canvas = document.createElement("canvas");
      canvas.width = image.width;
      canvas.height = image.height;
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    }));
    let count = 0;
    for (let i = 0; i < first.length; i += 4) {
      const off = [0, 1, 2].map((c) => Math.abs(first[i + c] - second[i + c]));
      if (Math.max(...off) > 24) count += 1;
    }
    return (4 * count) / first.length;
  }, [one, other].map((picture) => picture.toString("base64")));
}
