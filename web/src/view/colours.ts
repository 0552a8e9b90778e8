// Colours of the view come from the style sheet, so that light and dark are decided in one file.

import { Color, DataTexture, LinearFilter, RGBAFormat, SRGBColorSpace } from "three";

export const kSourceColours = 8;
const kHandColours = 4;

function style(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function colourOf(name: string): Color {
  return new Color(style(name) || "#888888");
}

/** As the style sheet writes it: for plots. */
export function cssColour(name: string): string {
  return style(name) || "#888888";
}

export function sourceColour(source: number): string {
  return `--source-${source % kSourceColours}`;
}

export function handColour(device: number): string {
  return `--hand-${device % kHandColours}`;
}

/** Red, green, blue as a screen takes them, 0 to 1: for shaders that compute in these. */
export function screenColour(name: string): [number, number, number] {
  const { r, g, b } = colourOf(name).getRGB({ r: 0, g: 0, b: 0 }, SRGBColorSpace);
  return [r, g, b];
}

// Viridis (S. van der Walt and N. Smith, CC0) without its darkest fifth, where shading would not show;
// a ramp for age: fresh to stale; and two for trust, what is not trusted and what is. view.css has the same.
const kHeight = [
  "#414487", "#355f8d", "#2a788e", "#21918c", "#22a884", "#44bf70", "#7ad151", "#bddf26", "#fde725",
];
const kAge = ["#0b8f86", "#5aa37c", "#b39b4c", "#b8763f", "#8d5a4f", "#6f6a70"];
const kDoubt = ["#a3111a", "#f59a35"];
const kTrust = ["#cfdde8", "#6c9bbd"];
const kWidth = 256;

function fill(pixels: Uint8Array, first: number, width: number, stops: string[]): void {
  const colours = stops.map((stop) => new Color(stop).getRGB({ r: 0, g: 0, b: 0 }, SRGBColorSpace));
  for (let i = 0; i < width; i += 1) {
    const position = (i / (width - 1)) * (colours.length - 1);
    const k = Math.min(Math.floor(position), colours.length - 2);
    const part = position - k;
    const [a, b] = [colours[k]!, colours[k + 1]!];
    const at = 4 * (first + i);
    pixels[at] = 255 * (a.r + part * (b.r - a.r));
    pixels[at + 1] = 255 * (a.g + part * (b.g - a.g));
    pixels[at + 2] = 255 * (a.b + part * (b.b - a.b));
    pixels[at + 3] = 255;
  }
}

/** Three rows: height, age, trust, whose second half, from 128 / 255 on, is trusted. */
export function rampTexture(): DataTexture {
  const pixels = new Uint8Array(4 * kWidth * 3);
  fill(pixels, 0, kWidth, kHeight);
  fill(pixels, kWidth, kWidth, kAge);
  fill(pixels, 2 * kWidth, kWidth / 2, kDoubt);
  fill(pixels, 2.5 * kWidth, kWidth / 2, kTrust);
  const texture = new DataTexture(pixels, kWidth, 3, RGBAFormat);
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
