// Controls for what `welcome` says can be set, and the presets.

import type { Setting, SettingValue } from "../protocol/messages";
import { byId, make } from "./dom";
import { fieldRow, type FieldRow } from "./field";

export class SettingsPanel {
  private readonly rows = new Map<string, FieldRow>();

  constructor(
    private readonly set: (key: string, value: SettingValue) => void,
    private readonly preset: (name: string) => void,
  ) {}

  begin(settings: readonly Setting[], presets: readonly string[]): void {
    this.rows.clear();
    for (const setting of settings) {
      this.rows.set(setting.key, fieldRow(setting, (value) => this.set(setting.key, value)));
    }
    byId("settings").replaceChildren(...[...this.rows.values()].map(({ row }) => row));
    byId("presets").replaceChildren(
      ...presets.map((name) =>
        make("button", { type: "button", class: "button", click: () => this.preset(name) }, name),
      ),
    );
  }

  show(values: ReadonlyMap<string, SettingValue>): void {
    for (const [key, value] of values) this.rows.get(key)?.show(value);
  }
}
