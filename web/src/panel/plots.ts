// Plots: force, torque of a tool that turns, the force's spectrum, the servo's time, the frames' time.

import { kForceSpan, kFrameSpan, kTimingSpan, type Session } from "../model/session";
import type { Ring } from "../model/ring";
import { kWindow, Spectrum } from "../model/spectrum";
import { sourceColour } from "../view/colours";
import { byId } from "./dom";
import { Plot } from "./plot";

const kInterval = 100; // ms between two pictures of a plot
const kCalmInterval = 500; // of those that change slowly
const kSlowTimes = 2.5; // times as long where drawing is slow
const kFloor = 0.01; // mN, least amplitude that the spectrum shows
const kHighest = 500; // Hz

const kParts = [
  { label: "x", colour: "--x" },
  { label: "y", colour: "--y" },
  { label: "z", colour: "--z" },
  { label: "size", colour: "--force", width: 1.75, filled: true },
];

export class Plots {
  frozen = false;
  private drawn = -Infinity; // ms
  private calmly = -Infinity;
  private readonly spectrum = new Spectrum();
  private readonly force = new Plot({
    name: "force", title: "Force on the hand", unit: "N", xUnit: "s", x: [-kForceSpan, 0], least: 0.5, curves: kParts,
  });
  private readonly torque = new Plot({
    name: "torque", title: "Torque about the handle", unit: "N mm", xUnit: "s", x: [-kForceSpan, 0], least: 5, curves: kParts,
  });
  private readonly tones = new Plot({
    name: "spectrum", title: "Spectrum", unit: "mN over Hz", xUnit: "Hz", x: [0, kHighest], least: kFloor, most: 1000,
    logarithmic: true, curves: [{ label: "all directions", colour: "--force", filled: true }],
  });
  private readonly steps = new Plot({
    name: "steps", title: "Servo", unit: "µs", xUnit: "s", x: [-kTimingSpan, 0], least: 1, most: 100,
    logarithmic: true,
    curves: [
      { label: "step", colour: "--x", width: 1.75 },
      { label: "99 %", colour: "--x", dash: [4, 3] },
      { label: "late", colour: "--z" },
    ],
  });
  private readonly frames = new Plot({
    name: "frames", title: "Frames", unit: "latency, ms", xUnit: "s", x: [-kFrameSpan, 0], least: 50, curves: [],
  });
  private readonly all = [this.force, this.torque, this.tones, this.steps, this.frames];

  constructor(private readonly session: Session) {
    byId("strip").prepend(...this.all.map((plot) => plot.figure));
  }

  begin(): void {
    const cameras = this.cameras();
    this.frames.replace(cameras.flatMap(({ source, index }, i) => [
      { label: source.name, colour: sourceColour(index), width: 1.75 },
      { label: i === cameras.length - 1 ? "age" : "", colour: sourceColour(index), dash: [3, 3] },
    ]));
    this.frames.figure.classList.toggle("none", cameras.length === 0 || this.session.recorded);
    this.torque.figure.classList.add("none"); // until a tool reports one
  }

  update(now: number, slow: boolean): void {
    const times = slow ? kSlowTimes : 1;
    if (this.frozen || now - this.drawn < times * kInterval) return;
    this.drawn = now;
    if (this.force.visible) this.show(this.force, this.session.tool?.force);
    this.torque.figure.classList.toggle("none", this.session.tool?.latest?.tool === undefined);
    if (this.torque.visible) this.show(this.torque, this.session.tool?.torque);
    if (now - this.calmly < times * kCalmInterval) return;
    this.calmly = now;
    if (this.tones.visible) this.showSpectrum();
    if (this.steps.visible) this.showSteps();
    if (this.frames.visible) this.showFrames(now / 1000);
  }

  redraw(): void {
    for (const plot of this.all) plot.redraw();
  }

  private cameras() {
    return this.session.sources
      .map((source, index) => ({ source, index }))
      .filter(({ source }) => source.camera);
  }

  private show(plot: Plot, ring: Ring | undefined): void {
    if (ring === undefined || ring.length === 0) return;
    const newest = ring.at(0, ring.length - 1);
    const first = ring.from(newest - kForceSpan);
    const times = ring.copy(0, first).map((time) => time - newest);
    plot.set([times, ...[1, 2, 3, 4].map((column) => ring.copy(column, first))]);
  }

  private showSpectrum(): void {
    const ring = this.session.tool?.force;
    const interval = this.session.tool?.latest?.interval ?? 0;
    if (ring === undefined || ring.length < kWindow || !(interval > 0)) return;
    const components = [1, 2, 3].map((column) => ring.copy(column, ring.length - kWindow));
    const amplitudes = this.spectrum.update(components);
    const tone = 1 / (interval * kWindow); // Hz
    const count = Math.min(amplitudes.length, Math.ceil(kHighest / tone) + 1);
    this.tones.set([
      Float64Array.from({ length: count }, (_, k) => k * tone),
      amplitudes.slice(0, count).map((amplitude) => Math.max(1000 * amplitude, kFloor)),
    ]);
  }

  private showSteps(): void {
    const ring = this.session.tool?.timing;
    if (ring === undefined || ring.length === 0) return;
    const newest = ring.at(0, ring.length - 1);
    const first = ring.from(newest - kTimingSpan);
    const shown = (column: number) => ring.copy(column, first).map((us) => Math.max(us, 0.1));
    this.steps.set([ring.copy(0, first).map((time) => time - newest), shown(1), shown(2), shown(4)]);
  }

  private showFrames(now: number): void {
    const cameras = this.cameras();
    const ring = cameras[0]?.source.frames;
    if (ring === undefined) return;
    const times = ring.copy(0).map((time) => time - now);
    this.frames.set([times, ...cameras.flatMap(({ source }) => [source.frames.copy(1), source.frames.copy(2)])]);
  }
}
