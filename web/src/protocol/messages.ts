// The messages between page and program as JSON: docs/viewer_protocol.md.

export const kVersion = 2;

export type Vector = [number, number, number];
export type Quaternion = [number, number, number, number]; // x, y, z, w
export type SettingValue = number | string | boolean;

export interface Setting {
  key: string;
  label: string;
  unit?: string;
  kind: "number" | "choice" | "switch";
  least?: number;
  most?: number;
  step?: number;
  choices?: string[];
  value: SettingValue;
  restarts?: boolean; // another value begins the run anew
  question?: string; // which one of the choices answers
}

export interface DeviceInfo {
  name: string;
  takeable: boolean;
  scale?: number; // world metres of a metre of its hand
}

export interface SourceInfo {
  name: string;
  camera: boolean;
}

export interface DeviceReport {
  status: string; // ok, silent, finished, failed
  reason?: string; // why it is silent or has failed, and what to do
}

/** A field is absent where its value is unknown. */
export interface SourceReport {
  name: string;
  phase: string; // starting, running, stalled, failed, ended; still without a stream
  rate?: number; // Hz
  points?: number;
  latency?: number; // s, from frame to touchable
  age?: number; // s, of what is felt
  dropped?: number;
  disagreement?: number; // m
  pose?: { position: Vector; quaternion: Quaternion };
  frustum?: Vector; // tan of half the width, of half the height; far in m
}

export interface Welcome {
  type: "welcome";
  version: number;
  run: string;
  scene: string;
  origin: Vector;
  up: Vector;
  eye?: Vector; // from where to look at first, where no sensor reports a pose
  radius: number; // m
  devices: DeviceInfo[];
  sources: SourceInfo[];
  settings: Setting[];
  presets: string[];
  opens?: number; // bytes of a file that a page may send to be touched; absent: none
  timeline?: { length: number }; // s, of a recording that is shown instead of a run
}

/** What is shown of a recording. */
export interface Moment {
  time: number; // s
  playing: boolean;
  speed: number; // s of the recording a second
}

export type NoticeLevel = "info" | "warning" | "fault";

export type FromProgram =
  | Welcome
  | { type: "settings"; values: Record<string, SettingValue> }
  | { type: "devices"; devices: DeviceReport[] }
  | { type: "sources"; sources: SourceReport[]; robot?: string }
  | { type: "notice"; level: NoticeLevel; text: string; share?: number; over?: boolean } // share: of work that takes a while, 0 to 1
  | { type: "record"; on: boolean; file?: string }
  | ({ type: "time" } & Moment)
  | { type: "envelope"; forces: number[] } // N, the largest in equal intervals of the length
  | { type: "lost"; device: number; text: string }
  | { type: "refused"; text: string }
  | { type: "pong"; id: number };

export type ToProgram =
  | { type: "hello"; token: string; points: number }
  | { type: "hand"; device: number; position: Vector; buttons: number; force?: number; eye?: Vector; orientation?: Quaternion; opening?: number }
  | { type: "release"; device: number }
  | { type: "set"; key: string; value: SettingValue }
  | { type: "preset"; name: string }
  | { type: "pause"; on: boolean }
  | { type: "reset"; device?: number } // unset: all
  | { type: "record"; on: boolean }
  | { type: "seek"; time: number }
  | { type: "play"; on: boolean; speed: number }
  | { type: "points"; points: number }
  | { type: "ping"; id: number };

const kTypes = new Set([
  "welcome", "settings", "devices", "sources", "notice", "record", "time", "envelope", "lost", "refused", "pong",
]);

/** A text message; undefined where its type is unknown to this page. Throws SyntaxError. */
export function parseMessage(text: string): FromProgram | undefined {
  const message = JSON.parse(text) as { type?: unknown } | null;
  if (message === null || typeof message.type !== "string" || !kTypes.has(message.type)) {
    return undefined;
  }
  return message as FromProgram;
}
