// Controls for the settings that `welcome` lists, and the presets.

import type { Session } from "../model/session";
import type { Setting, SettingValue } from "../protocol/messages";
import { byId, make, say } from "./dom";
import { fieldRow, type FieldRow } from "./field";

const kSofter = "currently softer: stiffness rises only with motion in contact; lift and touch again"; // where motors push
const kUnit = "unit."; // of a source
const kLinger = 700; // ms that it stays readable

export class SettingsPanel {
  private readonly rows = new Map<string, FieldRow>();
  private readonly softer = make("p", { class: "soft", role: "status" });
  private until = 0;
  private readonly buttons = new Map<string, HTMLElement>(); // of presets
  private requested: string | undefined; // the preset whose values are still to come
  private chosen: string | undefined; // the preset whose values hold
  private held = ""; // these values

  constructor(
    private readonly set: (key: string, value: SettingValue) => void,
    private readonly preset: (name: string) => void,
  ) {}

  begin(settings: readonly Setting[], presets: readonly string[]): void {
    this.rows.clear();
    for (const setting of settings) {
      this.rows.set(setting.key, fieldRow(setting, (value) => this.set(setting.key, value)));
    }
    this.rows.get("stiffness")?.row.append(this.softer);
    const rows = (units: boolean) =>
      [...this.rows].filter(([key]) => key.startsWith(kUnit) === units).map(([, { row }]) => row);
    byId("settings").replaceChildren(...rows(false));
    byId("units").replaceChildren(...rows(true));
    this.buttons.clear();
    for (const name of presets) {
      const choose = () => this.preset((this.requested = name));
      this.buttons.set(name, make("button", { type: "button", class: "button", "aria-pressed": "false", "data-preset": name, click: choose }, name));
    }
    this.requested = this.chosen = undefined;
    byId("presets").replaceChildren(...this.buttons.values());
  }

  /** Notes where a requested stiffness is not felt yet. */
  watch({ tool, motors }: Session, now: number): void {
    if (motors && tool?.has("softer")) this.until = now + kLinger;
    say(this.softer, now < this.until ? kSofter : "");
  }

  show(values: ReadonlyMap<string, SettingValue>): void {
    for (const [key, value] of values) this.rows.get(key)?.show(value);
    this.markPreset(JSON.stringify([...values]));
  }

  /** A preset is chosen until a value is no longer as it set it. */
  private markPreset(values: string): void {
    if (this.requested !== undefined) this.chosen = this.requested;
    else if (values !== this.held) this.chosen = undefined;
    this.requested = undefined;
    this.held = values;
    for (const [name, button] of this.buttons) button.setAttribute("aria-pressed", String(name === this.chosen));
  }
}
