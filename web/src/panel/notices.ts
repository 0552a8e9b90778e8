// What a person should know, in words: over the view for a while, then in the list of messages.

import type { NoticeLevel } from "../protocol/messages";
import { byId, make, say } from "./dom";

const kLife: Record<NoticeLevel, number> = { info: 6000, warning: 12000, fault: Infinity }; // ms
const kShown = 3;
const kLogged = 50;
const kWords: Record<NoticeLevel, string> = { info: "", warning: "Warning: ", fault: "Fault: " };

interface Notice {
  level: NoticeLevel;
  text: string;
  times: number;
  card: HTMLElement;
  entry: HTMLElement;
  timer: number;
  share: number | undefined; // of work under way, 0 to 1: it stays until that is done
}

/** The same but for its quantities: they differ where one thing happens again. Other numbers are names ("hand 2"). */
function kindOf(text: string): string {
  return text.replace(/(?<![\w.])(\d+\.\d+|\d+(?= ?(%|[kmµun]?[smN]|Hz|points|steps|frames|failed|times)(?!\w)))/g, "#");
}

export class Notices {
  private shown: Notice[] = [];

  /** `brief`: what is neither a warning nor work under way is listed only. */
  constructor(private readonly brief: () => boolean) {}

  /** What work was under way is not the next run's, nor are faults: those that persist are reported again. */
  begin(): void {
    this.endWork();
    for (const notice of this.shown) if (notice.level === "fault") this.remove(notice);
  }

  private endWork(): void {
    for (const notice of this.shown) if (notice.share !== undefined) this.remove(notice);
  }

  /** share: of work that takes a while, 0 to 1. One such notice is shown, until that is 1. calm: warnings are listed only. */
  add(level: NoticeLevel, text: string, share?: number, calm = false): void {
    if (calm && level === "warning") return this.log(this.makeNotice(level, text).entry);
    if (level === "info" && share === undefined && this.brief()) return this.list(text);
    if (share === undefined) return this.put(level, text);
    const work = this.shown.find((notice) => notice.share !== undefined);
    if (share >= 1) {
      if (work !== undefined) this.remove(work);
    } else if (work === undefined || work.text !== text) {
      this.endWork();
      this.put(level, text, share);
    } else {
      this.showShare(work, share);
    }
  }

  /** It no longer holds; the list of messages keeps it. */
  takeBack(text: string): void {
    for (const notice of this.shown) if (notice.text === text) this.remove(notice); // other words hold still
  }

  private put(level: NoticeLevel, text: string, share?: number): void {
    const alike = kindOf(text);
    const same = this.shown.find((notice) => kindOf(notice.text) === alike && notice.level === level);
    if (same !== undefined) {
      this.repeat(same, text);
      return;
    }
    const notice = this.makeNotice(level, text);
    if (share !== undefined) this.showShare(notice, share);
    this.shown.push(notice);
    if (this.shown.length > kShown) {
      this.remove(this.shown.find((one) => one.level !== "fault" && one.share === undefined) ?? this.shown[0]!);
    }
    byId("notices").append(notice.card);
    this.log(notice.entry);
    say(byId(level === "fault" ? "urgent" : "polite"), kWords[level] + text);
    this.limit(notice);
  }

  private makeNotice(level: NoticeLevel, text: string): Notice {
    const close = make("button", { type: "button", class: "close", "aria-label": "Dismiss" }, "×");
    const card = make("div", { class: `notice ${level}` },
      make("b", {}, kWords[level]), make("span", { class: "words" }, text), make("span", { class: "times" }), close);
    const time = new Date();
    const entry = make("li", { class: level },
      make("time", { datetime: time.toISOString() }, time.toLocaleTimeString()), " ", kWords[level] + text);
    const notice: Notice = { level, text, times: 1, card, entry, timer: 0, share: undefined };
    close.addEventListener("click", () => this.remove(notice));
    return notice;
  }

  private list(text: string): void {
    this.log(this.makeNotice("info", text).entry);
    say(byId("polite"), text);
  }

  private showShare(notice: Notice, share: number): void {
    notice.share = share;
    notice.card.style.setProperty("--share", String(share));
    notice.card.classList.add("work");
    say(notice.card.querySelector(".times")!, share > 0 ? `${Math.floor(100 * share)} %` : "…");
  }

  private repeat(notice: Notice, text: string): void {
    notice.times += 1;
    notice.text = text;
    say(notice.card.querySelector(".words")!, text);
    say(notice.card.querySelector(".times")!, `×${notice.times}`);
    this.limit(notice);
  }

  private limit(notice: Notice): void {
    clearTimeout(notice.timer);
    const life = kLife[notice.level];
    if (Number.isFinite(life) && notice.share === undefined) notice.timer = window.setTimeout(() => this.remove(notice), life);
  }

  private remove(notice: Notice): void {
    clearTimeout(notice.timer);
    notice.card.remove();
    this.shown = this.shown.filter((other) => other !== notice);
  }

  private log(entry: HTMLElement): void {
    const log = byId("log");
    log.prepend(entry);
    while (log.children.length > kLogged) log.lastElementChild?.remove();
  }
}
