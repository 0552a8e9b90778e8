// The socket to the program: says hello, hands messages on, comes back by itself when it is lost.

import type { Backoff } from "./backoff";
import { decode, DecodeError, type BinaryMessage } from "./decode";
import { parseMessage, type FromProgram, type ToProgram } from "./messages";

export type Link =
  | { phase: "connecting" }
  | { phase: "open" }
  | { phase: "waiting"; seconds: number; reason: string; restarts: boolean } // in the program's words, or empty
  | { phase: "refused"; reason: string }; // trying again would not help

export interface Listener {
  link(link: Link): void;
  message(message: FromProgram): void;
  binary(message: BinaryMessage): void;
  garbled(text: string): void;
}

const kAbnormal = 1006;
const kPolicyViolation = 1008;
const kServiceRestart = 1012;
const kFollows = 0.15; // s until another run listens
const kPing = 2000; // ms
const kSilence = 8000; // ms without a word, or until it opens, before the socket counts as dead

export class Connection {
  roundTrip = NaN; // s, of the last ping

  private socket: WebSocket | undefined;
  private retry = 0;
  private opening = 0;
  private pinging = 0;
  private pings = new Map<number, number>();
  private nextPing = 1;
  private welcomed = false;
  private heard = 0;

  constructor(
    private readonly address: string,
    private readonly token: string,
    private readonly points: () => number,
    private readonly backoff: Backoff,
    private readonly listener: Listener,
  ) {}

  open(): void {
    clearTimeout(this.retry);
    this.drop();
    this.listener.link({ phase: "connecting" });
    this.opening = window.setTimeout(() => this.lost(kAbnormal, ""), kSilence);
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => this.hello(socket);
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.take(event.data);
    socket.onclose = (event) => {
      if (this.socket === socket) this.lost(event.code, event.reason);
    };
  }

  /** False where nobody is there to hear it. */
  send(message: ToProgram): boolean {
    if (!this.welcomed || this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  private hello(socket: WebSocket): void {
    clearTimeout(this.opening);
    socket.send(
      JSON.stringify({ type: "hello", token: this.token, points: this.points() } satisfies ToProgram),
    );
    this.heard = performance.now();
    this.pinging = window.setInterval(() => this.ping(), kPing);
  }

  private ping(): void {
    if (performance.now() - this.heard > kSilence) {
      this.lost(kAbnormal, "");
      return;
    }
    const id = this.nextPing++;
    this.pings.clear();
    this.pings.set(id, performance.now());
    this.send({ type: "ping", id });
  }

  private take(data: string | ArrayBuffer): void {
    this.heard = performance.now();
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
    const socket = this.socket;
    this.socket = undefined; // from here on nobody listens to it
    this.welcomed = false;
    this.roundTrip = NaN;
    if (socket === undefined) return;
    socket.onopen = null;
    socket.onmessage = null;
    socket.close();
  }

  private lost(code: number, reason: string): void {
    const wasWelcome = this.welcomed;
    this.drop();
    if (code === kPolicyViolation && !wasWelcome) {
      this.listener.link({ phase: "refused", reason: reason || "wrong token" });
      return;
    }
    const restarts = code === kServiceRestart;
    const seconds = restarts ? kFollows : this.backoff.next();
    this.listener.link({ phase: "waiting", seconds, reason, restarts });
    this.retry = window.setTimeout(() => this.open(), seconds * 1000);
  }
}
