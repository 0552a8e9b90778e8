// The fake program behind the socket: settings, messages of pages, what is sent when.

import { encodeCloud, encodePast, encodeState, encodeTool } from "./encode.mjs";
import { kCameras, lookAtOrigin, randomFrom, seenPoints } from "./scene.mjs";
import { Servo } from "./servo.mjs";
import { patchAround } from "./surface.mjs";

const kStateHz = 60;
const kCloudHz = 10;
const kClouds = 4; // frames that are played in turn
const kOther = [0.1, 0.1, 0.08]; // where the second hand stands, m

export const settings = () => [
  { key: "stiffness", label: "Stiffness", unit: "N/m", kind: "number", least: 10, most: 2000, step: 10, value: 500 },
  { key: "friction", label: "Friction", unit: "", kind: "number", least: 0, most: 1, step: 0.05, value: 0.2 },
  { key: "bound", label: "Force, at most", unit: "N", kind: "number", least: 0.5, most: 20, step: 0.1, value: 6 },
  { key: "field", label: "Surface", unit: "", kind: "choice", choices: ["balanced", "pointset", "metaball"], value: "balanced" },
  { key: "policy", label: "Time", unit: "", kind: "choice", choices: ["morph", "replace", "average", "crossfade"], value: "morph" },
  { key: "texture", label: "Texture", unit: "mm", kind: "number", least: 0, most: 1, step: 0.01, value: 0 },
  { key: "wavelength", label: "Wavelength", unit: "mm", kind: "number", least: 0.1, most: 10, step: 0.1, value: 4 },
  { key: "grain", label: "Grain", unit: "", kind: "switch", value: false }, // shakes the force
];
/** What another run begins with: of a mesh whose unit is guessed. */
export const kAnew = [
  { key: "scene", label: "Scene", kind: "choice", choices: ["rabbit", "desk", "room", "cube"], value: "cube", restarts: true },
  { key: "unit.cube", label: "Unit of cube", kind: "choice", choices: ["mm", "cm", "m", "inch", "ft"], value: "mm", restarts: true, question: "cube: 20 x 20 x 20 mm?" },
];
/** As palpate has them, of a run that begins with 500 N/m. */
export const kPresets = {
  default: { stiffness: 500, friction: 0.2, field: "balanced", texture: 0, grain: false },
  paper: { stiffness: 300, field: "pointset", policy: "average" },
  fur: { stiffness: 150, friction: 0.5, texture: 0.03, wavelength: 3 },
  wood: { stiffness: 600, friction: 0.35, texture: 0.06, wavelength: 2 },
  ice: { stiffness: 1200, friction: 0.02, texture: 0 },
  rubber: { stiffness: 200, friction: 1, texture: 0 },
};

export class FakeProgram {
  clients = new Set();
  received = []; // for tests
  settings = settings();
  recording = false;
  playing = 0;
  near = false;
  holder; // the client whose hand moves the tool

  constructor({ points = 30000, token, still = false, silent, length, anew = false, box }) {
    this.token = token;
    this.run = "first";
    this.opens = anew ? 2 ** 30 : undefined; // bytes
    if (anew) this.settings.push(...kAnew.map((one) => ({ ...one })));
    this.box = box; // m, of a tool that turns
    this.motors = false; // does the tool have them? Then no page takes it
    this.length = length; // s, of a recording that is shown; undefined: a run
    this.moment = { time: 0, playing: false, speed: 1 };
    this.still = still;
    this.silent = silent; // why a second hand, which no page can take, is; undefined later: it is heard
    this.hands = silent === undefined ? 1 : 2;
    const random = randomFrom(7);
    this.servo = new Servo(random);
    this.frames = kCameras.map((camera) =>
      Array.from({ length: kClouds }, () => seenPoints(camera, Math.round(points / kCameras.length), random)),
    );
    this.encoded = new Map();
    this.timers = [
      setInterval(() => this.tellState(), 1000 / kStateHz),
      setInterval(() => this.tellClouds(), 1000 / kCloudHz),
      setInterval(() => this.tellSources(), 500),
      setInterval(() => this.tellDevices(), 500),
    ];
    this.last = performance.now();
  }

  close() {
    this.timers.forEach(clearInterval);
  }

  /** Sends what a client is ready to take; otherwise leaves it out. */
  broadcast(data) {
    for (const client of this.clients) {
      if (client.welcome && client.socket.bufferedAmount < 2_000_000) client.socket.send(data);
    }
  }

  tell(message) {
    this.broadcast(JSON.stringify(message));
  }

  tellState() {
    const now = performance.now();
    this.servo.advance(Math.min(0.1, (now - this.last) / 1000));
    this.last = now;
    const state = this.servo.report();
    if (this.box !== undefined) state.tool = this.servo.tool;
    if (this.length === undefined) this.broadcast(encodeState(state));
    else this.tellMoment(state);
    if (this.hands > 1) this.broadcast(encodeState({ ...state, device: 1, flags: 0, hip: kOther, proxy: kOther, force: [0, 0, 0], samples: [] }));
  }

  /** A recording in which the hand goes along x. */
  tellMoment(state) {
    const { moment } = this;
    if (moment.playing) moment.time = Math.min(this.length, moment.time + moment.speed / kStateHz);
    const place = [0.01 * moment.time, 0, 0.05];
    this.broadcast(encodeState({ ...state, time: 100 + moment.time, hip: place, proxy: place, samples: [[1, 0, 0]], interval: 1e-3 }));
    this.tell({ type: "time", ...moment });
  }

  tellPast() {
    const steps = Array.from({ length: 1000 }, (_, i) => [1e-3 * (i - 999), 1, 0, 0]);
    this.broadcast(encodePast(0, 100 + this.moment.time, steps));
  }

  tellClouds() {
    this.playing += 1;
    for (const client of this.clients) {
      if (!client.welcome || client.points === 0 || client.socket.bufferedAmount > 2_000_000) continue;
      if (this.still && client.sent === client.points) continue;
      client.sent = client.points;
      for (let source = 0; source < kCameras.length; source += 1) {
        client.socket.send(this.cloud(source, client.points));
      }
    }
    if (this.servo.contact || this.near) this.broadcast(patchAround(this.servo.contact, 0.022));
    this.near = this.servo.contact !== undefined;
  }

  cloud(source, most) {
    const frame = this.frames[source][this.playing % kClouds];
    const count = Math.min(frame.length, Math.floor(most / kCameras.length));
    const key = `${source}/${this.playing % kClouds}/${count}`;
    if (!this.encoded.has(key)) this.encoded.set(key, encodeCloud(source, 0, frame.slice(0, count), this.still));
    const bytes = this.encoded.get(key);
    bytes.writeDoubleLE(this.servo.time - 0.03, 8);
    return bytes;
  }

  tellDevices() {
    const devices = [{ status: "ok" }];
    if (this.hands > 1) devices.push(this.silent === undefined ? { status: "ok" } : { status: "silent", reason: this.silent });
    this.tell({ type: "devices", devices });
  }

  tellSources() {
    if (this.still) {
      const sources = kCameras.map(({ name }, i) => ({ name, phase: "still", points: this.frames[i][0].length, rate: 0, dropped: 0 }));
      return this.tell({ type: "sources", sources });
    }
    const wobble = Math.sin(this.servo.time * 0.7);
    this.tell({
      type: "sources",
      sources: kCameras.map((camera, i) => ({
        name: camera.name, phase: "running", rate: 29.6 + 0.5 * wobble, points: this.frames[i][0].length,
        latency: 0.021 + 0.003 * wobble + 0.004 * i, age: 0.041 + 0.006 * Math.cos(this.servo.time + i),
        dropped: Math.floor(this.servo.time / 9), disagreement: 0.0012,
        pose: { position: camera.eye, quaternion: lookAtOrigin(camera.eye) }, frustum: [0.55, 0.41, 0.9],
      })),
    });
  }

  welcome() {
    return {
      type: "welcome", version: 2, run: this.run, ...(this.opens === undefined ? {} : { opens: this.opens }), scene: "table with a ball", origin: [0, 0, 0], up: [0, 0, 1], radius: 0.35,
      devices: [{ name: "simulated", takeable: this.length === undefined && !this.motors }, ...(this.hands > 1 ? [{ name: "remote", takeable: false }] : [])], sources: kCameras.map(({ name }) => ({ name, camera: !this.still })),
      ...(this.length === undefined ? { settings: this.settings, presets: Object.keys(kPresets) }
        : { settings: [], presets: [], timeline: { length: this.length } }),
    };
  }

  /** The next run, on the same connection. */
  beginAnew() {
    this.run += " and again";
    this.tell(this.welcome());
  }

  set(key, value) {
    const setting = this.settings.find((one) => one.key === key);
    if (setting === undefined) return `unknown setting ${key}`;
    if (setting.kind === "number" && !(value >= setting.least && value <= setting.most)) {
      return `${key} = ${value} is not between ${setting.least} and ${setting.most} ${setting.unit}`;
    }
    if (setting.kind === "choice" && !setting.choices.includes(value)) return `${key} cannot be ${value}`;
    setting.value = value;
    this.servo.stiffness = this.settings.find((one) => one.key === "stiffness").value;
    this.servo.bound = this.settings.find((one) => one.key === "bound").value;
    this.servo.texture = this.settings.find((one) => one.key === "grain").value ? 1 : 0;
    return undefined;
  }

  tellSettings() {
    this.tell({ type: "settings", values: Object.fromEntries(this.settings.map(({ key, value }) => [key, value])) });
  }

  /** A message of a page. */
  take(client, text) {
    const message = JSON.parse(text);
    this.received.push(message);
    const answer = (reply) => client.socket.send(JSON.stringify(reply));
    if (!client.welcome && message.type !== "hello") return answer({ type: "refused", text: "send hello first" });
    const act = {
      hello: () => this.hello(client, message),
      hand: () => this.move(client, message),
      release: () => this.release(client),
      set: () => this.changed(answer, this.set(message.key, message.value)),
      preset: () => Object.entries(kPresets[message.name] ?? {}).forEach(([k, v]) => this.set(k, v)) ?? this.tellSettings(),
      pause: () => (this.servo.paused = message.on),
      reset: () => this.tell({ type: "notice", level: "info", text: "reset: the proxy is at the hand" }),
      record: () => this.record(message.on),
      seek: () => Object.assign(this.moment, { time: message.time }) && this.tellPast(),
      play: () => Object.assign(this.moment, { playing: message.on, speed: message.speed }),
      points: () => (client.points = message.points),
      ping: () => answer({ type: "pong", id: message.id }),
    }[message.type];
    if (act === undefined) answer({ type: "refused", text: `a message of type ${message.type} is not known` });
    else act();
  }

  hello(client, { token, points }) {
    if (token !== this.token) return client.socket.close(1008, "wrong token");
    Object.assign(client, { welcome: true, points });
    client.socket.send(JSON.stringify(this.welcome()));
    if (this.box !== undefined) client.socket.send(encodeTool(0, this.box));
    if (this.length === undefined) return;
    const forces = Array.from({ length: 100 }, (_, i) => (i > 40 && i < 60 ? 2 : 0));
    client.socket.send(JSON.stringify({ type: "envelope", forces }));
  }

  move(client, { position: hand, orientation }) {
    if (this.holder !== undefined && this.holder !== client) {
      this.holder.socket.send(JSON.stringify({ type: "lost", device: 0, text: "another page took the tool" }));
    }
    this.holder = client;
    Object.assign(this.servo, { taken: true, hand });
    if (orientation !== undefined) Object.assign(this.servo.tool, { hand: orientation, proxy: orientation });
  }

  /** A client let go, or is gone. */
  release(client) {
    if (this.holder !== client) return;
    this.holder = undefined;
    this.servo.taken = false;
  }

  changed(answer, refusal) {
    if (refusal !== undefined) answer({ type: "refused", text: refusal });
    else this.tellSettings();
  }

  record(on) {
    this.recording = on;
    this.tell({ type: "record", on, file: "palpate-20261120-101112.mcap" });
  }
}
