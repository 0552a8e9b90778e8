// A camera: its place and what it sees, as thin lines.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from "three";
import type { SourceReport } from "../protocol/messages";
import { colourOf, sourceColour } from "./colours";

// Pairs of corners; 0 is the camera, 1 to 4 its near picture, 5 to 8 the far end, 9 above the picture.
// The edges fade on their way to the far end.
const kLines = [0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1, 1, 9, 9, 2, 1, 5, 2, 6, 3, 7, 4, 8];
const kNear = 0.6;
const kFar = 0;

export class Frustum {
  readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;

  constructor(private readonly source: number) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(30), 3));
    const fade = new Float32Array(40).fill(1);
    for (let i = 0; i < 10; i += 1) fade[4 * i + 3] = i >= 5 && i <= 8 ? kFar : kNear;
    geometry.setAttribute("color", new BufferAttribute(fade, 4));
    geometry.setIndex(kLines);
    const material = new LineBasicMaterial({ transparent: true, vertexColors: true, depthWrite: false });
    this.lines = new LineSegments(geometry, material);
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    this.retint();
  }

  retint(): void {
    this.lines.material.color = colourOf(sourceColour(this.source));
  }

  /** near: where the small picture is drawn, m. The camera looks along +z, x right, y down. */
  take(report: SourceReport, near: number): void {
    const { pose, frustum } = report;
    if (pose === undefined || frustum === undefined) return;
    const [width, height, far] = frustum;
    const position = this.lines.geometry.getAttribute("position") as BufferAttribute;
    const corner = (i: number, x: number, y: number, z: number) =>
      position.setXYZ(i, x * width * z, y * height * z, z);
    const front = Math.min(near, far);
    corner(0, 0, 0, 0);
    for (const [i, z] of [[1, front], [5, far]] as const) {
      corner(i, -1, -1, z);
      corner(i + 1, 1, -1, z);
      corner(i + 2, 1, 1, z);
      corner(i + 3, -1, 1, z);
    }
    corner(9, 0, -1.5, front);
    position.needsUpdate = true;
    this.lines.position.set(...pose.position);
    this.lines.quaternion.set(...pose.quaternion);
  }
}
