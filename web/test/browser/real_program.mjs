// palpate itself, run for a test: PALPATE_PROGRAM says where it is.

import { spawn } from "node:child_process";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const kLongest = 300; // s, should nobody stop it

/** A level table-top of 0.4 m, a point every 4 mm, as XYZ. */
function tableTop() {
  const rows = [];
  for (let i = -50; i <= 50; i += 1) {
    for (let j = -50; j <= 50; j += 1) rows.push(`${4e-3 * i} ${4e-3 * j} 0`);
  }
  return rows.join("\n") + "\n";
}

/** A hand that dips into its middle every 4 s, as CSV. */
function dipping() {
  const rows = ["t,hip_x,hip_y,hip_z"];
  for (let i = 0; i <= 400; i += 1) {
    const angle = (2 * Math.PI * i) / 400;
    rows.push([i / 100, 0.02 * Math.sin(angle), 0, 0.005 + 0.008 * Math.cos(angle)].join(","));
  }
  return rows.join("\n") + "\n";
}

// Rough enough that a hand which comes down obliquely stays where it is.
export const kTable = ["touch", "table.xyz", "--viewpoint", "0,0,1", "--stiffness", "500",
  "--trajectory", "hand.csv", "--device", "simulated",
  "--friction-static", "0.8", "--friction-dynamic", "0.8", "--view", "--port", "0"];

/** The same table under two hands that explore it until they are taken. */
export const kTwoHands = ["touch", "table.xyz", "--viewpoint", "0,0,1", "--stiffness", "500",
  "--device", "simulated", "--device", "simulated",
  "--friction-static", "0.8", "--friction-dynamic", "0.8", "--view", "--port", "0"];

/** Resolves to { address, port, folder, stop } once it serves its page; `folder` is where it runs. */
export async function startProgram(args) {
  const path = process.env.PALPATE_PROGRAM;
  if (path === undefined) throw new Error("PALPATE_PROGRAM has to name the built palpate");
  const folder = await mkdtemp(join(tmpdir(), "palpate-page-"));
  await writeFile(join(folder, "table.xyz"), tableTop());
  await writeFile(join(folder, "hand.csv"), dipping());
  const child = spawn("timeout", ["--foreground", String(kLongest), resolve(path), ...args], { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
  const ended = new Promise((done) => child.once("exit", (code, signal) => done(code ?? signal)));
  const address = await addressOf(child, ended);
  return {
    address,
    port: Number(new URL(address).port),
    folder,
    stop: async () => {
      child.kill("SIGINT");
      const code = await ended;
      await rm(folder, { recursive: true, force: true });
      return code;
    },
  };
}

/** Runs it to its end in `folder`; resolves to what it wrote. */
export function run(args, folder = tmpdir()) {
  return new Promise((done, failed) => {
    const child = spawn(resolve(process.env.PALPATE_PROGRAM), args, { cwd: folder, stdio: ["ignore", "pipe", "ignore"] });
    let out = "";
    child.stdout.on("data", (data) => (out += data));
    child.once("error", failed);
    child.once("close", (code) => done({ code, out }));
  });
}

function addressOf(child, ended) {
  return new Promise((found, failed) => {
    let said = "";
    child.stderr.on("data", (data) => {
      said = (said + data).slice(-4000);
      const line = /^page: (\S+)\n/m.exec(said);
      if (line !== null) found(line[1]);
    });
    void ended.then((code) => failed(new Error(`palpate ended (${code}) without a page: ${said}`)));
  });
}
