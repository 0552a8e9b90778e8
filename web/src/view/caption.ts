// The caption of a saved picture: words, and a length in the middle of the view.

import { colourOf } from "./colours";
import type { ScaleBar } from "./scale_bar";

const kEdge = 16; // style-sheet pixels
const kTick = 4;

/** A copy of a view's canvas with these at its lower edge; pixels: of the canvas, a style-sheet pixel. */
export function captioned(view: HTMLCanvasElement, pixels: number, words: string, bar: ScaleBar): HTMLCanvasElement {
  const copy = document.createElement("canvas");
  copy.width = view.width;
  copy.height = view.height;
  const pen = copy.getContext("2d")!;
  pen.drawImage(view, 0, 0);
  pen.scale(pixels, pixels);
  const foot = view.height / pixels - kEdge;
  pen.fillStyle = `#${colourOf("--ink").getHexString()}`;
  pen.font = "14px system-ui, sans-serif";
  const write = (text: string, x: number, y: number) => {
    const room = view.width / pixels - x - kEdge;
    pen.strokeText(text, x, y, room);
    pen.fillText(text, x, y, room);
  };
  pen.lineJoin = "round";
  pen.lineWidth = 4;
  pen.strokeStyle = `#${colourOf("--view").getHexString()}`;
  write(words, kEdge, foot - 2 * kEdge);
  write(bar.label, 1.5 * kEdge + bar.pixels, foot + kTick);
  pen.lineWidth = 2;
  pen.strokeStyle = pen.fillStyle;
  pen.beginPath();
  for (const end of [kEdge, kEdge + bar.pixels]) {
    pen.moveTo(end, foot - kTick);
    pen.lineTo(end, foot + kTick);
  }
  pen.moveTo(kEdge, foot);
  pen.lineTo(kEdge + bar.pixels, foot);
  pen.stroke();
  return copy;
}
