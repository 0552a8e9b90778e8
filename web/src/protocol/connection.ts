// The connection with the program: sends hello, passes messages on, comes back by itself when it is lost.

import type { Backoff } from "./backoff";
import { decode, DecodeError, type BinaryMessage } from "./decode";
import { kAbnormal, kPolicyViolation, kServiceRestart, type End } from "./end";
import { parseMessage, type FromProgram, type ToProgram } from "./messages";

export type Link =
  | { phase: "connecting" }
  | { phase: "open" }
  | { phase: "waiting"; seconds: number; reason: string; restarts: boolean } // in the program's words, or empty
  | { phase: "refused"; reason: string } // trying again would not help
  | { phase: "ended"; reason: string }; // it restarts on request

export interface Listener {
  link(link: Link): void;
  message(message: FromProgram): void;
  binary(message: BinaryMessage): void;
  garbled(text: string): void;
}

const kFollows = 0.15; // s until another run listens
const kPing = 2000; // ms
const kSilence = 8000; // ms without a word, or until it opens, before a program elsewhere counts as dead

export class Connection {
  roundTrip = NaN; // s, of the last ping

  private retry = 0;
  private opening = 0;
  private pinging = 0;
  private pings = new Map<number, number>();
  private nextPing = 1;
  private welcomed = false;
  private received = 0; // ms, when the last message came

  constructor(
    private readonly end: End,
    private readonly points: () => number,
    private readonly backoff: Backoff,
    private readonly listener: Listener,
  ) {}

  open(): void {
    clearTimeout(this.retry);
    this.drop();
    this.listener.link({ phase: "connecting" });
    if (!this.end.here) this.opening = window.setTimeout(() => this.lost(kAbnormal, ""), kSilence);
    this.end.open({
      opened: () => this.hello(),
      data: (data) => this.take(data),
      closed: (code, why) => this.lost(code, why),
    });
  }

  /** False where there is no connection to send it over. */
  send(message: ToProgram): boolean {
    return this.welcomed && this.end.send(JSON.stringify(message));
  }

  private hello(): void {
    clearTimeout(this.opening);
    this.end.send(
      JSON.stringify({ type: "hello", token: this.end.token, points: this.points() } satisfies ToProgram),
    );
    this.received = performance.now();
    this.pinging = window.setInterval(() => this.ping(), kPing);
  }

  private ping(): void {
    if (!this.end.here && performance.now() - this.received > kSilence) {
      this.lost(kAbnormal, "");
      return;
    }
    const id = this.nextPing++;
    this.pings.clear();
    this.pings.set(id, performance.now());
    this.send({ type: "ping", id });
  }

  private take(data: string | ArrayBuffer): void {
    this.received = performance.now();
    try {
      if (typeof data === "string") this.takeText(data);
      else this.listener.binary(decode(data));
    } catch (error) {
      if (!(error instanceof DecodeError) && !(error instanceof SyntaxError)) throw error;
      this.listener.garbled(error.message);
    }
  }

  private takeText(text: string): void {
    const message = parseMessage(text);
    if (message === undefined) return;
    if (message.type === "welcome") {
      this.welcomed = true;
      this.backoff.reset();
      this.listener.link({ phase: "open" });
    } else if (message.type === "pong") {
      const sent = this.pings.get(message.id);
      if (sent !== undefined) this.roundTrip = (performance.now() - sent) / 1000;
    }
    this.listener.message(message);
  }

  private drop(): void {
    clearTimeout(this.opening);
    clearInterval(this.pinging);
    this.welcomed = false;
    this.roundTrip = NaN;
    this.end.close();
  }

  private lost(code: number, reason: string): void {
    const wasWelcome = this.welcomed;
    this.drop();
    if (code === kPolicyViolation && !wasWelcome) {
      this.listener.link({ phase: "refused", reason: reason || "wrong token" });
      return;
    }
    const restarts = code === kServiceRestart;
    if (this.end.here && !restarts) {
      this.listener.link({ phase: "ended", reason });
      return;
    }
    const seconds = restarts ? kFollows : this.backoff.next();
    this.listener.link({ phase: "waiting", seconds, reason, restarts });
    this.retry = window.setTimeout(() => this.open(), seconds * 1000);
  }
}
