// A camera: a short pyramid of thin lines, as wide as what it sees.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from "three";
import type { SourceReport } from "../protocol/messages";
import { colourOf, sourceColour } from "./colours";

// Pairs of corners; 0 is the camera, 1 to 4 its picture, 5 above that.
const kLines = [0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1, 1, 5, 5, 2];
const kOpacity = 0.6;

export class Frustum {
  readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;

  constructor(private readonly source: number) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(18), 3));
    geometry.setIndex(kLines);
    const material = new LineBasicMaterial({ transparent: true, opacity: kOpacity, depthWrite: false });
    this.lines = new LineSegments(geometry, material);
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    this.retint();
  }

  retint(): void {
    this.lines.material.color = colourOf(sourceColour(this.source));
  }

  /** near: how long the pyramid is at most, m. The camera looks along +z, x right, y down. */
  take(report: SourceReport, near: number): void {
    const { pose, frustum } = report;
    if (pose === undefined || frustum === undefined) return;
    const [width, height, far] = frustum;
    const position = this.lines.geometry.getAttribute("position") as BufferAttribute;
    const z = Math.min(near, far);
    [[0, 0], [-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1.5]].forEach(([x, y], i) =>
      position.setXYZ(i, x! * width * z, y! * height * z, i > 0 ? z : 0));
    position.needsUpdate = true;
    this.lines.position.set(...pose.position);
    this.lines.quaternion.set(...pose.quaternion);
  }
}
