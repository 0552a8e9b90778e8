// What the next run may be: another scene, or the same one in another unit.

import type { Setting, SettingValue } from "../protocol/messages";
import { byId, make, say } from "./dom";

type Set = (key: string, value: SettingValue) => void;

function buttons(setting: Setting, set: Set): HTMLElement[] {
  return (setting.choices ?? []).map((choice) =>
    make("button", { type: "button", class: "button", "aria-pressed": String(choice === setting.value), click: () => set(setting.key, choice) }, choice));
}

export class NextRun {
  private readonly answered = new Set<string>(); // questions of this visit

  constructor(private readonly set: Set) {
    byId("open-here").addEventListener("click", () => byId("open").click());
  }

  /** `opens`: may another file be opened? */
  begin(settings: readonly Setting[], opens: boolean): void {
    byId("offer").hidden = !opens;
    const scene = settings.find(({ key }) => key === "scene");
    const others = (scene?.choices ?? []).filter((choice) => choice !== scene?.value);
    byId("examples").hidden = others.length === 0;
    byId("examples").replaceChildren("or try ", ...(scene === undefined ? [] : buttons({ ...scene, choices: others }, this.set)));
    this.ask(settings);
  }

  private ask(settings: readonly Setting[]): void {
    const setting = settings.find(({ question }) => question !== undefined && !this.answered.has(question));
    const card = byId("ask");
    card.hidden = setting === undefined;
    if (setting === undefined) return;
    const done = () => {
      this.answered.add(setting.question ?? "");
      this.ask(settings);
    };
    const answer: Set = (key, value) => {
      if (value === setting.value) done();
      else this.set(key, value); // it stays until a run is in that unit: the file may be gone
    };
    const close = make("button", { type: "button", class: "close", "aria-label": "Dismiss", click: done }, "×");
    card.replaceChildren(make("span", {}, setting.question ?? ""), ...buttons(setting, answer), close);
    say(byId("polite"), setting.question ?? "");
  }
}
