import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff } from "../src/protocol/backoff";
import { Connection, type Link } from "../src/protocol/connection";
import type { End, Hears } from "../src/protocol/end";
import { SocketEnd } from "../src/protocol/socket_end";

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
    const connection = new Connection(new SocketEnd("ws://here/live", "token"), () => 1, new Backoff(() => 0.5), {
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

/** A program in this tab, silent until a test speaks for it. */
class HereEnd implements End {
  readonly token = "tab";
  readonly here = true;
  hears: Hears | undefined;
  said: string[] = [];

  open(hears: Hears): void {
    this.hears = hears;
  }
  send(text: string): boolean {
    this.said.push(text);
    return true;
  }
  give(): Promise<undefined> {
    return Promise.resolve(undefined);
  }
  close(): void {
    this.hears = undefined;
  }
}

test("a program in this tab may be silent; where it ends, it begins again when somebody says so", () => {
  const timers: number[] = [];
  const fake = { setTimeout: (_: () => void, after: number) => timers.push(after), setInterval: () => 0 };
  Object.defineProperty(globalThis, "window", { value: fake, configurable: true });
  const links: Link[] = [];
  const nothing = () => undefined;
  const end = new HereEnd();
  const connection = new Connection(end, () => 1, new Backoff(() => 0.5), {
    link: (link) => links.push(link), message: nothing, binary: nothing, garbled: nothing,
  });
  connection.open();
  assert.deepEqual(timers, [], "nothing waits for it");
  end.hears?.opened();
  assert.deepEqual(end.said.map((text) => (JSON.parse(text) as { type: string; token: string }).token), ["tab"]);
  end.hears?.data('{"type":"welcome"}');
  end.hears?.closed(1006, "out of memory");
  assert.deepEqual(links.at(-1), { phase: "ended", reason: "out of memory" });
  assert.deepEqual(timers, []);
  connection.open();
  end.hears?.closed(1012, ""); // another cloud
  assert.deepEqual(timers, [150]);
});
