// Is the program there? In the bar, and over the view where nothing can go on without an answer.

import type { Link } from "../protocol/connection";
import { byId, say } from "./dom";

const kNeedProgram = ["pause", "reset", "record"];
const kSet = ["panel-settings", "presets"]; // the second stands in the picture on the simple page

export class Status {
  private timer = 0;
  private everOpen = false;

  constructor(again: () => void) {
    byId("cover-again").addEventListener("click", again);
    byId("cover-form").addEventListener("submit", (event) => {
      event.preventDefault();
      const text = byId<HTMLInputElement>("cover-token").value.trim();
      const token = text.slice(text.indexOf("#") + 1);
      if (token === "") return;
      location.hash = token;
    });
  }

  show(link: Link): void {
    clearInterval(this.timer);
    for (const id of kNeedProgram) byId<HTMLButtonElement>(id).disabled = link.phase !== "open";
    for (const id of kSet) byId(id).inert = link.phase !== "open";
    byId("link-state").dataset["phase"] = link.phase;
    if (link.phase === "open") {
      if (this.everOpen) say(byId("polite"), "Reconnected.");
      this.everOpen = true;
      this.uncover();
      this.words("connected");
    } else if (link.phase === "connecting") {
      this.words("connecting");
    } else if (link.phase === "refused") {
      this.words("access denied");
      this.ask("The program rejected this page",
        `Reason: ${link.reason}. Each start of the program has a new token: ` +
        "open the address that it printed last, or paste it here.");
    } else if (link.phase === "ended") {
      this.words("ended");
      this.end(link.reason);
    } else if (link.restarts) {
      this.words("starting again"); // what was seen stays until then
    } else {
      this.wait(link.seconds, this.everOpen ? "Connection lost" : "The program does not answer", link.reason);
    }
  }

  withoutToken(): void {
    byId("link-state").dataset["phase"] = "refused";
    this.words("no token");
    this.ask("Open the address that palpate printed",
      "It ends in # and a token that lets this page watch and move the tool. " +
      "Nothing is shown without it. Paste the address or the token here.");
  }

  private wait(seconds: number, title: string, reason: string): void {
    let left = Math.ceil(seconds);
    say(byId("polite"), `${title}. Reconnecting automatically.`);
    const update = () => {
      this.words(left > 0 ? `retry in ${left} s` : "connecting");
      this.cover(title, (reason === "" ? "" : `Reason: ${reason}. `) +
        "The tool is released. This page reconnects automatically" + (left > 0 ? ` in ${left} s.` : " now."));
      left -= 1;
    };
    update();
    byId("cover-again").hidden = false;
    this.timer = window.setInterval(update, 1000);
  }

  private end(reason: string): void {
    this.cover("What computes the touch here has ended", `Reason: ${reason}. This page can start it again, with what it began with.`);
    say(byId("cover-again"), "Start again");
    byId("cover-again").hidden = false;
  }

  private ask(title: string, text: string): void {
    this.cover(title, text);
    byId("cover-form").hidden = false;
    byId("cover-again").hidden = true;
    byId("cover-token").focus();
  }

  private cover(title: string, text: string): void {
    say(byId("cover-title"), title);
    say(byId("cover-text"), text);
    byId("cover").hidden = false;
  }

  private uncover(): void {
    byId("cover").hidden = true;
    byId("cover-form").hidden = true;
    byId("cover-again").hidden = true;
  }

  private words(text: string): void {
    say(byId("link-words"), text);
  }
}
