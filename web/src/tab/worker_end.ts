// A program in a worker of this tab.

import { kAbnormal, kServiceRestart, type End, type Hears } from "../protocol/end";
import type { FromProgram } from "../protocol/messages";
import type { FromWorker, ToWorker } from "./messages";
import { preparing, type Wanted } from "./wanted";

const kUnreachable = "its scripts could not be loaded: is this machine online?";

export class WorkerEnd implements End {
  readonly token = "tab"; // nobody else can speak to a worker
  readonly here = true;
  private worker: Worker | undefined;
  private hears: Hears | undefined;
  private ready = false;
  private request = 0; // the last one
  private answer: ((wrong: string | undefined) => void) | undefined; // of the file that was given: the last request
  private unsaid: string | undefined; // what was refused while no page listened

  private given: File | undefined; // by a page that frames this one (web/tab_package)
  private takesGiven: ((file: File) => void) | undefined;

  /** Begins at once: what is `first` touched is there the sooner. */
  constructor(private readonly first: Wanted) {
    this.worker = this.start();
    window.addEventListener("message", ({ data, source }: MessageEvent<{ palpate?: unknown; file?: unknown } | null>) => {
      if (source !== window.parent || source === window || data?.palpate !== "open" || !(data.file instanceof File)) return;
      this.given = data.file;
      this.handOnGiven();
    });
  }

  takeGiven(take: (file: File) => void): void {
    this.takesGiven = take;
    this.handOnGiven();
  }

  private handOnGiven(): void {
    if (this.takesGiven === undefined || this.given === undefined) return;
    this.takesGiven(this.given);
    this.given = undefined;
  }

  open(hears: Hears): void {
    this.hears = hears;
    this.worker ??= this.start();
    if (this.ready) return this.connect();
    const text = preparing(this.first);
    hears.data(JSON.stringify({ type: "notice", level: "info", text, share: 0 } satisfies FromProgram)); // until it welcomes
  }

  send(text: string): boolean {
    if (!this.ready) return false;
    this.post(text);
    return true;
  }

  async give(file: File): Promise<string | undefined> {
    if (this.answer !== undefined) return `${file.name} is not opened: another one is being prepared`;
    if (!this.ready) return `${file.name} is not opened: nothing computes the touch here now`;
    this.request += 1;
    return new Promise((resolve) => {
      this.answer = resolve;
      this.post({ kind: "open", wanted: { name: file.name, file }, request: this.request });
    });
  }

  close(): void {
    this.hears = undefined;
  }

  private start(): Worker {
    const worker = new Worker("worker.js");
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.take(data);
    worker.onerror = (event) => {
      event.preventDefault(); // it is said on the page
      this.died(event.message ?? kUnreachable);
    };
    worker.postMessage({ kind: "open", wanted: this.first, request: 0 } satisfies ToWorker);
    return worker;
  }

  private post(message: ToWorker): void {
    this.worker?.postMessage(message);
  }

  private connect(): void {
    this.post({ kind: "connect" });
    this.hears?.opened();
    if (this.unsaid !== undefined) this.refuse(this.unsaid);
  }

  private refuse(words: string): void {
    this.hears?.data(JSON.stringify({ type: "refused", text: words } satisfies FromProgram));
    this.unsaid = this.hears === undefined ? words : undefined;
  }

  private take(data: FromWorker): void {
    if (typeof data === "string" || data instanceof ArrayBuffer) return this.hears?.data(data);
    switch (data.kind) {
      case "ready":
        this.ready = true;
        if (this.hears !== undefined) this.connect();
        return;
      case "another":
        if (data.request > 0) this.answered(undefined);
        return this.hears?.closed(kServiceRestart, "");
      case "refused":
        return data.request > 0 ? this.answered(data.words) : this.refuse(data.words);
      case "closed":
        return this.hears?.closed(data.code, data.why);
      case "died":
        return this.died(data.why);
    }
  }

  private answered(wrong: string | undefined): void {
    this.answer?.(wrong);
    this.answer = undefined;
  }

  private died(why: string): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.ready = false;
    this.answered(undefined); // it is said once
    this.hears?.closed(kAbnormal, why);
  }
}
