// A length on the screen: 1, 2 or 5 times a power of ten.

const kLeast = 60; // pixels, and of a narrow view:
const kPart = 1 / 8;

export interface ScaleBar {
  pixels: number;
  label: string;
}

export function lengthInWords(metres: number): string {
  if (metres < 0.9995e-3) return `${trim(metres * 1e6)} µm`;
  if (metres < 0.9995) return `${trim(metres * 1e3)} mm`;
  return `${trim(metres)} m`;
}

/** For a view of this width, pixels. */
export function scaleBar(metresPerPixel: number, width: number): ScaleBar {
  const wanted = Math.min(kLeast, kPart * width) * metresPerPixel;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const factor = [1, 2, 5, 10].find((f) => f * power >= wanted * (1 - 1e-9)) ?? 10;
  const metres = factor * power;
  return { pixels: metres / metresPerPixel, label: lengthInWords(metres) };
}

function trim(value: number): string {
  return String(Number(value.toPrecision(3)));
}
