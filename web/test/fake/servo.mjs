// The fake program's servo: a tool that explores, or goes where a page's hand is; a spring to the surface.

import { kBall, stopAt, tableHeight } from "./scene.mjs";

const kStep = 1e-3; // s
const kFollow = 0.02; // s, in which the tool comes to a hand
const kRadius = 0.009; // m, support radius

export class Servo {
  time = 0;
  paused = false;
  taken = false;
  fault = false;
  hand = [0, 0, 0.05];
  hip = [-0.2, -0.1, 0.05];
  friction = 0;
  texture = 0;
  stiffness = 500;
  felt = 500; // grows to that out of contact alone
  bound = 6;
  starting = false; // after the watchdog, until the tool is lifted
  hole = false; // what is seen is no surface
  contact;
  force = [0, 0, 0];
  samples = [];
  tool = { hand: [0, 0, 0, 1], proxy: [0, 0, 0, 1], opening: 0, torque: [0, 0.02, 0] }; // where there is one
  clamped = false;

  constructor(random) {
    this.random = random;
  }

  advance(seconds) {
    for (let left = seconds; left > kStep / 2; left -= kStep) this.step();
  }

  /** What there is to tell, and begins the next stretch. */
  report() {
    const samples = this.samples.splice(0);
    const spread = () => 0.9 + 0.2 * this.random();
    const state = {
      device: 0,
      flags: (this.contact ? 1 : 0) | (this.paused ? 2 : 0) | (this.taken ? 4 : 0) |
        (this.clamped ? 8 : 0) | (this.fault ? 64 : 0) |
        (this.contact && this.felt < 0.95 * this.stiffness ? 256 : 0) | (this.contact && this.starting ? 1024 : 0),
      time: this.time,
      hip: this.hip,
      proxy: this.contact?.proxy ?? this.hip,
      normal: this.contact?.normal ?? [0, 0, 0],
      force: this.force,
      radius: kRadius,
      rate: 1000,
      step: [14e-6 * spread(), 31e-6 * spread()],
      lateness: [4e-6 * spread(), 18e-6 * spread() * (this.random() < 0.02 ? 6 : 1)],
      interval: kStep,
      samples,
    };
    this.clamped = false;
    return state;
  }

  step() {
    this.time += kStep;
    const goal = this.taken ? this.hand : this.exploring();
    const part = kStep / kFollow;
    this.hip = this.hip.map((c, i) => c + part * (goal[i] - c));
    this.contact = this.hole ? undefined : stopAt(this.hip);
    if (!this.contact || this.felt > this.stiffness) this.felt = this.stiffness;
    if (!this.contact) this.starting = false;
    this.force = this.paused || this.fault || this.starting || !this.contact ? [0, 0, 0] : this.spring();
    this.samples.push(this.force);
  }

  spring() {
    const { proxy, normal } = this.contact;
    const grain = 1 + this.texture * Math.sin(2 * Math.PI * 180 * this.time) * 0.2;
    const force = proxy.map((c, i) => this.felt * (c - this.hip[i]) * grain + 0.01 * (this.random() - 0.5) * normal[i]);
    const size = Math.hypot(...force);
    if (size <= this.bound) return force;
    this.clamped = true;
    return force.map((c) => (c * this.bound) / size);
  }

  /** Slides over the table's bumps and the ball, lifts now and then. */
  exploring() {
    const t = this.time;
    const x = 0.02 - 0.2 * Math.cos(0.55 * t);
    const y = 0.05 * Math.sin(0.9 * t);
    const over = Math.hypot(x - kBall.centre[0], y - kBall.centre[1]);
    const ball = over < kBall.radius ? kBall.centre[2] + Math.sqrt(kBall.radius ** 2 - over ** 2) : 0;
    const deep = 0.004 + 0.002 * Math.sin(1.7 * t);
    const lift = Math.max(0, Math.sin(0.8 * t) - 0.75) * 0.12;
    return [x, y, Math.max(tableHeight(x, y), ball) - deep + lift];
  }
}
