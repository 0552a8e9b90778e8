// A program that is none: speaks docs/viewer_protocol.md over a made-up scene and serves dist/ under the
// strict policy of the real one. node test/fake_server.mjs [--port 8421] [--points 30000] [--token TOKEN] [--still]

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { dirname, extname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { randomBytes } from "node:crypto";
import { WebSocketServer } from "ws";
import { FakeProgram } from "./fake/program.mjs";

const kPage = process.env.PALPATE_PAGE ?? join(dirname(fileURLToPath(import.meta.url)), "..", "dist");
const kTypes = { ".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8" };
const kPolicy = "default-src 'self'; connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

async function answer(request, response) {
  const path = request.url === "/" ? "/index.html" : (request.url ?? "");
  if (!/^\/[a-z]+\.(html|js|css)$/.test(path)) return response.writeHead(404).end();
  try {
    const body = await readFile(join(kPage, path));
    response.writeHead(200, {
      "Content-Type": kTypes[extname(path)], "Content-Security-Policy": kPolicy,
      "X-Content-Type-Options": "nosniff", "Cache-Control": "no-store",
    });
    response.end(body);
  } catch {
    response.writeHead(404).end("npm run build comes first");
  }
}

/** Resolves to { address, program, close } once it listens on 127.0.0.1; port 0 takes a free one. */
export async function serve({ port = 0, points = 30000, still = false, silent, length, anew, box, token = randomBytes(16).toString("hex") } = {}) {
  const program = new FakeProgram({ points, still, silent, length, anew, box, token });
  const http = createServer((request, response) => void answer(request, response));
  const sockets = new WebSocketServer({ server: http, path: "/live", maxPayload: 64_000 });
  sockets.on("connection", (socket) => {
    const client = { socket, welcome: false, points: 0 };
    program.clients.add(client);
    socket.on("message", (data) => program.take(client, data.toString()));
    socket.on("close", () => {
      program.clients.delete(client);
      program.release(client);
    });
  });
  await new Promise((resolve, reject) => http.once("error", reject).listen(port, "127.0.0.1", resolve));
  return {
    address: `http://127.0.0.1:${http.address().port}/#${token}`,
    port: http.address().port,
    token,
    program,
    close: async () => {
      program.close();
      for (const socket of sockets.clients) socket.terminate();
      await new Promise((resolve) => http.close(resolve));
    },
  };
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? "").href) {
  const option = (name, otherwise) => {
    const at = process.argv.indexOf(`--${name}`);
    return at > 0 ? process.argv[at + 1] : otherwise;
  };
  const { address } = await serve({
    port: Number(option("port", 8421)), points: Number(option("points", 30000)), still: process.argv.includes("--still"),
    ...(option("token") ? { token: option("token") } : {}),
  });
  console.log(address);
}
