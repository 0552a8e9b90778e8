// One plot in the page's style, on uPlot.

import uPlot from "uplot";
import { cssColour } from "../view/colours";
import { make } from "./dom";
import { threeDigits } from "./numbers";

export interface Curve {
  label: string;
  colour: string; // a custom property of the style sheet
  width?: number;
  filled?: boolean;
  dash?: number[];
}

export interface PlotOptions {
  name: string;
  title: string;
  unit: string;
  curves: Curve[];
  x: [number, number];
  xUnit: string;
  logarithmic?: boolean;
  least: number; // the smallest top of the ordinate; of a logarithmic one the bottom
  most?: number; // of a logarithmic one the smallest top
}

const kLabelHeight = 18; // pixels
const kLeastDrag = 4; // pixels; less is a press

type Range = [number, number];

/** The next round number. */
export function nice(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return ([1, 1.5, 2, 3, 4, 5, 6, 8].find((f) => f * power >= value * (1 - 1e-9)) ?? 10) * power;
}

function linearRange(least: number) {
  return (_: uPlot, low: number | null, high: number | null): Range => {
    const top = nice(Math.max(least, (high ?? 0) * 1.06));
    const bottom = (low ?? 0) < -0.02 * least ? -nice(-(low ?? 0) * 1.06) : 0;
    return [bottom, top];
  };
}

function logRange(least: number, most: number) {
  return (_: uPlot, _low: number | null, high: number | null): Range => [
    least, 10 ** Math.ceil(Math.log10(Math.max(most, high ?? 0)) - 1e-9),
  ];
}

function tick(value: number | null): string {
  if (value === null) return "";
  return String(Number(value.toPrecision(4))).replace("-", "−");
}

function decades(plot: uPlot, _axis: number, low: number, high: number): number[] {
  const first = Math.round(Math.log10(low));
  const count = Math.round(Math.log10(high)) - first;
  const room = Math.max(1, Math.floor(plot.bbox.height / devicePixelRatio / kLabelHeight));
  const every = Math.ceil(count / room);
  return Array.from({ length: Math.floor(count / every) + 1 }, (_, i) => 10 ** (first + i * every));
}

function axis(options: PlotOptions, side: 2 | 3): uPlot.Axis {
  const flat = side === 2;
  return {
    side,
    size: flat ? 20 : 42,
    gap: 4,
    space: flat ? 50 : 20,
    font: "11px system-ui, sans-serif",
    stroke: () => cssColour("--soft"),
    grid: { stroke: () => cssColour("--grid"), width: 1 },
    ticks: { show: false },
    values: (_, splits) => splits.map((value, i) => `${tick(value)}${flat && i === 0 ? ` ${options.xUnit}` : ""}`),
    ...(!flat && options.logarithmic ? { splits: decades, filter: (_: uPlot, splits: number[]) => splits } : {}),
  };
}

export function seriesOf(curve: Curve): uPlot.Series {
  return {
    label: curve.label,
    stroke: () => cssColour(curve.colour),
    width: curve.width ?? 1.25,
    points: { show: false },
    ...(curve.filled ? { fill: () => `${cssColour(curve.colour)}2e` } : {}),
    ...(curve.dash ? { dash: curve.dash } : {}),
  };
}

/** Canvases that are made meanwhile are drawn on the page's own thread: small ones that change often cost a graphics
 * process more than their picture, above all one that draws in software. */
function drawnHere<T>(makes: () => T): T {
  const prototype = HTMLCanvasElement.prototype;
  // eslint-disable-next-line @typescript-eslint/unbound-method -- it is called with its canvas
  const usual = prototype.getContext;
  prototype.getContext = function (this: HTMLCanvasElement, kind: string, options?: object) {
    return usual.call(this, kind, { ...options, willReadFrequently: true });
  } as typeof usual;
  try {
    return makes();
  } finally {
    prototype.getContext = usual;
  }
}

export class Plot {
  readonly figure: HTMLElement;
  private readonly legend = make("span", { class: "curves" });
  private readonly readout = make("span", { class: "at" });
  private readonly values: HTMLElement[] = []; // of the curves, at the cursor
  private readonly box = make("div", { class: "plot" });
  private readonly plot: uPlot;
  private curves: Curve[] = [];
  private part: Range | undefined; // of x that is shown; undefined: all

  constructor(private readonly options: PlotOptions) {
    const { x, least } = options;
    this.figure = make("figure", { class: `chart ${options.name}` },
      make("figcaption", {},
        make("span", {}, make("b", {}, options.title), " ", make("span", { class: "unit" }, options.unit)),
        this.legend, this.readout),
      this.box);
    const range = options.logarithmic ? logRange(least, options.most ?? 1) : linearRange(least);
    this.plot = drawnHere(() => new uPlot({
      width: 100,
      height: 100,
      padding: [6, 10, 0, 0],
      legend: { show: false },
      cursor: { y: false, points: { size: 6 }, drag: { setScale: false }, bind: { dblclick: () => () => this.zoom(undefined) } },
      scales: {
        x: { time: false, range: () => this.part ?? x },
        y: { range, ...(options.logarithmic ? { distr: 3 } : {}) },
      },
      axes: [axis(options, 2), axis(options, 3)],
      series: [{}, ...options.curves.map(seriesOf)],
      hooks: { setCursor: [() => this.showValues()], setSelect: [(plot) => this.zoomTo(plot.select)] },
    }, [[]], this.box));
    this.name(options.curves);
    new ResizeObserver(() => this.resize()).observe(this.box);
  }

  get visible(): boolean {
    return this.box.clientWidth > 0;
  }

  set(data: ArrayLike<number>[]): void {
    this.plot.setData(data as unknown as uPlot.AlignedData);
  }

  /** Other curves than before: as many as the data will have. */
  replace(curves: Curve[]): void {
    for (let i = this.curves.length; i > 0; i -= 1) this.plot.delSeries(i);
    curves.forEach((curve, i) => this.plot.addSeries(seriesOf(curve), i + 1));
    this.name(curves);
  }

  /** What a drag has marked; a double press shows all again. */
  private zoomTo({ left, width }: uPlot.Select): void {
    if (width < kLeastDrag) return;
    this.zoom([this.plot.posToVal(left, "x"), this.plot.posToVal(left + width, "x")]);
    this.plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }

  private zoom(part: Range | undefined): null {
    this.part = part;
    this.plot.setData(this.plot.data);
    return null;
  }

  redraw(): void {
    this.plot.redraw(false);
  }

  private name(curves: Curve[]): void {
    this.curves = curves;
    this.values.splice(0);
    this.legend.replaceChildren(...curves.map(({ label, colour, dash }) => {
      const swatch = make("i", { class: dash ? "dashed" : "" });
      swatch.style.setProperty("--swatch", `var(${colour})`);
      const value = make("b");
      this.values.push(value);
      return make("span", { hidden: label === "" }, swatch, label, value);
    }));
  }

  private showValues(): void {
    const at = this.plot.cursor.idx;
    const x = at === null || at === undefined ? undefined : this.plot.data[0][at];
    this.readout.textContent = x === undefined ? "" : `${tick(x)} ${this.options.xUnit}`;
    this.values.forEach((element, i) => {
      const value = x === undefined ? undefined : this.plot.data[i + 1]?.[at!];
      element.textContent = typeof value === "number" ? ` ${threeDigits(value)}` : "";
    });
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width > 0 && height > 0) this.plot.setSize({ width, height });
  }
}
