import assert from "node:assert/strict";
import { test } from "node:test";

import { fileName } from "../src/protocol/socket_end";

test("a file's name is made of what the program takes, and keeps its ending", () => {
  assert.equal(fileName("bunny.ply"), "bunny.ply");
  assert.equal(fileName("Größe 点云 (2).pcd.gz"), "Größe 点云 (2).pcd.gz");
  assert.equal(fileName("../a/\tb.las"), "__a_b.las");
  assert.equal(fileName("..hidden"), "_hidden");
  assert.equal(fileName(""), "_");
  const long = fileName(`${"🐰".repeat(300)}.laz`);
  assert.equal(new TextEncoder().encode(long).length, 4 * 56 + 4);
  assert.ok(long.endsWith("🐰.laz"));
});
