// Renderer, camera and light; draws on request. Sharpness is reduced where the
// graphics card cannot follow; where there is none, it comes once the eye stands still.

import {
  DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from "three";
import { Backdrop, type Caster, type Wanted } from "./backdrop";
import { captioned } from "./caption";
import { colourOf } from "./colours";
import type { Graphics } from "./graphics";
import type { Cloud } from "./cloud";
import type { ScaleBar } from "./scale_bar";

const kFieldOfView = 40; // degrees
const kSlow = 45; // ms a picture
const kPatience = 40; // slow pictures before sharpness is reduced
const kRest = 300; // ms between two pictures of clouds that change, where drawing is slow (judgement)
const kPeriod = 100; // elsewhere: the program sends no more
const kMost = 40_000; // points of a picture while the eye moves, where the processor draws: 0.8 us each (measured)
const kQuickSharpness = 0.5; // pixels drawn for one of the style sheet while the eye moves, where the processor draws
const kLargest = 4096; // pixels a side of a saved picture that is larger than the screen, as wide as screens are
const kSamples = 4; // of a pixel, where a graphics card draws

/** Pixels drawn for one of the style sheet in a saved picture of a view of that longer side (in those of the style sheet),
 * of which the screen draws `finest`, and has `ratio`. */
export function savedSharpness(side: number, finest: number, ratio: number): number {
  return Math.max(finest, ratio, Math.min(2 * finest, kLargest / side));
}

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(kFieldOfView, 1, 0.001, 100);
  readonly renderer: WebGLRenderer;
  frameTime = NaN; // ms between pictures, smoothed
  width = 1;
  height = 1;
  shown: readonly Cloud[] = [];
  clouds = ""; // changes with what is seen of them
  grain = 0; // size of their points' disks, m
  readonly up = new Vector3(0, 0, 1);
  casters: Caster[] = []; // throw shadows down on clouds
  private readonly backdrop: Backdrop;
  readonly software: boolean;
  private finest: number; // pixels drawn for one of the style sheet, once the eye stands still;
  private sharpness: number; // while it moves
  private drawn = 0; // in the canvas
  private wanted = true;
  private last = 0;
  private slowPictures = 0;

  private beforeDraw: (now: number) => void = () => {};

  constructor(readonly canvas: HTMLCanvasElement, graphics: Graphics) {
    this.software = graphics.software;
    this.finest = this.software ? 1 : Math.min(devicePixelRatio, 2);
    this.sharpness = this.software ? kQuickSharpness : this.finest;
    this.renderer = new WebGLRenderer({
      canvas, antialias: !this.software, powerPreference: "high-performance",
    });
    this.backdrop = new Backdrop(this.software ? 0 : kSamples, this.software ? kMost : Infinity);
    this.scene.add(this.backdrop.screen);
    const lamp = new DirectionalLight(0xffffff, 2.0);
    lamp.position.set(0.35, 0.55, 0.75);
    this.camera.add(lamp);
    this.scene.add(this.camera, new HemisphereLight(0xffffff, 0x8a8f98, 1.4));
    this.retint();
    this.resize();
  }

  /** Do pictures take so long that what is beside them should wait? */
  get slow(): boolean {
    return this.frameTime > kSlow;
  }

  /** Draws from now on; the function is called before every picture. */
  start(beforeDraw: (now: number) => void): void {
    this.beforeDraw = beforeDraw;
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    requestAnimationFrame((now) => this.tick(now));
  }

  retint(): void {
    this.renderer.setClearColor(colourOf("--view"));
    this.backdrop.retint();
    this.wanted = true;
  }

  request(): void {
    this.wanted = true;
  }

  /** The length of one style-sheet pixel at a position, m. */
  pixelAt(position: Vector3): number {
    this.camera.updateMatrixWorld(); // it may have moved since the last picture
    const depth = position.clone().applyMatrix4(this.camera.matrixWorldInverse).z;
    return Math.max(-depth, this.camera.near) / this.pixelsPerSlope;
  }

  /** Style-sheet pixels per metre at a depth of one. */
  get pixelsPerSlope(): number {
    return this.height / (2 * Math.tan((this.camera.fov * Math.PI) / 360));
  }

  /** What is seen, sharp and larger than on the screen, with a caption. */
  picture(words: string, bar: ScaleBar): Promise<Blob | null> {
    const { sharpness, finest } = this;
    this.finest = this.sharpness = savedSharpness(Math.max(this.width, this.height), finest, devicePixelRatio);
    this.resize();
    this.backdrop.finish(this.renderer, this.scene, this.camera, this.sought());
    this.paint(); // a canvas keeps its picture only until it is shown
    const picture = captioned(this.canvas, this.canvas.width / this.width, words, bar);
    Object.assign(this, { sharpness, finest });
    this.resize();
    return new Promise((resolve) => picture.toBlob(resolve, "image/png"));
  }

  private resize(): void {
    this.wanted = true;
    this.width = Math.max(1, this.canvas.clientWidth);
    this.height = Math.max(1, this.canvas.clientHeight);
    this.drawn = 0;
    this.camera.aspect = this.width / this.height;
    this.camera.updateProjectionMatrix();
    this.draw(performance.now());
  }

  /** As sharp as what is put into it. */
  private fitCanvas(): void {
    const sharpness = this.backdrop.isSharp ? this.finest : this.sharpness;
    if (sharpness === this.drawn) return;
    this.drawn = sharpness;
    this.renderer.setPixelRatio(sharpness);
    this.renderer.setSize(this.width, this.height, false);
  }

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    this.measure(now - this.last);
    this.last = now;
    this.draw(now);
  }

  private draw(now: number): void {
    this.beforeDraw(now);
    if (!this.wanted) return;
    this.wanted = false;
    const more = this.backdrop.update(this.renderer, this.scene, this.camera, this.sought());
    this.wanted ||= more;
    this.paint();
  }

  private sought(): Wanted {
    const { width, height, shown, clouds, grain, sharpness, finest } = this;
    return { width, height, shown, clouds, grain, sharpness, finest, rest: this.slow ? kRest : kPeriod };
  }

  private paint(): void {
    this.fitCanvas();
    this.backdrop.cast(this.camera, this.up, this.casters);
    this.renderer.render(this.scene, this.camera);
  }

  private measure(interval: number): void {
    if (!(interval > 0) || interval > 1000) return;
    this.frameTime = Number.isNaN(this.frameTime) ? interval : 0.95 * this.frameTime + 0.05 * interval;
    this.slowPictures = interval > kSlow ? this.slowPictures + 1 : Math.max(0, this.slowPictures - 1);
    if (this.slowPictures < kPatience || this.sharpness <= 1) return;
    this.slowPictures = 0;
    this.sharpness = Math.max(1, this.sharpness / 1.4);
  }
}
