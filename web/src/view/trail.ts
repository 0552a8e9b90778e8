// The proxy's way of the last seconds, fading.

import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial, type Vector3 } from "three";
import { colourOf } from "./colours";

const kPlaces = 150; // 2.5 s at 60 a second
const kGap = 0.5; // s that nothing was told, or that were passed over in a recording

export class Trail {
  readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly places = new BufferAttribute(new Float32Array(3 * kPlaces), 3);
  private count = 0;
  private time = NaN;

  constructor() {
    const geometry = new BufferGeometry();
    const fade = new Float32Array(4 * kPlaces);
    for (let i = 0; i < kPlaces; i += 1) fade.set([1, 1, 1, (i / kPlaces) ** 1.5], 4 * i);
    geometry.setAttribute("position", this.places);
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

  take(place: Vector3, time: number): void {
    if (!(time >= this.time && time - this.time < kGap)) this.count = 0;
    this.time = time;
    const array = this.places.array as Float32Array;
    array.copyWithin(0, 3);
    array.set([place.x, place.y, place.z], 3 * (kPlaces - 1));
    this.count = Math.min(this.count + 1, kPlaces);
    this.line.geometry.setDrawRange(kPlaces - this.count, this.count);
    this.places.needsUpdate = true;
  }
}
