// Which panels are shown: the simple page, or all of them. An attribute of the body stores it; styles/simple.css hides by it.

import { recall, remember } from "../model/memory";
import { byId, icon, say } from "./dom";

type Shown = "simple" | "all";

export class Panels {
  /** `wanted`: this visit needs all, whatever was chosen last. */
  constructor(wanted: boolean) {
    this.show(wanted || recall<Shown>("panels", "simple") === "all");
    byId("panels").addEventListener("click", () => this.toggle());
    for (const tab of document.querySelectorAll<HTMLElement>(".tabs [data-tab]")) {
      tab.addEventListener("click", () => this.openTab(tab.dataset["tab"] ?? "force"));
    }
  }

  get all(): boolean {
    return document.body.dataset["panels"] === "all";
  }

  /** The person's choice, which the browser keeps. */
  toggle(): void {
    this.show(!this.all);
    remember("panels", this.all ? "all" : "simple");
    say(byId("polite"), this.all ? "All panels are shown." : "The simple page is shown.");
  }

  show(all: boolean): void {
    const focused = document.activeElement as HTMLElement | null;
    document.body.dataset["panels"] = all ? "all" : "simple";
    if (all) byId("settings").before(byId("presets"));
    else byId("grips").before(byId("presets"));
    const button = byId("panels");
    button.setAttribute("aria-pressed", String(all));
    button.title = all ? "Simple: hide the panels (A)" : "All panels (A)";
    icon(button, all ? "simple" : "panels");
    say(button.querySelector("span")!, all ? "Simple" : "All panels");
    this.keepFocus(focused);
  }

  /** What was moved loses the focus, and so does what is hidden: the view takes that. */
  private keepFocus(focused: HTMLElement | null): void {
    if (focused === null || focused === document.body) return;
    const hidden = focused.getClientRects().length === 0;
    (hidden ? byId("view") : focused).focus({ preventScroll: true });
  }

  private openTab(name: string): void {
    document.body.dataset["tab"] = name;
    for (const tab of document.querySelectorAll<HTMLElement>(".tabs [data-tab]")) {
      tab.setAttribute("aria-current", String(tab.dataset["tab"] === name));
    }
  }
}
