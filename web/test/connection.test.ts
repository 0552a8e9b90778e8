import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff } from "../src/protocol/backoff";
import { Connection, type Link } from "../src/protocol/connection";

/** A socket to a port that accepts and never answers. */
class DumbSocket {
  static readonly OPEN = 1;
  static made = 0;
  readyState = 0;
  closed = false;

  constructor() {
    DumbSocket.made += 1;
  }

  close(): void {
    this.closed = true;
  }
}

test("a socket that never opens is given up and tried again", () => {
  const timers = new Map<number, { act: () => void; after: number }>();
  let last = 0;
  const fake = {
    setTimeout: (act: () => void, after: number) => {
      timers.set((last += 1), { act, after });
      return last;
    },
  };
  const before = globalThis.clearTimeout;
  Object.defineProperty(globalThis, "window", { value: fake, configurable: true });
  Object.defineProperty(globalThis, "WebSocket", { value: DumbSocket, configurable: true });
  globalThis.clearTimeout = ((id: number) => timers.delete(id)) as typeof clearTimeout;
  try {
    const links: Link[] = [];
    const nothing = () => undefined;
    const connection = new Connection("ws://here/live", "token", () => 1, new Backoff(() => 0.5), {
      link: (link) => links.push(link), message: nothing, binary: nothing, garbled: nothing,
    });
    const fire = () => {
      const [id, timer] = [...timers][0]!;
      timers.delete(id);
      timer.act();
      return timer.after;
    };
    connection.open();
    assert.equal(fire(), 8000);
    assert.deepEqual(links.map(({ phase }) => phase), ["connecting", "waiting"]);
    fire();
    assert.deepEqual(links.map(({ phase }) => phase), ["connecting", "waiting", "connecting"]);
    assert.equal(DumbSocket.made, 2);
  } finally {
    globalThis.clearTimeout = before;
  }
});
