import assert from "node:assert/strict";
import { test } from "node:test";
import { Box3, Color, Mesh, Quaternion, Vector3, type BufferGeometry } from "three";
import type { ToolMessage } from "../src/protocol/decode";
import { ToolShape } from "../src/view/tool_shape";

/** Corners of boxes around x = -1 and x = 1, one a finger. */
function gripper(): ToolMessage {
  const samples = [-1, 1].flatMap((side) =>
    [0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [side + ((k & 1) - 0.5), ((k >> 1) & 1) - 0.5, (k >> 2) - 0.5, 0, side]));
  return { kind: 5, device: 0, axis: [1, 0, 0], samples: Float32Array.from(samples), faces: new Float32Array() };
}

const shapeOf = (message: ToolMessage) => new ToolShape(message, new Color(), new Color());

test("fingers are drawn as far apart as a gripper is open", () => {
  const shape = shapeOf(gripper());
  assert.ok(shape.opens);
  shape.placeProxy(new Vector3(0, 0, 10), new Quaternion(), 0.5);
  shape.proxy.updateMatrixWorld(true);
  const boxes = shape.proxy.children.map((child) => new Box3().setFromObject(child));
  assert.deepEqual(boxes.map(({ min, max }) => [min.x, max.x, min.z]), [[-1.75, -0.75, 9.5], [0.75, 1.75, 9.5]]);
  assert.ok(Math.abs(shape.reach(new Vector3(1, 0, 0)) - 1.75) < 1e-9);
  shape.placeProxy(new Vector3(), new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), Math.PI / 2), 0.5);
  assert.ok(Math.abs(shape.reach(new Vector3(0, -1, 0)) - 1.75) < 1e-9, "turned");
});

test("a ball is as large as its radius; a mesh is drawn as its faces, also from behind", () => {
  const ball = shapeOf({ ...gripper(), samples: Float32Array.from([0, 0, 0, 2, 0]) });
  assert.equal(ball.extent, 2);
  assert.ok(!ball.opens);
  const box = new Box3().setFromObject(ball.proxy);
  assert.ok(Math.abs(box.max.y - 2) < 1e-6 && Math.abs(box.min.y + 2) < 1e-6, `${box.max.y}`);
  const mesh = shapeOf({ ...gripper(), faces: Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0]) });
  assert.equal(mesh.proxy.children.length, 1);
  const face = mesh.proxy.children[0]!.children[0];
  assert.ok(face instanceof Mesh);
  const { geometry } = face as Mesh<BufferGeometry>;
  assert.deepEqual(Array.from(geometry.getAttribute("normal").array), [0, 0, 1, 0, 0, 1, 0, 0, 1]);
});

test("a point and a side that is flat have nothing to draw", () => {
  const flat = Float32Array.from([0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0]);
  assert.equal(shapeOf({ ...gripper(), samples: flat.slice(0, 5) }).proxy.children.length, 0);
  assert.ok(shapeOf({ ...gripper(), samples: flat }).extent > 1.4);
});
