// Controls for what `welcome` says can be set, and the presets.

import type { DeviceHistory } from "../model/session";
import type { Setting, SettingValue } from "../protocol/messages";
import { byId, make, say } from "./dom";
import { fieldRow, type FieldRow } from "./field";

const kSofter = "currently softer: stiffness rises only with motion in contact; lift and touch again";
const kLinger = 700; // ms that it stays readable

export class SettingsPanel {
  private readonly rows = new Map<string, FieldRow>();
  private readonly softer = make("p", { class: "soft", role: "status" });
  private until = 0;

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
    byId("settings").replaceChildren(...[...this.rows.values()].map(({ row }) => row));
    byId("presets").replaceChildren(
      ...presets.map((name) =>
        make("button", { type: "button", class: "button", click: () => this.preset(name) }, name),
      ),
    );
  }

  /** Says where what is asked for is not felt yet. */
  watch(tool: DeviceHistory | undefined, now: number): void {
    if (tool?.has("softer")) this.until = now + kLinger;
    say(this.softer, now < this.until ? kSofter : "");
  }

  show(values: ReadonlyMap<string, SettingValue>): void {
    for (const [key, value] of values) this.rows.get(key)?.show(value);
  }
}
