// Connects the components: passes the program's messages to them, and the person's actions to the program.

import { Hand } from "./input/hand";
import { Input } from "./input/input";
import { Keys } from "./input/keys";
import { PointerInput } from "./input/pointer";
import { SpaceMouse } from "./input/space_mouse";
import { Stroke } from "./input/stroke";
import { Tour } from "./input/tour";
import { Session } from "./model/session";
import { Bar } from "./panel/bar";
import { Devices } from "./panel/devices";
import { byId, say } from "./panel/dom";
import { HoldPanel } from "./panel/hold";
import { LookPanel } from "./panel/look";
import { NextRun } from "./panel/next_run";
import { Notices } from "./panel/notices";
import { Overlay } from "./panel/overlay";
import type { Panels } from "./panel/panels";
import { Plots } from "./panel/plots";
import { Readout } from "./panel/readout";
import { SettingsPanel } from "./panel/settings";
import { SourcesPanel } from "./panel/sources";
import { Status } from "./panel/status";
import { Tags } from "./panel/tags";
import { TimeLinePanel } from "./panel/time_line";
import { Backoff } from "./protocol/backoff";
import { Connection } from "./protocol/connection";
import { Kind, type BinaryMessage } from "./protocol/decode";
import type { End } from "./protocol/end";
import { applyLink, writeLink, type Link } from "./protocol/link";
import { kVersion, type FromProgram, type SettingValue, type ToProgram, type Welcome } from "./protocol/messages";
import { Rumble } from "./sound/rumble";
import { Sound } from "./sound/sound";
import { surfaceOf } from "./sound/surface";
import type { Graphics } from "./view/graphics";
import { World } from "./view/world";

const kPlotInterval = 50; // ms
const kCalm = 3000; // ms from the start, in which late frames are listed only
const kCalmInterval = 250; // ms, where less motion is requested

export class App {
  private readonly session = new Session();
  private readonly notices = new Notices(() => !this.panels.all);
  private readonly devices = new Devices(this.session, this.notices);
  private readonly sound = new Sound();
  private readonly rumble = new Rumble();
  private readonly readout = new Readout();
  private readonly world: World;
  private readonly overlay: Overlay;
  private readonly tags: Tags;
  private readonly plots = new Plots(this.session);
  private readonly sources = new SourcesPanel();
  private readonly settings: SettingsPanel;
  private readonly nextRun: NextRun;
  private readonly look: LookPanel;
  private readonly status: Status;
  private readonly hand: Hand;
  private readonly stroke: Stroke;
  private readonly tour: Tour;
  private readonly hold: HoldPanel;
  private readonly bar: Bar;
  private readonly keys: Keys;
  private readonly timeLine: TimeLinePanel;
  private readonly input: Input;
  private readonly pointer: PointerInput;
  private readonly connection: Connection;
  private readonly plotInterval: number;
  private plotted = 0;
  private calmUntil = 0; // ms: a start has its own troubles, which pass
  private run: string | undefined;
  private linked = true; // what the link requests is still to be set

  constructor(private readonly link: Link, private readonly end: End, graphics: Graphics, private readonly panels: Panels) {
    const send = (message: ToProgram) => this.connection.send(message);
    this.world = new World(byId<HTMLCanvasElement>("view"), graphics);
    this.overlay = new Overlay(this.world);
    this.tags = new Tags(this.world);
    const set = (key: string, value: SettingValue) => void send({ type: "set", key, value });
    this.settings = new SettingsPanel(set, (name) => send({ type: "preset", name }));
    this.nextRun = new NextRun(set);
    this.look = new LookPanel(() => this.relook(), () => this.sendPoints());
    this.hand = new Hand(send, () => this.holdChanged());
    this.stroke = new Stroke(this.world, this.hand, () => send({ type: "reset", device: this.hand.device }));
    this.hold = new HoldPanel(this.session, this.hand, this.world, (depth) => (this.input.depth = depth),
      (opening) => (this.input.opening = opening));
    const take = () => this.hold.take();
    this.tour = new Tour(this.session, this.hand, this.stroke, take, send, (words) => say(byId("tour"), words));
    this.bar = new Bar(this.session, this.world, this.sound, this.notices, panels, end, send);
    this.timeLine = new TimeLinePanel(send);
    const keys = (this.keys = new Keys({
      toggleTool: () => this.hold.toggle(),
      toggleFree: () => this.hold.toggleFree(),
      letGo: () => this.hand.letGo(),
      togglePause: () => this.bar.pause(),
      reset: () => this.bar.reset(),
      fit: () => this.world.followTool(undefined),
      follow: () => this.bar.follow(),
      turnUpright: () => this.world.turnUpright(),
      help: () => this.bar.help(),
      freeze: () => this.freeze(),
      togglePanels: () => panels.toggle(),
      sayForce: () => (byId("polite").textContent = this.readout.sentence(this.session.tool)),
    }));
    const spaceMouse = new SpaceMouse();
    this.input = new Input(this.world, this.hand, keys, spaceMouse, this.stroke, take);
    this.pointer = new PointerInput(byId("view-area"), byId<HTMLCanvasElement>("view"), this.world, this.hand,
      this.stroke, () => this.hold.takeable(), take);
    this.hold.offer(spaceMouse, keys, this.notices, this.pointer, this.rumble);
    this.status = new Status(() => this.connection.open());
    this.connection = new Connection(
      end,
      () => this.drawn(),
      new Backoff(Math.random),
      {
        link: (state) => {
          this.session.open = state.phase === "open";
          if (!this.session.open) this.hand.letGo();
          this.status.show(state);
          this.hold.update();
        },
        message: (message) => this.take(message),
        binary: (message) => this.takeBinary(message),
        garbled: (text) => this.notices.add("warning", `invalid message from the program (${text})`),
      },
    );
    this.plotInterval = matchMedia("(prefers-reduced-motion: reduce)").matches ? kCalmInterval : kPlotInterval;
    this.watchPage();
  }

  start(): void {
    this.relook();
    this.world.start((now) => this.frame(now));
    if (this.end.token === "") this.status.withoutToken();
    else this.connection.open();
  }

  private holdChanged(): void {
    if (!this.hand.held) this.stroke.rest();
    this.hold.update();
  }

  /** A page that nobody sees draws nothing. */
  private drawn(): number {
    return document.hidden ? 0 : this.look.points;
  }

  private sendPoints(): void {
    this.connection.send({ type: "points", points: this.drawn() });
  }

  private take(message: FromProgram): void {
    switch (message.type) {
      case "welcome":
        return this.welcome(message);
      case "settings":
        for (const [key, value] of Object.entries(message.values)) this.session.values.set(key, value);
        return this.settings.show(this.session.values);
      case "devices":
        return this.devices.take(message.devices);
      case "sources":
        message.sources.forEach((report, i) => this.session.sources[i]?.take(report, performance.now()));
        this.world.takeSources(message.sources);
        return this.sources.update(message.robot);
      case "notice":
        if (message.over === true) return this.notices.takeBack(message.text);
        return this.notices.add(message.level, message.text, message.share, this.passes(message.text));
      case "record":
        return this.bar.recording(message.on, message.file);
      case "time":
        return this.timeLine.take(message);
      case "envelope":
        return this.timeLine.takeEnvelope(message.forces);
      case "lost":
        return this.lose(message.device, message.text);
      case "refused":
        this.settings.show(this.session.values);
        return this.notices.add("warning", message.text);
      case "pong":
        return this.bar.roundTrip(this.connection.roundTrip);
    }
  }

  /** A camera that is late while the page and the program start is not worth a card. */
  private passes(text: string): boolean {
    return performance.now() < this.calmUntil && text.includes(": no frame for ");
  }

  /** The program waits for a `release`, held or not: what this page sent of its hand may still be in transit. */
  private lose(device: number, why: string): void {
    if (this.hand.held && device === this.hand.device) this.hand.letGo();
    else this.connection.send({ type: "release", device });
    this.notices.add("info", why);
  }

  private welcome(welcome: Welcome): void {
    const first = this.run === undefined;
    const again = this.run === welcome.run;
    this.run = welcome.run;
    if (welcome.version !== kVersion) {
      this.notices.add("warning", `the program uses protocol version ${welcome.version}, this page ${kVersion}: reload the page`);
    }
    this.session.begin(welcome);
    this.notices.begin();
    this.world.begin(welcome, again);
    this.settings.begin(welcome.settings, welcome.presets);
    this.nextRun.begin(welcome.settings, welcome.opens !== undefined);
    this.sources.begin(this.session.sources, () => this.relook());
    this.plots.begin();
    this.hold.begin();
    this.tags.begin(welcome);
    this.bar.begin(welcome);
    this.timeLine.begin(welcome.timeline?.length);
    this.keys.timeLine = this.session.recorded ? this.timeLine : undefined;
    this.relook();
    if (again) this.tour.putBack();
    else this.tour.forget();
    if (first) this.calmUntil = performance.now() + kCalm;
    if (!again && this.session.recorded) this.panels.show(true);
    if (again || !this.linked) return; // a new connection finds the program as it is
    const set = (key: string, value: SettingValue) => this.connection.send({ type: "set", key, value });
    if (this.link.view !== undefined) this.world.ask(this.link.view);
    this.linked = applyLink(this.link, welcome, set, (text) => this.notices.add("warning", text));
    if (!this.linked) history.replaceState(null, "", writeLink(this.link.token, [])); // not again when it is loaded again
  }

  private takeBinary(message: BinaryMessage): void {
    if (message.kind === Kind.cloud) {
      const source = this.session.sources[message.source];
      if (source === undefined) return;
      source.takeCloud(message);
      this.world.takeCloud(message);
    } else if (message.kind === Kind.surface) {
      this.world.takeSurface(message);
    } else if (message.kind === Kind.tool) {
      this.world.takeTool(message);
    } else if (message.kind === Kind.past) {
      this.session.devices[message.device]?.takePast(message);
    } else {
      const tool = this.session.devices[message.device];
      if (tool === undefined) return;
      const now = performance.now();
      tool.take(message, now);
      this.world.takeState(message);
      if (message.device === this.hand.device) this.stroke.update(now);
      if (message.device !== this.session.device) return;
      this.readout.begin(this.session.welcome?.devices[message.device]?.scale ?? 1, this.session.motors);
      this.readout.note(tool, now, this.stroke.nothing);
      this.sound.play(message, surfaceOf(this.session.welcome?.settings ?? [], this.session.values));
      if (this.hand.held) this.rumble.feel(message, now);
    }
  }

  /** Before every picture. */
  private frame(now: number): void {
    this.input.update(now);
    this.tour.update(now);
    this.overlay.update();
    this.tags.update(this.session.device);
    if (now - this.plotted < this.plotInterval) return;
    this.plotted = now;
    this.readout.update(this.session.tool, now, this.world.tools[this.session.device]?.height, Number(this.session.values.get("stiffness")));
    this.settings.watch(this.session, now);
    this.bar.update();
    this.hold.update();
    this.plots.update(now, this.world.stage.slow);
  }

  private relook(): void {
    this.world.look = this.look.look;
    this.world.visible = this.session.sources.map((source) => source.visible);
    this.world.stage.request();
  }

  private freeze(): void {
    if (!this.panels.all) return; // nobody would see why plots stand still
    this.plots.frozen = !this.plots.frozen;
    byId("freeze").setAttribute("aria-pressed", String(this.plots.frozen));
  }

  private watchPage(): void {
    byId("freeze").addEventListener("click", () => this.freeze());
    for (const id of ["tour-start", "tour-offer"]) {
      byId(id).addEventListener("click", () => {
        if (!this.tour.start(performance.now())) this.notices.add("warning", "no tour: the view shows nothing to touch, or the tool cannot be taken");
      });
    }
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.world.retint();
      this.plots.redraw();
      this.timeLine.draw();
    });
    document.addEventListener("visibilitychange", () => {
      if (document.hidden) this.tour.stop();
      if (document.hidden) this.hand.letGo();
      this.sendPoints();
    });
  }
}
