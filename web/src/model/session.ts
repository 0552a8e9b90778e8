// What the page has received from the program: the newest of everything, and the past that plots need.

import { Flag, type CloudMessage, type PastMessage, type StateMessage } from "../protocol/decode";
import type { DeviceReport, SettingValue, SourceReport, Welcome } from "../protocol/messages";
import { Ring } from "./ring";

export const kForceSpan = 5; // s
export const kTimingSpan = 30; // s
export const kFrameSpan = 60; // s
const kSteps = 1 << 15;

export class DeviceHistory {
  latest: StateMessage | undefined;
  received = 0; // ms, performance.now()
  report: DeviceReport = { status: "ok" };
  readonly force = new Ring(kSteps, 5); // time, x, y, z, magnitude
  readonly torque = new Ring(4096, 5); // time, x, y, z, magnitude; N mm, of a tool that turns
  readonly timing = new Ring(4096, 5); // time, step p50 and p99, lateness p50 and p99; us

  take(state: StateMessage, now: number): void {
    if (this.latest !== undefined && state.time < this.latest.time) this.clear();
    this.latest = state;
    this.received = now;
    const n = state.samples.length / 3;
    for (let i = 0; i < n; i += 1) {
      const x = state.samples[3 * i]!;
      const y = state.samples[3 * i + 1]!;
      const z = state.samples[3 * i + 2]!;
      const time = state.time - (n - 1 - i) * state.interval;
      this.force.push(time, x, y, z, Math.hypot(x, y, z));
    }
    if (state.tool !== undefined) {
      const [x, y, z] = state.tool.torque.map((part) => 1000 * part) as [number, number, number];
      this.torque.push(state.time, x, y, z, Math.hypot(x, y, z));
    }
    const [p50, p99] = state.step;
    const [late50, late99] = state.lateness;
    this.timing.push(state.time, p50 * 1e6, p99 * 1e6, late50 * 1e6, late99 * 1e6);
  }

  /** What was before the moment of a recording that is shown now; what was shown before goes. */
  takePast({ time, samples }: PastMessage): void {
    this.force.clear();
    this.torque.clear();
    this.timing.clear();
    for (let i = 0; i + 3 < samples.length; i += 4) {
      const [before, x, y, z] = samples.subarray(i, i + 4) as unknown as [number, number, number, number];
      this.force.push(time + before, x, y, z, Math.hypot(x, y, z));
    }
    if (this.latest !== undefined && samples.length > 0) this.latest = { ...this.latest, time };
  }

  has(flag: keyof typeof Flag): boolean {
    return ((this.latest?.flags ?? 0) & Flag[flag]) !== 0;
  }

  clear(): void {
    this.latest = undefined;
    this.force.clear();
    this.torque.clear();
    this.timing.clear();
  }
}

export class SourceHistory {
  report: SourceReport | undefined;
  stamp = NaN; // s, of the newest cloud
  shown = 0; // points of the newest cloud
  untrusted = 0; // share of them, 0 to 1, of a cloud that stands still
  visible = true;
  readonly frames = new Ring(512, 3); // time (s, the page's), latency and age in ms

  constructor(
    readonly name: string,
    readonly camera: boolean,
  ) {}

  take(report: SourceReport, now: number): void {
    this.report = report;
    this.frames.push(now / 1000, (report.latency ?? NaN) * 1000, (report.age ?? NaN) * 1000);
  }

  takeCloud(cloud: CloudMessage): void {
    this.stamp = cloud.stamp;
    this.shown = cloud.count;
    if (this.camera || cloud.trust === undefined) return;
    const doubted = cloud.trust.reduce((sum, trust) => sum + (trust < 128 ? 1 : 0), 0);
    this.untrusted = doubted / Math.max(cloud.count, 1);
  }
}

export class Session {
  welcome: Welcome | undefined;
  open = false; // the program receives what is sent
  device = 0; // whose force is shown, and which a hand moves
  devices: DeviceHistory[] = [];
  sources: SourceHistory[] = [];
  values = new Map<string, SettingValue>();

  /** Visibility of sources survives a new connection to the same scene. */
  begin(welcome: Welcome): void {
    const visible = new Map(this.sources.map((source) => [source.name, source.visible]));
    this.welcome = welcome;
    this.devices = welcome.devices.map(() => new DeviceHistory());
    this.sources = welcome.sources.map(({ name, camera }) => {
      const source = new SourceHistory(name, camera);
      source.visible = visible.get(name) ?? true;
      return source;
    });
    this.values = new Map(welcome.settings.map(({ key, value }) => [key, value]));
    if (this.device >= this.devices.length) this.device = 0;
  }

  /** Is a recording shown, which nobody can change? */
  get recorded(): boolean {
    return this.welcome?.timeline !== undefined;
  }

  get tool(): DeviceHistory | undefined {
    return this.devices[this.device];
  }

  /** Is the tool in a hand that motors push, which no page takes? In contact it gets stiffer only as far as motion pays for it. */
  get motors(): boolean {
    return this.welcome?.devices[this.device]?.takeable === false;
  }
}
