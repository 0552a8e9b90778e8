// Who holds the tool, in words, and the buttons around it.

import type { Hand } from "../input/hand";
import type { Keys } from "../input/keys";
import type { PointerInput } from "../input/pointer";
import { hid, type SpaceMouse } from "../input/space_mouse";
import type { Session } from "../model/session";
import type { Rumble } from "../sound/rumble";
import type { World } from "../view/world";
import { byId, make, say } from "./dom";
import { fieldRow, type FieldRow } from "./field";
import { recall, remember } from "../model/memory";
import type { Notices } from "./notices";

const kColours = ["red", "blue", "violet", "purple"]; // --hand-0 and those after it
const kHintTime = 3000; // ms
const kCoarse = matchMedia("(pointer: coarse)");

/** Acts from when a button goes down until it comes up. */
function whileDown(id: string, begin: () => void, end: () => void): void {
  const button = byId(id);
  button.addEventListener("pointerdown", begin);
  button.addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") begin();
  });
  for (const type of ["pointerup", "pointerleave", "pointercancel", "keyup", "blur"]) button.addEventListener(type, end);
  button.addEventListener("contextmenu", (event) => event.preventDefault());
}

export class HoldPanel {
  private held = false;
  private pointer: PointerInput | undefined;
  private onSurface: FieldRow | undefined;

  constructor(
    private readonly session: Session,
    private readonly hand: Hand,
    private readonly world: World,
    depth: (direction: number) => void,
    opening: (direction: number) => void,
  ) {
    byId("take").addEventListener("click", () => {
      this.toggle();
      if (this.hand.held) byId("view").focus({ preventScroll: true }); // for the keys that move it
    });
    whileDown("away", () => depth(1), () => depth(0));
    whileDown("closer", () => depth(-1), () => depth(0));
    whileDown("widen", () => opening(1), () => opening(0));
    whileDown("grip", () => opening(-1), () => opening(0));
    byId("turn").addEventListener("click", () => this.setTurns(this.pointer?.turns === false));
    byId("device").addEventListener("change", () => {
      this.hand.letGo();
      this.session.device = Number(byId<HTMLSelectElement>("device").value);
      this.hand.device = this.session.device;
      this.update();
    });
  }

  begin(): void {
    const devices = this.session.welcome?.devices ?? [];
    byId("device").replaceChildren(
      ...devices.map(({ name }, i) => make("option", { value: i, selected: i === this.session.device }, name)),
    );
    byId("which").hidden = devices.length < 2;
    this.hand.device = this.session.device;
    this.update();
  }

  toggle(): void {
    if (this.hand.held) this.hand.letGo();
    else this.take();
  }

  /** Where the tool is now; false where it cannot be taken. */
  take(): boolean {
    if (this.hand.held) return true;
    const state = this.session.tool?.latest;
    if (!this.takeable() || state === undefined) return false;
    this.hand.take(this.session.device, this.world.tools[this.session.device]!);
    return true;
  }

  update(): void {
    const button = byId<HTMLButtonElement>("take");
    button.disabled = !this.takeable() || this.session.tool?.latest === undefined;
    const held = this.hand.held;
    say(byId("hint"), this.hint());
    if (!this.hand.held) say(byId("take-words"), this.session.tool?.has("taken") ? "Take the tool over" : "Take the tool");
    const shape = this.world.tools[this.session.device]?.shape;
    byId("turn").hidden = shape === undefined;
    byId("view-area").classList.toggle("turns", shape !== undefined);
    for (const id of ["widen", "grip"]) byId(id).hidden = shape?.opens !== true;
    byId("by-itself").hidden = button.disabled || held || this.session.tool?.has("taken") === true;
    byId("tour-offer").hidden = button.disabled || held;
    this.nameDevices();
    if (held === this.held) return;
    this.held = held;
    button.setAttribute("aria-pressed", String(held));
    if (held) say(byId("take-words"), "Release");
    byId("depth").hidden = !held;
    byId("view-area").classList.toggle("held", held);
    say(byId("polite"), held ? "You hold the tool." : "The tool is released.");
  }

  /** Between the surface under the pointer and free motion. */
  toggleFree(): void {
    if (this.pointer !== undefined) this.setFree(!this.pointer.free);
  }

  private setTurns(turns: boolean): void {
    if (this.pointer !== undefined) this.pointer.turns = turns;
    byId("turn").setAttribute("aria-pressed", String(turns));
    this.update();
  }

  private setFree(free: boolean): void {
    this.pointer!.free = free;
    this.onSurface!.show(!free);
    remember("on-surface", !free);
    this.update();
  }

  offer(spaceMouse: SpaceMouse, keys: Keys, notices: Notices, pointer: PointerInput, rumble: Rumble): void {
    this.pointer = pointer;
    const surface = (this.onSurface = fieldRow(
      { key: "on-surface", label: "Pointer touches the surface (M)", kind: "switch", value: true },
      (value) => this.setFree(value !== true),
    ));
    this.setFree(!recall("on-surface", true));
    const text = make("p", { class: "soft" },
      "Mouse, touch and keys move the tool; so do game controllers and 3D mice that the browser supports, " +
      "once you press a button on them.");
    keys.single = recall("single-keys", true);
    const single = fieldRow(
      { key: "single-keys", label: "Single-letter shortcuts", kind: "switch", value: keys.single },
      (value) => remember("single-keys", (keys.single = value === true)),
    );
    rumble.on = recall("rumble", true);
    const shake = fieldRow(
      { key: "rumble", label: "Controller and phone vibrate with the force", kind: "switch", value: rumble.on },
      (value) => remember("rumble", (rumble.on = value === true)),
    );
    const parts: HTMLElement[] = [text, surface.row, shake.row, single.row];
    if (hid() !== undefined) {
      const choose = async () => {
        const name = await spaceMouse.choose();
        if (name !== undefined) notices.add("info", `${name} moves the tool; its first button takes it`);
      };
      const failed = (error: unknown) => notices.add("warning", `cannot open the 3D mouse: ${String(error)}`);
      parts.push(make("button", { type: "button", class: "button", click: () => void choose().catch(failed) },
        "Choose a 3D mouse"));
      void spaceMouse.resume().catch(failed);
    }
    byId("inputs").replaceChildren(...parts);
  }

  private nameDevices(): void {
    [...byId<HTMLSelectElement>("device").options].forEach((option, i) => {
      const status = this.session.devices[i]?.report.status ?? "ok";
      const name = this.session.welcome?.devices[i]?.name ?? "";
      say(option, status === "ok" ? name : `${name} (${status})`);
    });
  }

  /** Can this page take the tool? */
  takeable(): boolean {
    return this.session.open && this.session.welcome?.devices[this.session.device]?.takeable === true;
  }

  private hint(): string {
    const free = this.pointer?.free === true;
    const around = `drag ${kCoarse.matches ? "with two fingers" : "beside it"} to look around`;
    if (performance.now() < (this.pointer?.missed ?? -Infinity) + kHintTime) return `No surface here: nothing was seen; ${around}`;
    if (this.hand.held && this.hand.turned !== undefined) {
      if (this.pointer?.turns === true) return "Drags turn the tool; press the button again to move it";
      if (!kCoarse.matches) return `${free ? "Drag to move it" : "Hold to press"}, with Shift to turn it; wheel for ${free ? "depth" : "more force"}, with Shift to roll it`;
    }
    if (this.hand.held && free) {
      return kCoarse.matches
        ? "One finger moves the tool, two turn the view"
        : "Drag to move it, wheel while dragging for depth; Alt and drag turns the view";
    }
    if (this.hand.held && !kCoarse.matches) return "Hold to press, wheel for more force; Alt and drag turns the view";
    if (!this.session.open || this.session.tool?.latest === undefined) return "";
    if (!this.takeable()) {
      return this.session.tool.report.status === "silent" ? "The device of this tool is not responding" : "A device moves this tool";
    }
    if (!this.hand.held && this.session.tool.has("taken")) return "Another page holds the tool; press on the surface to take it over";
    if (!free) return `Press on the surface to touch it; ${around}`;
    const colour = kColours[this.session.device % kColours.length];
    return `Drag the ${colour} hand to touch` + (kCoarse.matches ? "" : "; drag elsewhere to look around");
  }
}
