// One source's points. What the program sends goes to the graphics card as it is; the origin and
// size of the cloud are the object's position and scale.

import {
  BufferAttribute, BufferGeometry, CustomBlending, GLSL3, OneFactor, Points, ShaderMaterial, Vector2,
  Vector3, ZeroFactor, type Texture,
} from "three";
import type { CloudMessage } from "../protocol/decode";
import { kCloudFragment, kCloudVertex } from "./cloud_shader";
import { screenColour, sourceColour } from "./colours";
import { kCloudLayer } from "./layers";

export const kColourings = ["source", "height", "normal", "age", "own", "trust"] as const;
export type Colouring = (typeof kColourings)[number];

const kStale = 1; // s, the age that shows as stale
const kTint = 0.4; // of a source's colour in clay (judgement)

export const kTall = { value: 1 }; // pixels, the height of the picture that is drawn

/** isSoft: edges of discs are soft where a pixel has several samples. */
function makeMaterial(ramps: Texture, isSoft: boolean): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kCloudVertex,
    fragmentShader: kCloudFragment,
    alphaToCoverage: isSoft, // the canvas itself stays opaque
    defines: isSoft ? { SOFT: "" } : {},
    blending: CustomBlending,
    blendSrc: OneFactor,
    blendDst: ZeroFactor,
    blendSrcAlpha: ZeroFactor,
    blendDstAlpha: OneFactor,
    uniforms: {
      mode: { value: 0 },
      hasNormals: { value: false },
      sourceColour: { value: [0.5, 0.5, 0.5] },
      age: { value: 0 },
      faded: { value: false },
      heights: { value: new Vector2(0, 1) },
      up: { value: new Vector3(0, 0, 1) },
      disc: { value: 1 },
      wider: { value: 1 },
      tall: kTall,
      ramps: { value: ramps },
    },
  });
}

export class Cloud {
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  stamp = NaN;
  count = 0;
  whole = 0; // points that are felt; 0: unknown
  private every = 1; // that `some` are
  private some: BufferAttribute | undefined;
  private ownTint = [0, 0, 0];
  private clay = [0, 0, 0];
  private even = 0.002; // m, between points that lie evenly
  faded = false; // cannot be felt any more
  hasNormals = false;
  private hasColours = false;
  private hasTrust = false;
  private capacity = 0;

  constructor(
    private readonly source: number,
    readonly live: boolean, // what stands still does not age
    ramps: Texture,
    isSoft: boolean,
  ) {
    this.points = new Points(new BufferGeometry(), makeMaterial(ramps, isSoft));
    this.points.frustumCulled = false;
    this.points.geometry.addEventListener("dispose", ({ target }) => this.dropChoice(target));
    this.points.layers.set(kCloudLayer);
    this.retint();
  }

  retint(): void {
    this.ownTint = screenColour(sourceColour(this.source));
    this.clay = screenColour("--clay");
  }

  take(message: CloudMessage): void {
    if (message.count >= this.capacity) this.grow(message.count + 1); // an empty one, too, has its columns
    this.count = message.count;
    this.stamp = message.stamp;
    this.faded = message.faded;
    this.points.material.uniforms["faded"]!.value = message.faded;
    this.hasColours = message.colours !== undefined;
    this.hasNormals = message.normals !== undefined;
    this.hasTrust = message.trust !== undefined;
    this.fill("position", message.positions);
    if (message.colours !== undefined) this.fill("own", message.colours);
    if (message.normals !== undefined) this.fill("bend", message.normals);
    this.fill("trust", message.trust ?? new Uint8Array(message.count).fill(255));
    this.fill("wide", message.radii ?? new Uint8Array(message.count)); // none: as small as can be
    const [x, y, z] = message.extent;
    this.points.position.set(...message.lower);
    this.points.scale.set(Math.max(x, 1e-9), Math.max(y, 1e-9), Math.max(z, 1e-9));
    this.points.geometry.setDrawRange(0, message.count);
    this.even = Math.sqrt((x * y + y * z + z * x) / Math.max(message.count, 1));
  }

  /** m, about. A choice of points is as uneven as chance: of what spots cover that are d spacings wide, exp(-d²) stays bare. */
  get spacing(): number {
    return this.count < 0.95 * this.whole ? Math.SQRT2 * this.even : this.even;
  }

  supports(colouring: Colouring): boolean {
    return colouring !== "trust" || this.hasTrust;
  }

  /** Without colours of its own it is of clay; beside `others`, of clay with its source's tint. */
  shade(colouring: Colouring, others: boolean, age: number, heights: Vector2, up: Vector3): void {
    const uniforms = this.points.material.uniforms;
    const isPlain = !this.supports(colouring) || (colouring === "own" && !this.hasColours);
    uniforms["mode"]!.value = kColourings.indexOf(isPlain ? "source" : colouring);
    const share = !isPlain ? 1 : others ? kTint : 0;
    uniforms["sourceColour"]!.value = this.clay.map((part, i) => part + share * (this.ownTint[i]! - part));
    uniforms["hasNormals"]!.value = this.hasNormals;
    uniforms["age"]!.value = Number.isFinite(age) ? Math.min(Math.max(age / kStale, 0), 1) : 0;
    uniforms["heights"]!.value = heights;
    uniforms["up"]!.value = up;
  }

  /** disc: radius of what a point is drawn as, in R. */
  scale(disc: number): void {
    this.points.material.uniforms["disc"]!.value = disc;
  }

  /** One of so many points, so much wider: they are in the order of a curve that fills space, so what is left covers all. */
  drawEvery(every: number): void {
    const { geometry, material } = this.points;
    material.uniforms["wider"]!.value = Math.sqrt(every);
    if (every === 1) {
      geometry.setIndex(null);
      this.drawPart(0, this.count);
      return;
    }
    if (this.every !== every) this.choose(every);
    geometry.setIndex(this.some!);
    this.drawPart(0, Math.ceil(this.count / every));
  }

  drawPart(from: number, count: number): void {
    this.points.geometry.setDrawRange(from, count);
  }

  /** The attribute stays one and the same, as a camera's clouds change in size. */
  private choose(every: number): void {
    this.every = every;
    this.some ??= new BufferAttribute(new Uint32Array(Math.ceil(this.capacity / 2)), 1);
    this.some.array.forEach((_, i, array) => (array[i] = i * every));
    this.some.needsUpdate = true;
  }

  /** The graphics card lets go of an index only where that is the geometry's when this goes; the listener was there before the renderer's. */
  private dropChoice(geometry: BufferGeometry): void {
    geometry.setIndex(this.some ?? null);
    this.some = undefined;
    this.every = 1;
  }

  private grow(count: number): void {
    this.capacity = Math.ceil(count * 1.25);
    const geometry = this.points.geometry;
    geometry.dispose();
    geometry.setIndex(null);
    geometry.setAttribute("position", new BufferAttribute(new Uint16Array(3 * this.capacity), 3, true));
    geometry.setAttribute("own", new BufferAttribute(new Uint8Array(3 * this.capacity), 3, true));
    geometry.setAttribute("bend", new BufferAttribute(new Int8Array(2 * this.capacity), 2, true));
    geometry.setAttribute("trust", new BufferAttribute(new Uint8Array(this.capacity), 1, true));
    geometry.setAttribute("wide", new BufferAttribute(new Uint8Array(this.capacity), 1));
  }

  private fill(name: string, values: Uint16Array | Uint8Array | Int8Array): void {
    const attribute = this.points.geometry.getAttribute(name) as BufferAttribute;
    (attribute.array as Uint16Array).set(values);
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, values.length);
    attribute.needsUpdate = true;
  }
}
