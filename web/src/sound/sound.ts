// Contact and slip to hear: a knock where the proxy meets the surface, a rustle where it slides.

import { Flag, type StateMessage } from "../protocol/decode";
import type { Vector } from "../protocol/messages";

const kPatience = 1500; // ms; without a device for sound a browser never answers
const kSmooth = 0.03; // s
const kLoud = 0.5;
const kFullSpeed = 0.15; // m/s that sounds loudest
const kFullForce = 3; // N

function apart(a: Vector, b: Vector): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

export class Sound {
  private context: AudioContext | undefined;
  private rustle: GainNode | undefined;
  private band: BiquadFilterNode | undefined;
  private out: GainNode | undefined;
  private before: StateMessage | undefined;

  get on(): boolean {
    return this.context?.state === "running";
  }

  /** Has to come from a click: browsers let nothing sound before. */
  async toggle(): Promise<boolean> {
    const wasOn = this.on; // a new context may run at once
    if (this.context === undefined) this.build();
    if (wasOn) await this.context!.suspend();
    else await Promise.race([this.context!.resume(), new Promise((late) => setTimeout(late, kPatience))]);
    return this.on;
  }

  hear(state: StateMessage): void {
    const before = this.before;
    this.before = state;
    if (!this.on || before === undefined) return;
    const passed = state.time - before.time;
    if (!(passed > 0) || passed > 0.5) return;
    const touching = (state.flags & Flag.touching) !== 0;
    const touched = (before.flags & Flag.touching) !== 0;
    if (touching && !touched) this.knock(apart(state.hip, before.hip) / passed);
    this.slide(touching ? apart(state.proxy, before.proxy) / passed : 0, Math.hypot(...state.force));
  }

  private build(): void {
    const context = new AudioContext();
    this.context = context;
    this.out = new GainNode(context, { gain: kLoud });
    this.out.connect(context.destination);
    this.band = new BiquadFilterNode(context, { type: "bandpass", frequency: 500, Q: 0.8 });
    this.rustle = new GainNode(context, { gain: 0 });
    const noise = new AudioBufferSourceNode(context, { buffer: this.noise(2), loop: true });
    noise.connect(this.band).connect(this.rustle).connect(this.out);
    noise.start();
  }

  private noise(seconds: number): AudioBuffer {
    const context = this.context!;
    const buffer = context.createBuffer(1, seconds * context.sampleRate, context.sampleRate);
    const samples = buffer.getChannelData(0);
    for (let i = 0; i < samples.length; i += 1) samples[i] = 2 * Math.random() - 1;
    return buffer;
  }

  private knock(speed: number): void {
    const context = this.context!;
    const now = context.currentTime;
    const loud = Math.min(1, 0.15 + speed / kFullSpeed) * 0.6;
    const tone = new OscillatorNode(context, { frequency: 240 });
    tone.frequency.exponentialRampToValueAtTime(95, now + 0.07);
    const gain = new GainNode(context, { gain: 0 });
    gain.gain.setValueAtTime(loud, now);
    gain.gain.exponentialRampToValueAtTime(1e-3, now + 0.12);
    tone.connect(gain).connect(this.out!);
    tone.start(now);
    tone.stop(now + 0.13);
  }

  private slide(speed: number, force: number): void {
    const now = this.context!.currentTime;
    const quick = Math.min(1, speed / kFullSpeed);
    const loud = Math.sqrt(quick) * Math.min(1, force / kFullForce) * 0.5;
    this.rustle!.gain.setTargetAtTime(loud, now, kSmooth);
    this.band!.frequency.setTargetAtTime(250 + 1400 * quick, now, kSmooth);
  }
}
