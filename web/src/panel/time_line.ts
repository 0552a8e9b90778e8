// The time line of a recording: which moment is shown, how it goes by, and where the forces are.

import type { Moment, ToProgram } from "../protocol/messages";
import { cssColour } from "../view/colours";
import { byId, icon, make, say, throttle } from "./dom";
import { clock } from "./numbers";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];
const kSeekInterval = 50; // ms
const kOwn = 400; // ms that the slider is where the person put it
const kHeard = 2000; // ms within which the program has heard of a speed
const kLeast = 0.5; // N, the smallest top of the forces

export class TimeLinePanel {
  private length = 0; // s; 0: there is none
  private moment: Moment = { time: 0, playing: false, speed: 1 };
  private forces: number[] = [];
  private moved = -Infinity; // ms, by the person
  private chosen: number | undefined; // speed, of which the program has not heard yet
  private choosing = 0; // ms, when
  private readonly slider = byId<HTMLInputElement>("time");
  private readonly speed = byId<HTMLSelectElement>("time-speed");
  private readonly tell = throttle<number>(kSeekInterval, (time) => this.send({ type: "seek", time }));

  constructor(private readonly send: (message: ToProgram) => void) {
    this.speed.replaceChildren(...kSpeeds.map((speed) =>
      make("option", { value: speed, selected: speed === 1 }, `${speed} ×`)));
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.speed.addEventListener("change", () => {
      this.chosen = Number(this.speed.value);
      this.choosing = performance.now();
      this.play(this.moment.playing);
    });
    byId("play").addEventListener("click", () => this.toggle());
    new ResizeObserver(() => this.draw()).observe(byId("time-forces"));
  }

  begin(length: number | undefined): void {
    this.length = length ?? 0;
    this.chosen = undefined;
    byId("time-line").hidden = length === undefined;
    document.body.classList.toggle("recorded", length !== undefined);
    this.slider.max = String(this.length);
    this.show();
  }

  take(moment: Moment): void {
    const own = performance.now() - this.moved < kOwn;
    this.moment = own ? { ...moment, time: this.moment.time } : moment;
    const late = performance.now() - this.choosing > kHeard; // another page has chosen, too
    if (late || moment.speed === this.chosen) this.chosen = undefined;
    this.show();
  }

  takeEnvelope(forces: number[]): void {
    this.forces = forces;
    this.draw();
  }

  toggle(): void {
    this.play(!this.moment.playing);
  }

  step(seconds: number): void {
    this.seek(this.moment.time + seconds);
  }

  draw(): void {
    const canvas = byId<HTMLCanvasElement>("time-forces");
    const context = canvas.getContext("2d");
    if (context === null || this.length === 0) return;
    const width = (canvas.width = Math.round(canvas.clientWidth * devicePixelRatio));
    const height = (canvas.height = Math.round(canvas.clientHeight * devicePixelRatio));
    const top = Math.max(kLeast, ...this.forces);
    context.fillStyle = cssColour("--grid");
    context.fillRect(0, height - 1, width, 1);
    context.fillStyle = `${cssColour("--force")}aa`;
    context.beginPath();
    context.moveTo(0, height);
    this.forces.forEach((force, i) => {
      const y = height * (1 - force / top);
      context.lineTo((i * width) / this.forces.length, y);
      context.lineTo(((i + 1) * width) / this.forces.length, y);
    });
    context.lineTo(width, height);
    context.fill();
  }

  private play(on: boolean): void {
    this.send({ type: "play", on, speed: Number(this.speed.value) });
  }

  private seek(time: number): void {
    this.moved = performance.now();
    this.moment.time = Math.min(this.length, Math.max(0, time));
    this.tell(this.moment.time);
    this.show();
  }

  private show(): void {
    const { time, playing, speed } = this.moment;
    const words = `${clock(time)} / ${clock(this.length)}`;
    this.slider.value = String(time);
    this.slider.setAttribute("aria-valuetext", words);
    say(byId("time-words"), words);
    icon(byId("play"), playing ? "pause" : "play");
    byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    byId("play").title = playing ? "Pause (Space)" : "Play (Space)";
    if (this.chosen === undefined && kSpeeds.includes(speed)) this.speed.value = String(speed);
  }
}
