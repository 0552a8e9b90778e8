// The clouds as a picture with depths that is kept while they and the eye stand still: only what is before it is
// drawn anew then. A picture of a moving eye is quick; of one that stands still it becomes sharp, a part in each frame.

import {
  AddEquation, AlwaysDepth, ConstantAlphaFactor, CustomBlending, DepthTexture, GLSL3, LinearFilter, Mesh, NearestFilter,
  OneMinusConstantAlphaFactor, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, UnsignedIntType, Vector3,
  Vector4, WebGLRenderTarget, type IUniform, type PerspectiveCamera, type WebGLRenderer,
} from "three";
import { kScreen, kShade, kShow } from "./backdrop_shader";
import { kTall, type Cloud } from "./cloud";
import { screenColour } from "./colours";
import { kCloudLayer } from "./layers";

const kStill = 120; // ms of a still eye, before its picture becomes sharp (judgement)
const kLive = 2000; // ms: what changes more often is a camera's, which is drawn quickly until two changes fail to come (measured: a busy page receives 1.6 a second)
const kSharp = 8; // pictures with sample points in a pixel that the sharp one is the mean of
const kAtOnce = 4; // that are enough where each pixel of the screen is four
const kSampled = 2 ** 24; // samples in memory, of 8 bytes (colour and depth): 128 MiB
// ms between two frames: below the first a larger part is drawn in the next, above the second a smaller one; but it ends
// where the machine is busy, too. Where the processor draws, a frame takes 80 ms without any (measured).
const kPace = [20, 50] as const;
const kSoftwarePace = [100, 200] as const;
const kLeastEffort = 1 / 6;

function screen(fragmentShader: string, uniforms: Record<string, IUniform>): Mesh<PlaneGeometry, ShaderMaterial> {
  const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: kScreen, fragmentShader, uniforms, depthFunc: AlwaysDepth });
  const mesh = new Mesh(new PlaneGeometry(1, 1), material);
  mesh.frustumCulled = false;
  return mesh;
}

function target(samples: number): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, {
    depthTexture: new DepthTexture(1, 1, UnsignedIntType), samples, minFilter: NearestFilter, magFilter: NearestFilter,
  });
}

/** Samples of each of so many pixels, a power of two up to `most`, as memory allows; 0: the pixel itself alone. */
export function samplesOf(pixels: number, most: number): number {
  let samples = most;
  while (samples * pixels > kSampled) samples /= 2;
  return samples > 1 ? samples : 0;
}

/** The n-th of values spread over 0 to 1 (van der Corput). */
function spread(n: number, base: number): number {
  let [sum, part] = [0, 1 / base];
  for (let i = n; i > 0; i = Math.floor(i / base), part /= base) sum += part * (i % base);
  return sum;
}

function countOf(clouds: readonly Cloud[]): number {
  return clouds.reduce((sum, { count }) => sum + count, 0);
}

/** What throws a shadow, and lets what it touches glow. */
export interface Caster {
  position: Vector3;
  radius: number; // m
  heat: number; // 0 to 1
}

export interface Wanted {
  sharpness: number; // pixels drawn for one of the style sheet, while the eye moves
  finest: number; // the same of one that stands still
  width: number; // style-sheet pixels
  height: number;
  shown: readonly Cloud[];
  clouds: string; // changes with what is seen of them
  grain: number; // size of a point's disk, m
  rest: number; // ms between two pictures of clouds that change
}

/** How far the sharp picture is. */
interface Progress {
  pictures: number; // that it is the mean of
  points: number; // drawn of the next one
  rows: number; // shaded of it
}

export class Backdrop {
  private readonly points: WebGLRenderTarget;
  private readonly quick = target(0);
  private readonly sharp = target(0);
  private readonly shade: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly shading = new Scene();
  private readonly flat = new OrthographicCamera();
  private readonly range = { value: [0, 1] };
  private readonly casters = [0, 1, 2, 3].map(() => new Vector4());
  private readonly heats = [0, 0, 0, 0];
  private eye = "";
  private clouds = "";
  private drawn = -Infinity; // ms
  private changed = -Infinity; // ms, of the clouds
  private gap = 0; // ms between two changes of what a camera sees, else 0
  private progress: Progress = { pictures: 0, points: 0, rows: 0 };
  private effort = 1 / 4; // of a sharp picture in one frame
  private last = 0; // ms
  /** Puts the picture, with its depths, behind all that a scene draws. */
  readonly screen: Mesh<PlaneGeometry, ShaderMaterial>;

  /** samples: of a pixel, for soft edges, where memory allows; 0: none. most: points that are drawn while the eye moves. */
  constructor(private readonly samples: number, private readonly most: number) {
    this.points = target(samples);
    this.quick.texture.magFilter = LinearFilter;
    this.shade = screen(kShade, {
      colours: { value: this.points.texture }, depths: { value: this.points.depthTexture }, range: this.range,
      slope: { value: 0 }, reach: { value: 1 }, grain: { value: 0 }, turn: { value: 0 },
    });
    Object.assign(this.shade.material, {
      blending: CustomBlending, blendEquation: AddEquation, blendSrc: ConstantAlphaFactor, blendDst: OneMinusConstantAlphaFactor,
    });
    this.shading.add(this.shade);
    this.screen = screen(kShow, {
      colours: { value: null }, depths: { value: null }, range: this.range, slopes: { value: [1, 1] }, up: { value: new Vector3() },
      casters: { value: this.casters }, heats: { value: this.heats }, hot: { value: [0, 0, 0] }, ground: { value: [0, 0, 0] },
      between: { value: [0, 0] },
      count: { value: 0 },
    });
    this.screen.renderOrder = -1;
    this.show(this.quick);
  }

  retint(): void {
    this.screen.material.uniforms["hot"]!.value = screenColour("--force");
    this.screen.material.uniforms["ground"]!.value = screenColour("--view");
  }

  /** Is the sharp picture shown? */
  get isSharp(): boolean {
    return this.progress.pictures > 0;
  }

  /** Draws the clouds of a scene, if the eye or (after a rest) `clouds` are not as they were, or some more of their sharp
   * picture. Returns whether there is more to draw. */
  update(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, wanted: Wanted): boolean {
    const now = performance.now();
    const interval = now - this.last;
    this.last = now;
    camera.updateMatrixWorld();
    const eye = [wanted.width, wanted.height, wanted.sharpness, ...camera.matrixWorld.elements, ...camera.projectionMatrix.elements].join();
    const isSame = eye === this.eye;
    if (isSame && wanted.clouds === this.clouds) {
      if (this.progress.pictures === kSharp) return false;
      if (now - Math.max(this.drawn, this.changed + 2 * this.gap) < kStill) return true;
      const [quick, slow] = this.samples === 0 ? kSoftwarePace : kPace;
      if (interval < quick) this.effort = Math.min(1, 1.25 * this.effort);
      if (interval > slow) this.effort = Math.max(kLeastEffort, 0.8 * this.effort);
      this.refine(renderer, scene, camera, wanted);
      return true;
    }
    if (isSame && now - this.drawn < wanted.rest) return true;
    this.eye = eye;
    if (wanted.clouds !== this.clouds) this.noteChange(now, wanted.shown.some(({ live }) => live));
    this.clouds = wanted.clouds;
    this.drawn = now;
    this.quick.scissor.set(0, 0, Infinity, Infinity);
    this.progress = { pictures: 0, points: 0, rows: 0 };
    const every = Math.max(1, Math.ceil(countOf(wanted.shown) / this.most));
    for (const cloud of wanted.shown) cloud.drawEvery(every);
    this.resize(this.quick, wanted, wanted.sharpness);
    this.drawPoints(renderer, scene, camera, true);
    for (const cloud of wanted.shown) cloud.drawEvery(1);
    this.drawShade(renderer, camera, wanted, this.quick, 0);
    this.show(this.quick);
    return true;
  }

  private noteChange(now: number, isLive: boolean): void {
    const gap = now - this.changed;
    this.gap = isLive && gap < kLive ? gap : 0;
    this.changed = now;
  }

  /** The rest of the sharp picture, at once, for a picture larger than the screen. */
  finish(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, wanted: Wanted): void {
    const { effort } = this;
    this.effort = 1;
    while (this.progress.pictures < kAtOnce) this.refine(renderer, scene, camera, wanted);
    this.effort = effort;
  }

  /** A part of the sharp picture: of the points of the next one that it is the mean of, or of its rows. */
  private refine(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, wanted: Wanted): void {
    const { progress } = this;
    const count = countOf(wanted.shown);
    if (progress.pictures + progress.points + progress.rows === 0) this.resize(this.sharp, wanted, wanted.finest);
    if (progress.points < Math.max(count, 1)) {
      const isFirst = progress.points === 0;
      let from = progress.points;
      progress.points += Math.ceil(this.effort * count) + 1;
      let many = progress.points - from;
      for (const cloud of wanted.shown) {
        const some = from < cloud.count ? Math.min(many, cloud.count - from) : 0;
        cloud.drawPart(from, some);
        from = Math.max(0, from - cloud.count);
        many -= some;
      }
      const { elements } = camera.projectionMatrix;
      const [x, y] = [elements[8], elements[9]];
      elements[8] += (2 * spread(progress.pictures + 1, 2) - 1) / this.sharp.width;
      elements[9] += (2 * spread(progress.pictures + 1, 3) - 1) / this.sharp.height;
      this.drawPoints(renderer, scene, camera, isFirst);
      [elements[8], elements[9]] = [x, y];
      for (const cloud of wanted.shown) cloud.drawPart(0, cloud.count);
      return;
    }
    const { height } = this.sharp;
    const rows = Math.min(height, progress.rows + Math.ceil(this.effort * height));
    this.sharp.scissor.set(0, progress.rows, this.sharp.width, rows - progress.rows);
    this.drawShade(renderer, camera, wanted, this.sharp, progress.pictures);
    progress.rows = rows;
    if (rows < height) return;
    this.progress = { pictures: progress.pictures + 1, points: 0, rows: 0 };
    this.show(this.sharp);
  }

  /** The quick picture is smoothed: few points are compared for its hollows. */
  private show({ texture, depthTexture, width, height }: WebGLRenderTarget): void {
    const between = { value: texture === this.quick.texture ? [0.5 / width, 0.5 / height] : [0, 0] };
    Object.assign(this.screen.material.uniforms, { colours: { value: texture }, depths: { value: depthTexture }, between });
  }

  private resize(to: WebGLRenderTarget, { width, height }: Wanted, sharpness: number): void {
    const [wide, tall] = [Math.floor(width * sharpness), Math.floor(height * sharpness)];
    const samples = samplesOf(wide * tall, this.samples);
    if (samples !== this.points.samples) this.points.dispose();
    this.points.samples = samples;
    for (const each of [this.points, to]) each.setSize(wide, tall);
    to.scissorTest = true;
    kTall.value = to.height;
  }

  private drawPoints(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, isFirst: boolean): void {
    camera.layers.set(kCloudLayer);
    renderer.setRenderTarget(this.points);
    renderer.autoClear = isFirst;
    renderer.render(scene, camera);
    renderer.autoClear = true;
    renderer.setRenderTarget(null);
    camera.layers.set(0);
  }

  /** Adds a picture to those that `to` is the mean of. */
  private drawShade(renderer: WebGLRenderer, camera: PerspectiveCamera, { height, grain }: Wanted, to: WebGLRenderTarget, picture: number): void {
    const { material } = this.shade;
    this.range.value = [camera.near, camera.far];
    material.uniforms["grain"]!.value = grain;
    material.uniforms["reach"]!.value = to.height / height;
    material.uniforms["slope"]!.value = 2 / (camera.projectionMatrix.elements[5] * to.height);
    material.uniforms["turn"]!.value = 2 * Math.PI * spread(picture, 2);
    material.blendAlpha = 1 / (picture + 1);
    material.depthWrite = picture === 0;
    renderer.setRenderTarget(to);
    renderer.autoClear = false;
    renderer.render(this.shading, this.flat);
    renderer.autoClear = true;
    renderer.setRenderTarget(null);
  }

  /** Shadows of these, before the next picture. */
  cast(camera: PerspectiveCamera, up: Vector3, casters: readonly Caster[]): void {
    const { uniforms } = this.screen.material;
    const projection = camera.projectionMatrix.elements;
    uniforms["slopes"]!.value = [1 / projection[0], 1 / projection[5]];
    (uniforms["up"]!.value as Vector3).copy(up).transformDirection(camera.matrixWorldInverse);
    uniforms["count"]!.value = Math.min(casters.length, this.casters.length);
    casters.slice(0, this.casters.length).forEach(({ position, radius, heat }, i) => {
      this.heats[i] = heat;
      this.casters[i]!.set(...position.clone().applyMatrix4(camera.matrixWorldInverse).toArray(), radius);
    });
  }
}
