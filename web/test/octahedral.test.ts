import assert from "node:assert/strict";
import { test } from "node:test";
import { decodeOctahedral, encodeOctahedral } from "../src/protocol/octahedral";
import type { Vector } from "../src/protocol/messages";

test("axes are exact", () => {
  for (const axis of [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]] as Vector[]) {
    const back = decodeOctahedral(...encodeOctahedral(axis));
    back.forEach((part, i) => assert.ok(Math.abs(part - axis[i as 0 | 1 | 2]) < 1e-12, `${axis.join()} gives ${back.join()}`));
  }
});

test("any direction comes back within a degree and a half", () => {
  let worst = 0;
  for (let i = 0; i < 5000; i += 1) {
    const z = 1 - (2 * (i + 0.5)) / 5000;
    const angle = i * 2.399963;
    const r = Math.sqrt(1 - z * z);
    const normal: Vector = [r * Math.cos(angle), r * Math.sin(angle), z];
    const back = decodeOctahedral(...encodeOctahedral(normal));
    const cosine = normal.reduce((sum, part, k) => sum + part * back[k as 0 | 1 | 2], 0);
    worst = Math.max(worst, Math.acos(Math.min(1, cosine)));
    assert.ok(Math.abs(Math.hypot(...back) - 1) < 1e-12);
  }
  assert.ok((worst * 180) / Math.PI < 1.5, `${(worst * 180) / Math.PI} degrees`);
});
