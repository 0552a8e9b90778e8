// The force as a number, and what the servo notes, in words.

import type { DeviceHistory } from "../model/session";
import { Flag, type StateMessage } from "../protocol/decode";
import { byId, make, say } from "./dom";
import { millimetres, threeDigits } from "./numbers";

type Name = keyof typeof Flag;

const kFlagWords: Partial<Record<Name, [level: string, words: string, reason: string]>> = {
  paused: ["info", "paused: no force", "Somebody paused the run; the force ramps up again on resume"],
  clutched: ["info", "clutch held: the hand moves without the tool", "The tool stays until the button is released"],
  fault: ["fault", "fault: no force until reset", "A computed force or reported position was not finite"],
  watchdog: ["fault", "watchdog: the servo was late", "Zero force now; it ramps up again"],
  clamped: ["warning", "force limit reached", "Limited to what the device can sustain, or to --maximum-force"],
  slewed: ["warning", "slew limit active", "The force changed faster than the hand's motion explains"],
  braked: ["warning", "brake: dissipating energy", "The hand had received more energy than it put in"],
  softened: ["info", "stiffness limited by the device", "The requested stiffness would make the device vibrate"],
  notLoaded: ["info", "not loaded: nothing is felt here yet", "The cloud here is still read and prepared, or cannot be read"],
  thinned: ["warning", "points skipped: too many near the tool", "Some were skipped to keep the servo rate"],
};
const kInner = new Set<Name>(["slewed", "braked", "thinned"]); // of the servo: nothing that a first visit can act on
const kLift = "lift the tool to feel full force again"; // where motors push
const kLarge = 2; // below it the hand's own depth adds little
const kFull = 0.95; // of the stiffness
const kLinger = 700; // ms that a flag stays readable
const kStale = 1000; // ms without a state

export class Readout {
  private readonly force = byId("force");
  private readonly touch = byId("touch");
  private readonly lift = byId("lift");
  private softUntil = 0; // in contact a device's force comes back no further than motion pays for it
  private motors = false;
  private nothing = false;
  private height: number | undefined;
  private scale = 1; // world metres of a metre of the hand
  private readonly components = [0, 1, 2].map(() => make("dd"));
  private readonly flags = new Map<Name, { element: HTMLElement; until: number }>();

  constructor() {
    const names = ["x", "y", "z"];
    byId("parts").replaceChildren(
      ...this.components.map((component, i) => make("div", {}, make("dt", {}, names[i]!), component)),
    );
    for (const [name, [level, words, reason]] of Object.entries(kFlagWords)) {
      const inner = kInner.has(name as Name) ? " inner" : "";
      const element = make("li", { class: level + inner, title: reason, hidden: true }, words);
      this.flags.set(name as Name, { element, until: 0 });
    }
    byId("flags").replaceChildren(...[...this.flags.values()].map(({ element }) => element));
  }

  /** For every state, so that short flags are seen too. nothing: is felt where it presses. */
  note(tool: DeviceHistory, now: number, nothing: boolean): void {
    for (const [name, flag] of this.flags) if (tool.has(name)) flag.until = now + kLinger;
    this.nothing = nothing;
    if (tool.has("touching") && (tool.has("starting") || tool.has("softer"))) this.softUntil = now + kLinger;
  }

  /** Of the device that is shown. motors: it is in a hand that they push. */
  begin(scale: number, motors: boolean): void {
    this.scale = scale;
    this.motors = motors;
  }

  /** height: of a free hand above the surface, m; stiffness: of the surface, N/m. */
  update(tool: DeviceHistory | undefined, now: number, height: number | undefined, stiffness: number): void {
    this.height = height;
    const state = tool?.latest;
    for (const { element, until } of this.flags.values()) element.hidden = until < now;
    const soft = now < this.softUntil && state !== undefined ? softness(state, stiffness) : "";
    say(this.lift, soft === "" || !this.motors ? soft : `${soft}; ${kLift}`);
    if (tool === undefined || state === undefined) {
      say(this.touch, "no tool yet");
      return;
    }
    say(this.force, Math.hypot(...state.force).toFixed(2));
    this.components.forEach((component, i) => say(component, signed(state.force[i as 0 | 1 | 2])));
    say(this.touch, now - tool.received > kStale ? "no data for a while" : this.words(tool));
    byId("view-area").classList.toggle("touching", tool.has("touching"));
  }

  /** For a screen reader, on request. */
  sentence(tool: DeviceHistory | undefined): string {
    const state = tool?.latest;
    if (tool === undefined || state === undefined) return "No tool yet.";
    return `${this.words(tool)}, ${Math.hypot(...state.force).toFixed(2)} newtons.`;
  }

  private words(tool: DeviceHistory): string {
    const state = tool.latest!;
    const { status, reason } = tool.report;
    if (status !== "ok") return reason === undefined ? status : `${status}: ${reason}`;
    if (tool.has("behind") && !tool.has("touching")) return "behind what the camera sees: nothing is felt";
    if (tool.has("inside")) return "inside of the surface: nothing is felt until the tool is out";
    if (this.nothing && !tool.has("notLoaded")) return "no surface here";
    if (!tool.has("touching")) return this.height === undefined ? "free" : `free, ${millimetres(this.height)} from the surface`;
    const deep = `touching, ${millimetres(depthOf(state))} deep${torqueOf(state)}`;
    return this.scale < kLarge ? deep : `${deep}, ${millimetres(depthOf(state) / this.scale)} at the hand`;
  }
}

function depthOf({ proxy, hip }: StateMessage): number {
  return Math.hypot(...proxy.map((p, i) => p - hip[i as 0 | 1 | 2]));
}

/** In words, of a tool that turns. */
function torqueOf({ tool }: StateMessage): string {
  if (tool === undefined) return "";
  const grip = Math.abs(tool.grip) < 0.005 ? "" : `, grip ${tool.grip.toFixed(2)} N`;
  return `, torque ${threeDigits(1000 * Math.hypot(...tool.torque))} N mm${grip}`;
}

/** The share of the surface's stiffness that is felt; empty where all of it is. */
function softness(state: StateMessage, stiffness: number): string {
  const share = Math.hypot(...state.force) / (stiffness * depthOf(state));
  return share < kFull ? `soft: ${Math.round(100 * share)} %` : "";
}

function signed(value: number): string {
  return `${value < -0.005 ? "−" : "+"}${Math.abs(value).toFixed(2)}`;
}
