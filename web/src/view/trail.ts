// The proxy's path of the last seconds, fading.

import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial, type Vector3 } from "three";
import { colourOf } from "./colours";

const kPoints = 150; // 2.5 s at 60 a second
const kGap = 0.5; // s without a state, or that were passed over in a recording

export class Trail {
  readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly positions = new BufferAttribute(new Float32Array(3 * kPoints), 3);
  private count = 0;
  private time = NaN;

  constructor() {
    const geometry = new BufferGeometry();
    const fade = new Float32Array(4 * kPoints);
    for (let i = 0; i < kPoints; i += 1) fade.set([1, 1, 1, (i / kPoints) ** 1.5], 4 * i);
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("color", new BufferAttribute(fade, 4));
    this.line = new Line(
      geometry,
      new LineBasicMaterial({ transparent: true, vertexColors: true, depthWrite: false }),
    );
    this.line.frustumCulled = false;
    this.line.renderOrder = 3;
  }

  retint(): void {
    this.line.material.color = colourOf("--force");
  }

  take(position: Vector3, time: number): void {
    if (!(time >= this.time && time - this.time < kGap)) this.count = 0;
    this.time = time;
    const array = this.positions.array as Float32Array;
    array.copyWithin(0, 3);
    array.set([position.x, position.y, position.z], 3 * (kPoints - 1));
    this.count = Math.min(this.count + 1, kPoints);
    this.line.geometry.setDrawRange(kPoints - this.count, this.count);
    this.positions.needsUpdate = true;
  }
}
