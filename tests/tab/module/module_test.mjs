// The module of a tab, as its worker uses it: PALPATE_TAB=.../tab.js node --test module_test.mjs
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { test } from "node:test";

const Tab = createRequire(import.meta.url)(process.env.PALPATE_TAB);

/** A program that was opened, and what it said. */
class Program {
  texts = [];
  states = 0;
  points = 0; // of the newest cloud
  force = [0, 0, 0];
  time = 0; // s, of the newest state
  now = 10; // s

  static async make() {
    const program = new Program();
    program.core = await Tab({
      ASAN_OPTIONS: "allocator_may_return_null=1:detect_leaks=0",
      say: (bytes, text) => program.take(bytes, text),
      close: () => assert.fail("closed"),
      open: (name) => (program.another = name),
      openAgain: (unit) => (program.unit = unit),
    });
    return program;
  }
  put(bytes) {
    const at = this.core._malloc(bytes.length + 1);
    this.core.HEAPU8.set(bytes, at);
    this.core.HEAPU8[at + bytes.length] = 0;
    return at;
  }
  text(words) {
    return this.put(new TextEncoder().encode(words));
  }
  /** What is wrong with it; empty: it is touched. */
  open(name, bytes, unit = 0) {
    const wrong = this.core._tab_open(this.text(name), bytes === undefined ? 0 : this.put(bytes), bytes?.length ?? 0, unit, this.text(""));
    return wrong === 0 ? "" : this.core.UTF8ToString(wrong);
  }
  goesOn(wrong) {
    assert.equal(wrong, 0, wrong === 0 ? "" : this.core.UTF8ToString(wrong));
  }
  say(message) {
    const at = this.text(JSON.stringify(message));
    this.goesOn(this.core._tab_receive(at, this.now));
    this.core._free(at);
  }
  connect(points = 1000) {
    this.goesOn(this.core._tab_connect(this.now));
    this.say({ type: "hello", token: "tab", points });
    return this.last("welcome");
  }
  last(kind) {
    return this.texts.findLast(({ type }) => type === kind);
  }
  run(seconds) {
    for (const end = this.now + seconds; this.now < end - 1e-9;) this.goesOn(this.core._tab_run((this.now += 0.004)));
  }
  take(bytes, text) {
    if (text) return void this.texts.push(JSON.parse(new TextDecoder().decode(bytes)));
    const view = new DataView(bytes.slice().buffer);
    if (view.getUint8(0) === 2) this.points = view.getUint32(4, true);
    if (view.getUint8(0) !== 1) return;
    this.states += 1;
    this.time = view.getFloat64(8, true);
    this.force = [52, 56, 60].map((at) => view.getFloat32(at, true));
  }
}

test("a hand that presses on a torus feels the force of two springs", async () => {
  const program = await Program.make();
  assert.equal(program.open("synthetic:torus"), "");
  program.core._tab_run(program.now);
  const { devices } = program.connect();
  const scale = devices[0].scale ?? 1;
  for (let i = 0; i <= 100; i += 1) {
    const z = 0.04 - (0.01 + 0.006 * scale) * (i / 100);
    program.say({ type: "hand", device: 0, position: [0.07, 0, z], buttons: 0 });
    program.run(0.012);
  }
  program.run(1);
  const expected = (0.006 * 300 * 500) / 800; // N
  assert.ok(Math.abs(program.force[2] - expected) < 0.06 + 0.05 * expected, `${program.force}`);
  assert.ok(program.states > 100);
});

const ply = (elements, rest = "") => `ply\nformat binary_little_endian 1.0\n${elements}end_header\n${rest}`;
const xyz = "property float x\nproperty float y\nproperty float z\n";
const kHostile = {
  "empty.ply": "",
  "cut.ply": "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nend_header\n",
  "huge.ply": ply(`element vertex 4294967297\n${xyz}`, "123456789012"),
  "wraps.ply": ply(`element vertex 357913942\n${xyz}`, "123456789012"), // 12 bytes each: 2^32 + 8
  "faces.ply": ply(`element vertex 1\n${xyz}element face 4000000000\nproperty list uint uint vertex_indices\n`, "123456789012"),
  "huge.pcd": "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 65536\nHEIGHT 65537\nPOINTS 4295032832\nDATA binary\n",
  "count.pcd": "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1431655765\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n",
  "huge.stl": "\0".repeat(80) + "\u007f\u007f\u007f\u007f" + "\0".repeat(50),
  "image.pgm": "P5 65536 65536 65535\n",
  "words.xyz": "this is no cloud\n",
  "none.obj": "f 1 2 3\n",
  "zip.ply.gz": "\u001f\u008b\u0008\u0000",
  "survey.las": "LASF" + "\u007f".repeat(400),
  "house.e57": "ASTM-E57" + "\u007f".repeat(400),
  "empty.mcap": "",
  "words.mcap": "this is no recording\n",
  "magic.mcap": "\u0089MCAP0\r\n",
  "chunk.mcap": "\u0089MCAP0\r\n\u0006\u00ff\u00ff\u00ff\u00ff\u007f\0\0\0",
  "what.glb": "glTF\u0002\0\0\0\u007f\u007f\u007f\u007f\u007f\u007f\u007f\u007fJSON",
};

test("of a cloud whose points times those that are asked for exceed 32 bits, as many are drawn as the page asks for", async () => {
  const [width, height, most] = [600, 500, 200_000];
  const heights = new Float32Array(3 * width * height);
  for (let i = 0; i < width * height; i += 1) heights.set([0.001 * (i % width), 0.001 * Math.floor(i / width), 0], 3 * i);
  const head = Buffer.from(ply(`element vertex ${width * height}\n${xyz}`), "latin1");
  const program = await Program.make();
  assert.equal(program.open("plane.ply", Buffer.concat([head, Buffer.from(heights.buffer)])), "");
  program.connect(most);
  program.run(0.2);
  assert.ok(program.points > 0.9 * most && program.points <= most, `${program.points} points`);
});

test("files that are no clouds are refused in words, and the program lives on", async () => {
  const program = await Program.make();
  assert.equal(program.open("synthetic:sphere"), "");
  for (const [name, text] of Object.entries(kHostile)) {
    const words = program.open(name, Buffer.from(text, "latin1"));
    assert.match(words, /^[^\0]{10,}$/, name);
    assert.ok(words.includes(name), `${name}: ${words}`);
    assert.doesNotMatch(words, /std::|vector|bad_alloc|basic_string/, name);
  }
  assert.match(program.open("synthetic:unicorn"), /torus/);
  program.core._tab_run(program.now);
  assert.equal(program.connect().scene, "sphere");
  program.run(0.1);
  assert.ok(program.states > 0);
});

// A hand that dips 2 mm into a floor for 1.5 s, in steps of 10 ms, as the program felt it: 1 N at most, at 0.75 s. Made by
// palpate touch floor.xyz --trajectory dip.csv --simulated-time --record dip.mcap, z of the hand 1 - 3 sin(pi t / 1.5) mm.
const dip = await readFile(new URL("dip.mcap", import.meta.url));

test("a file is opened again in the unit that a person chooses", async () => {
  const rows = Array.from({ length: 900 }, (_, i) => `${20 * (i % 30)} ${20 * Math.floor(i / 30)} 0`).join("\n");
  const bytes = new TextEncoder().encode(rows);
  const program = await Program.make();
  assert.equal(program.open("floor.xyz", bytes), "");
  const unit = ({ settings }) => settings.find(({ key }) => key === "unit.floor");
  assert.equal(unit(program.connect()).question, "floor: 580 x 580 x 0 mm?");
  program.say({ type: "set", key: "unit.floor", value: "mm" });
  assert.equal(program.unit, 0.001);
  const again = await Program.make();
  assert.equal(again.open("floor.xyz", bytes, program.unit), "");
  assert.deepEqual([unit(again.connect())].map(({ value, question }) => [value, question]), [["mm", undefined]]);
});

test("a recording is replayed with its forces", async () => {
  const program = await Program.make();
  assert.equal(program.open("dip.mcap", dip), "");
  program.core._tab_run(program.now);
  const { scene, timeline } = program.connect();
  assert.equal(scene, "dip.mcap");
  assert.ok(Math.abs(timeline.length - 1.5) < 1e-9);
  program.say({ type: "seek", time: 0.75 });
  program.run(0.1);
  assert.deepEqual(program.force, [0, 0, 1]);
  assert.equal(Math.max(...program.last("envelope").forces), 1);
  program.say({ type: "play", on: true, speed: 2 });
  program.run(0.5);
  assert.deepEqual(program.force, [0, 0, 0]);
  assert.deepEqual(program.last("time"), { type: "time", time: timeline.length, playing: false, speed: 2 });
});

test("a cut recording shows what is there and says so; one without its head is refused", async () => {
  const program = await Program.make();
  assert.match(program.open("head.mcap", dip.subarray(0, 3000)), /head\.mcap/);
  assert.equal(program.open("cut.mcap", dip.subarray(0, dip.length / 2)), "");
  program.core._tab_run(program.now);
  assert.ok(program.connect().timeline.length > 0);
  program.run(0.1);
  assert.match(program.last("notice").text, /cut\.mcap/);
});

const sanitized = process.env.PALPATE_SANITIZED === "ON" && "the sanitizer of addresses ends what asks for more memory than there is";
test("what does not fit into a tab's memory is refused in words, and another program begins afresh", { skip: sanitized }, async () => {
  const program = await Program.make();
  assert.equal(program.open("synthetic:sphere"), "");
  for (const size of [2 ** 26, 2 ** 20]) while (program.core._malloc(size) !== 0); // 2 GB, all but some of the last MB
  assert.equal(program.open("synthetic:room"), "synthetic:room needs more memory than a tab may use; the program palpate can open it");
  program.core._tab_run(program.now);
  assert.equal(program.connect().scene, "sphere");
  assert.equal((await Program.make()).open("synthetic:room"), "");
});
