// What the page draws, and how: its own affair, kept in this browser.

import type { Setting, SettingValue } from "../protocol/messages";
import { kColourings, type Colouring } from "../view/cloud";
import { kFirstLook, type Look } from "../view/world";
import { byId } from "./dom";
import { fieldRow, type FieldRow } from "./field";
import { whole } from "./numbers";
import { remember, recall } from "../model/memory";

const kPointCounts = [10_000, 30_000, 60_000, 100_000, 200_000, 300_000, 1_000_000, 3_000_000];

const kColouringNames: Record<Colouring, string> = {
  source: "source", height: "height", normal: "normal", age: "age", own: "automatic", trust: "trust",
};

function switchOf(key: keyof Look, label: string, value: boolean): Setting {
  return { key, label, kind: "switch", value };
}

export class LookPanel {
  readonly look: Look;
  points: number;
  private readonly fields: FieldRow[] = [];

  constructor(private readonly changed: () => void, private readonly counted: () => void) {
    this.look = { ...kFirstLook, ...recall<Partial<Look>>("look", {}) };
    if (!kColourings.includes(this.look.colouring)) this.look.colouring = kFirstLook.colouring;
    const small = matchMedia("(max-width: 50rem), (pointer: coarse)").matches;
    this.points = recall("points", small ? 60_000 : 200_000);
    this.build();
  }

  private build(): void {
    const names = kColourings.map((colouring) => kColouringNames[colouring]);
    this.add({
      key: "colouring", label: "Colour by", kind: "choice", choices: names,
      value: kColouringNames[this.look.colouring],
    }, (value) => (this.look.colouring = kColourings[names.indexOf(String(value))] ?? "own"));
    this.add({
      key: "disc", label: "Point size", unit: "× R", kind: "number", least: 0.2, most: 2,
      step: 0.1, value: this.look.disc,
    }, (value) => (this.look.disc = Number(value)));
    this.add({
      key: "count", label: "Maximum points", kind: "choice", choices: kPointCounts.map(whole),
      value: whole(this.points),
    }, (value) => this.choosePoints(kPointCounts.find((count) => whole(count) === value) ?? this.points));
    for (const [key, label] of [
      ["points", "Points"], ["surface", "Surface at the proxy"], ["support", "Support radius"],
      ["cameras", "Cameras"], ["trail", "Trail"],
    ] as const) {
      this.add(switchOf(key, label, this.look[key]), (value) => (this.look[key] = value === true));
    }
    byId("look").replaceChildren(...this.fields.map(({ row }) => row));
  }

  private add(setting: Setting, take: (value: SettingValue) => void): void {
    this.fields.push(fieldRow(setting, (value) => {
      take(value);
      remember("look", this.look);
      this.changed();
    }));
  }

  private choosePoints(points: number): void {
    this.points = points;
    remember("points", points);
    this.counted();
  }
}
