// The instrument: a knock where the proxy meets the surface; where it slides noise, grain and a squeak.

import { Flag, type StateMessage } from "../protocol/decode";
import type { Vector } from "../protocol/messages";
import { pitchOf, slipOf, type Surface } from "./surface";

export type ContactState = Pick<StateMessage, "time" | "flags" | "hip" | "proxy" | "force">;

const kLoud = 0.5; // of what a loudspeaker gives: a page is no alarm
const kSmooth = 0.03; // s, in which a sound follows: two states
const kSilence = 0.25; // s without a state, after which a slip is over
const kLongest = 0.5; // s between two states of one movement
const kKnockSpeed = 0.15; // m/s of a hand that knocks loudest
const kKnock = 0.12; // s that a knock rings
const kAttack = 1.5; // a knock begins so many times as high as it ends
const kRing = 1.5; // quality of what grains excite: wide enough for some of their overtones

function apart(a: Vector, b: Vector): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

export class Voice {
  private readonly out: GainNode;
  private readonly band: BiquadFilterNode;
  private readonly noise: GainNode;
  private readonly saw: OscillatorNode;
  private readonly ring: BiquadFilterNode;
  private readonly grain: GainNode;
  private readonly reed: OscillatorNode;
  private readonly squeak: GainNode;
  private before: ContactState | undefined;

  constructor(private readonly context: BaseAudioContext) {
    this.out = new GainNode(context, { gain: kLoud });
    this.out.connect(context.destination);
    this.band = new BiquadFilterNode(context, { type: "bandpass" });
    this.noise = new GainNode(context, { gain: 0 });
    this.saw = new OscillatorNode(context, { type: "sawtooth" });
    this.ring = new BiquadFilterNode(context, { type: "bandpass", Q: kRing });
    this.grain = new GainNode(context, { gain: 0 });
    this.reed = new OscillatorNode(context, { type: "triangle" });
    this.squeak = new GainNode(context, { gain: 0 });
    const hiss = new AudioBufferSourceNode(context, { buffer: whiteNoise(context, 2), loop: true });
    hiss.connect(this.band).connect(this.noise).connect(this.out);
    this.saw.connect(this.ring).connect(this.grain).connect(this.out);
    this.reed.connect(this.squeak).connect(this.out);
    for (const source of [hiss, this.saw, this.reed]) source.start();
  }

  play(state: ContactState, surface: Surface): void {
    const before = this.before;
    this.before = state;
    if (before === undefined) return;
    const passed = state.time - before.time;
    if (!(passed > 0) || passed > kLongest) return;
    const touching = (state.flags & Flag.touching) !== 0;
    const touched = (before.flags & Flag.touching) !== 0;
    if (touching && !touched) this.knock(apart(state.hip, before.hip) / passed, pitchOf(surface));
    const speed = touching && touched ? apart(state.proxy, before.proxy) / passed : 0;
    this.slide(surface, speed, Math.hypot(...state.force));
  }

  private knock(speed: number, pitch: number): void {
    const now = this.context.currentTime;
    const loud = Math.min(1, 0.15 + speed / kKnockSpeed) * 0.6; // the softest touch is heard, the hardest does not clip
    const tone = new OscillatorNode(this.context, { frequency: pitch });
    tone.frequency.setValueAtTime(kAttack * pitch, now);
    tone.frequency.exponentialRampToValueAtTime(pitch, now + kKnock / 4);
    const gain = new GainNode(this.context, { gain: 0 });
    gain.gain.setValueAtTime(loud, now);
    gain.gain.exponentialRampToValueAtTime(1e-3, now + kKnock);
    tone.connect(gain).connect(this.out);
    tone.start(now);
    tone.stop(now + kKnock);
  }

  private slide(surface: Surface, speed: number, force: number): void {
    const { noise, grain, squeak } = slipOf(surface, speed, force);
    this.turn(this.noise, noise.gain);
    this.turn(this.grain, grain.gain);
    this.turn(this.squeak, squeak.gain);
    this.tune(this.band.frequency, noise.frequency);
    this.tune(this.band.Q, noise.quality);
    this.tune(this.saw.frequency, grain.frequency);
    this.tune(this.ring.frequency, pitchOf(surface));
    this.tune(this.reed.frequency, squeak.frequency);
  }

  private tune(knob: AudioParam, value: number): void {
    knob.setTargetAtTime(value, this.context.currentTime, kSmooth);
  }

  /** And to nothing, should no state follow. */
  private turn({ gain }: GainNode, loud: number): void {
    const now = this.context.currentTime;
    gain.cancelScheduledValues(now);
    gain.setTargetAtTime(loud, now, kSmooth);
    gain.setTargetAtTime(0, now + kSilence, kSmooth);
  }
}

function whiteNoise(context: BaseAudioContext, seconds: number): AudioBuffer {
  const buffer = context.createBuffer(1, seconds * context.sampleRate, context.sampleRate);
  const samples = buffer.getChannelData(0);
  for (let i = 0; i < samples.length; i += 1) samples[i] = 2 * Math.random() - 1;
  return buffer;
}
