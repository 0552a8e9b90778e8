import assert from "node:assert/strict";
import { test } from "node:test";

import { fileName } from "../src/panel/opening";

test("a file's name is made of what the program takes, and keeps its ending", () => {
  assert.equal(fileName("bunny.ply"), "bunny.ply");
  assert.equal(fileName("Mein Scan (2).pcd.gz"), "Mein_Scan_2_.pcd.gz");
  assert.equal(fileName("Höhle/../x.las"), "H_hle_.._x.las");
  assert.equal(fileName("..hidden"), "_hidden");
  assert.equal(fileName(""), "_");
  const long = fileName(`${"a".repeat(300)}.laz`);
  assert.equal(long.length, 128);
  assert.ok(long.endsWith(".laz"));
});
