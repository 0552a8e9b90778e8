// The bar: pause, reset, record, open, sound, picture, link, help. Which panels are shown is panels.ts's.

import type { Session } from "../model/session";
import type { End } from "../protocol/end";
import { writeLink } from "../protocol/link";
import type { ToProgram, Welcome } from "../protocol/messages";
import type { Sound } from "../sound/sound";
import type { World } from "../view/world";
import { byId, icon, say } from "./dom";
import type { Notices } from "./notices";
import { whole } from "./numbers";
import { Opening } from "./opening";
import type { Panels } from "./panels";

const kCounts = / \(mesh of [^)]*\)/g; // what a scene was made of
const kKept = 0.95; // of its best rate, below which the servo is late

export class Bar {
  private isRecording = false;
  private delay = NaN;
  private best = 0; // steps a second, the most so far
  private readonly opening: Opening;

  constructor(
    private readonly session: Session,
    private readonly world: World,
    private readonly sound: Sound,
    private readonly notices: Notices,
    private readonly panels: Panels,
    private readonly end: End,
    private readonly send: (message: ToProgram) => void,
  ) {
    const click = (id: string, act: () => unknown) => byId(id).addEventListener("click", () => void act());
    this.opening = new Opening(end, notices);
    click("pause", () => this.pause());
    click("reset", () => this.reset());
    click("record", () => this.send({ type: "record", on: !this.isRecording }));
    click("sound", () => this.toggleSound());
    click("picture", () => this.savePicture());
    click("share", () => this.share());
    click("help", () => this.help());
    click("fit", () => this.world.followTool(undefined));
    click("follow", () => this.follow());
    click("upright", () => this.world.turnUpright());
  }

  begin(welcome: Welcome): void {
    byId("scene").title = welcome.scene;
    this.nameScene();
    this.best = 0;
    this.opening.begin(welcome.opens);
    document.title = `${welcome.scene} – palpate`;
    if (this.session.recorded) say(byId("link-words"), "replay");
    this.showRecording(false);
  }

  /** The buttons show the state that the program reports: they may be pressed elsewhere. */
  update(): void {
    this.nameScene();
    const paused = this.session.tool?.has("paused") ?? false;
    this.press("pause", paused, paused ? "play" : "pause", paused ? "Resume" : "Pause");
    byId("pause").classList.toggle("needed", paused || this.session.motors); // on the simple page
    byId("reset").classList.toggle("needed", this.session.tool?.has("fault") ?? false);
    byId("follow").setAttribute("aria-pressed", String(this.world.followed !== undefined));
    const open = byId("link-state").dataset["phase"] === "open";
    const rate = this.session.tool?.latest?.rate;
    if (open && rate !== undefined && !this.session.recorded) this.showRate(rate);
    const delay = Number.isNaN(this.delay) ? "" : `; latency ${(1000 * this.delay).toFixed(1)} ms`;
    const late = byId("link-state").classList.contains("late") ? `; the servo does not keep its rate: ${this.end.here ? "this machine is busy" : "see palpate doctor"}` : "";
    byId("link-state").title = `connected${late}${delay}; a frame every ${this.world.stage.frameTime.toFixed(0)} ms`;
  }

  private nameScene(): void {
    const scene = this.session.welcome?.scene ?? "";
    say(byId("scene"), this.panels.all ? scene : scene.replace(kCounts, ""));
  }

  private showRate(rate: number): void {
    this.best = Math.max(this.best, rate);
    const late = rate < kKept * this.best;
    const simple = !this.panels.all && !late;
    say(byId("link-words"), simple ? "connected" : `${whole(rate)} steps/s${late ? ": late" : ""}`);
    byId("link-state").classList.toggle("late", late);
  }

  pause(): void {
    if (this.session.recorded) return;
    this.send({ type: "pause", on: !(this.session.tool?.has("paused") ?? false) });
  }

  reset(): void {
    if (!this.session.recorded) this.send({ type: "reset" });
  }

  recording(on: boolean, file: string | undefined): void {
    if (on !== this.isRecording) this.notices.add("info", on ? `recording to ${file ?? "a file"}` : `recorded ${file ?? ""}`);
    this.showRecording(on);
  }

  follow(): void {
    this.world.followTool(this.world.followed === undefined ? this.session.device : undefined);
  }

  roundTrip(seconds: number): void {
    this.delay = seconds;
  }

  help(): void {
    byId<HTMLDialogElement>("keys").showModal();
  }

  private showRecording(on: boolean): void {
    this.isRecording = on;
    this.press("record", on, "record", on ? "Recording" : "Record");
  }

  private press(id: string, on: boolean, picture: string, words: string): void {
    const button = byId(id);
    button.setAttribute("aria-pressed", String(on));
    icon(button, picture);
    say(button.querySelector("span")!, words);
  }

  private async toggleSound(): Promise<void> {
    const requested = !this.sound.on;
    const on = await this.sound.toggle();
    if (requested && !on) this.notices.add("warning", "the browser finds no audio device");
    byId("sound").setAttribute("aria-pressed", String(on));
    icon(byId("sound"), on ? "sound" : "mute");
  }

  private async savePicture(): Promise<void> {
    const felt = this.session.tool?.latest === undefined ? "" : `${byId("force").textContent} N, ${byId("touch").textContent}`;
    const picture = await this.world.stage.picture(felt, this.world.scaleBar);
    if (picture === null) return;
    const address = URL.createObjectURL(picture);
    const link = document.createElement("a");
    const time = new Date().toISOString().slice(0, 19).replace(/:/g, "-");
    const name = (this.session.welcome?.scene ?? "scene").replace(/[^\w.-]+/g, "_");
    link.href = address;
    link.download = `palpate_${name}_${time}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  }

  private async share(): Promise<void> {
    const token = this.end.here ? "" : this.end.token;
    const address = location.href.replace(/#.*/, "") + writeLink(token, this.session.values, this.world.framing.view);
    try {
      await navigator.clipboard.writeText(address);
      this.notices.add("info", `copied a link with these settings and this view${token === "" ? "" : "; it contains the token, so share it with care"}`);
    } catch {
      const field = byId<HTMLInputElement>("share-link");
      field.value = address;
      byId("share-token").hidden = token === "";
      byId<HTMLDialogElement>("share-dialog").showModal();
      field.select();
    }
  }
}
