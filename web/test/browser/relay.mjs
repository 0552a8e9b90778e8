// A wire between a page and the program that can be cut, frozen (nothing comes through, and nobody is told) and mended. The program takes only who names
// its own port, so the head of a request is given that.

import { connect, createServer } from "node:net";

/** Resolves to { address, cut, freeze, mend, close }. */
export async function relayTo(address) {
  const to = new URL(address);
  const sockets = new Set();
  let whole = true;
  let frozen = false;
  const server = createServer((near) => {
    const far = connect(Number(to.port), to.hostname);
    for (const [one, other] of [[near, far], [far, near]]) {
      sockets.add(one);
      one.on("error", () => other.destroy());
      one.on("close", () => {
        sockets.delete(one);
        other.destroy();
      });
    }
    if (!whole) return near.destroy();
    near.on("data", (data) => frozen || far.write(named(data)));
    far.on("data", (data) => frozen || near.write(data));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const host = `127.0.0.1:${server.address().port}`;
  const named = (data) =>
    data.subarray(0, 4).toString("latin1") === "GET " ? Buffer.from(data.toString("latin1").replaceAll(host, to.host), "latin1") : data;
  const cut = () => {
    whole = false;
    for (const socket of sockets) socket.destroy();
  };
  return {
    address: `http://${host}/${to.hash}`,
    cut,
    freeze: () => (frozen = true),
    mend: () => {
      whole = true;
      frozen = false;
    },
    close: async () => {
      cut();
      await new Promise((resolve) => server.close(resolve));
    },
  };
}
