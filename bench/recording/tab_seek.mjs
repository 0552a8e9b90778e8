// Measures how long the module of a tab takes to open a recording, to show a moment of it, and to play it, in Node.
//
//   PALPATE_TAB=build/web/tab/tab.js node tab_seek.mjs FILE.mcap
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const kWake = 0.004; // s, as browsers call it
const file = process.argv[2];
const heard = [];
const say = (bytes, text) => text && heard.push(JSON.parse(new TextDecoder().decode(bytes)));
const core = await createRequire(import.meta.url)(resolve(process.env.PALPATE_TAB))({ say, close() {}, open() {} });
let now = 10; // s

function put(bytes) {
  const at = core._malloc(bytes.length + 1);
  core.HEAPU8.set(bytes, at);
  core.HEAPU8[at + bytes.length] = 0;
  return at;
}
const text = (words) => put(new TextEncoder().encode(words));
const wish = (message) => core._tab_receive(text(JSON.stringify(message)), now);

/** ms that it takes; what is wrong ends the program. */
function timed(act) {
  const begin = performance.now();
  const wrong = act();
  if (wrong !== 0) throw new Error(core.UTF8ToString(wrong));
  return performance.now() - begin;
}
const wake = () => timed(() => core._tab_run((now += kWake)));
const wakes = (seconds) => Array.from({ length: Math.round(seconds / kWake) }, wake);

function tell(what, times) {
  const sorted = times.toSorted((a, b) => a - b);
  const at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))].toFixed(1);
  console.log(`${what}: p50 ${at(0.5)} ms, p99 ${at(0.99)} ms, longest ${at(1)} ms`);
}

const bytes = readFileSync(file);
console.log(`opened in ${timed(() => core._tab_open(text(file), put(bytes), bytes.length, 0, text(""))).toFixed(0)} ms`);
core._tab_connect(now);
wish({ type: "hello", token: "tab", points: 10000 });
const { length } = heard.find(({ type }) => type === "welcome").timeline;
tell("a wake while all forces are read, 8 s", wakes(8));
tell("a moment that is sought", Array.from({ length: 30 }, (_, i) => {
  wish({ type: "seek", time: length * ((0.37 * i) % 1) });
  const took = wake();
  wakes(0.2); // its pictures
  return took;
}));
wish({ type: "seek", time: 0 });
wish({ type: "play", on: true, speed: 1 });
tell("a wake while it plays, 4 s", wakes(4));
console.log(`${(core.HEAPU8.length / 2 ** 20).toFixed(0)} MB of memory`);
