// Everything that is drawn, and what of it is shown.

import {
  Line, Mesh, Points, Vector3, type BufferGeometry, type Material, type Object3D, type Ray,
} from "three";
import type { CloudMessage, StateMessage, SurfaceMessage, ToolMessage } from "../protocol/decode";
import type { View } from "../protocol/link";
import type { SourceReport, Welcome } from "../protocol/messages";
import { recall, remember } from "../model/memory";
import { Cloud, type Colouring } from "./cloud";
import { rampTexture } from "./colours";
import { Frustum } from "./frustum";
import type { Graphics } from "./graphics";
import { Framing } from "./framing";
import { Navigation } from "./navigation";
import { nearestTo, surfaceAlong, type Seen } from "./pick";
import { scaleBar, type ScaleBar } from "./scale_bar";
import { Stage } from "./stage";
import { Surface } from "./surface";
import { Tool } from "./tool";

export interface Look {
  colouring: Colouring;
  disc: number; // radius of what a point is drawn as, in R
  points: boolean;
  surface: boolean;
  support: boolean;
  cameras: boolean;
  trail: boolean;
}

const kClose = 12; // support radii
const kDropInterval = 100; // ms between two searches for what a tool hovers above
const kStand = 1.7; // spacings by which discs may stand out of a surface that bends (judgement)
const kArrow = 0.16; // of the radius, an arrow for a newton; from close by:
const kArrowPixels = 80;

const kAxes = [[0, 0, 1], [0, 1, 0], [0, -1, 0], [1, 0, 0], [-1, 0, 0], [0, 0, -1]].map(([x, y, z]) => new Vector3(x, y, z));

export const kFirstLook: Look = {
  colouring: "own", disc: 0.6, points: true, surface: true, support: true, cameras: true, trail: true,
};

export class World {
  readonly stage: Stage;
  readonly navigation: Navigation;
  readonly framing: Framing;
  readonly up = new Vector3(0, 0, 1);
  look: Look = { ...kFirstLook };
  followed: number | undefined; // device
  private upKey = ""; // of what was chosen in place of what the program says
  known = false; // is there anything to see, and a place to see it from?
  dragging = false; // a hand that is dragged against the picture: the eye stands still
  clouds: Cloud[] = [];
  tools: Tool[] = [];
  visible: boolean[] = [];
  private surfaces: Surface[] = [];
  private frusta: Frustum[] = [];
  private readonly ramps = rampTexture();
  private time = NaN;
  private changes = 0; // of what clouds look like
  private before = 0;
  private dropped = 0;

  constructor(canvas: HTMLCanvasElement, graphics: Graphics) {
    this.stage = new Stage(canvas, graphics);
    this.navigation = new Navigation(this.stage.camera, canvas, () => this.stage.request());
    this.framing = new Framing(this.navigation, this.up);
  }

  /** Draws from now on; the function is called before every picture. */
  start(beforeDraw: (now: number) => void): void {
    this.stage.start((now) => {
      beforeDraw(now);
      this.update(now);
    });
  }

  /** What was there before goes, unless it is the same scene come back. */
  begin(welcome: Welcome, again: boolean): void {
    this.clear();
    this.changes += 1;
    this.upKey = `up ${welcome.scene} ${welcome.up.join()}`;
    const chosen = recall<unknown>(this.upKey, undefined);
    if (!again) this.up.copy(kAxes.find((axis) => axis.toArray().join() === String(chosen)) ?? new Vector3(...welcome.up).normalize());
    this.framing.begin(welcome, again);
    this.clouds = welcome.sources.map(({ camera }, i) => new Cloud(i, camera, this.ramps, !this.stage.software));
    this.frusta = welcome.sources.map((_, i) => new Frustum(i));
    this.tools = welcome.devices.map((_, i) => new Tool(i));
    this.surfaces = welcome.devices.map(() => new Surface());
    this.visible = welcome.sources.map(() => true);
    for (const object of this.objects()) this.stage.scene.add(object); // add() takes no empty list
    this.known = true;
    this.stage.request();
  }

  takeState(state: StateMessage): void {
    this.tools[state.device]?.take(state);
    this.time = state.time;
    this.stage.request();
  }

  takeCloud(message: CloudMessage): void {
    const cloud = this.clouds[message.source];
    if (cloud === undefined) return;
    cloud.take(message);
    this.changes += 1;
    this.framing.takeCloud(message);
    this.stage.request();
  }

  takeSurface(message: SurfaceMessage): void {
    this.surfaces[message.device]?.take(message);
    this.stage.request();
  }

  takeTool(message: ToolMessage): void {
    this.tools[message.device]?.takeShape(message);
    this.stage.request();
  }

  takeSources(reports: readonly SourceReport[]): void {
    reports.forEach((report, i) => {
      this.frusta[i]?.take(report, 0.12 * this.framing.radius);
      const cloud = this.clouds[i];
      if (cloud !== undefined) cloud.whole = report.points ?? 0;
    });
    this.framing.takeSources(reports);
    this.stage.request();
  }

  /** What a link asks for. */
  ask(view: View): void {
    this.framing.ask(view);
    this.changes += 1;
  }

  /** The next of the six axes is up, here and when this scene is seen again. */
  turnUpright(): void {
    const at = kAxes.findIndex((axis) => axis.distanceTo(this.up) < 1e-3);
    this.up.copy(kAxes[(at + 1) % kAxes.length]!);
    remember(this.upKey, this.up.toArray());
    this.framing.turn();
    this.changes += 1;
    this.framing.fit();
  }

  /** Comes so close to a tool that its support radius shows, and goes along with it; or back. */
  followTool(device: number | undefined): void {
    this.followed = device;
    const tool = device === undefined ? undefined : this.tools[device];
    if (tool === undefined) return this.framing.fit();
    const distance = Math.max(kClose * tool.support, 0.02 * this.framing.radius);
    this.navigation.approach(tool.proxyPosition, Math.min(distance, this.framing.radius));
  }

  retint(): void {
    this.changes += 1;
    this.stage.retint();
    for (const each of [...this.clouds, ...this.frusta, ...this.tools, ...this.surfaces]) each.retint();
  }

  /** The nearest surface that a ray of the eye meets, or passes by so many pixels. */
  surfaceAlong(ray: Ray, pixels: number): Seen | undefined {
    return surfaceAlong(ray, this.shownClouds(), pixels / this.stage.pixelsPerSlope);
  }

  /** Of the middle of the view. */
  get scaleBar(): ScaleBar {
    return scaleBar(this.stage.pixelAt(this.navigation.controls.target), this.stage.canvas.clientWidth);
  }

  /** s, of the oldest shown cloud that cannot be felt any more, as nothing confirms it. */
  get fadedAge(): number | undefined {
    const ages = this.shownClouds().filter((cloud) => cloud.faded).map((cloud) => this.time - cloud.stamp);
    return ages.length > 0 ? Math.max(...ages) : undefined;
  }

  /** What is asked for, if a cloud knows it. */
  get colouring(): Colouring {
    const { colouring } = this.look;
    return this.clouds.some((cloud) => cloud.supports(colouring)) ? colouring : "own";
  }

  private update(now: number): void {
    const seconds = Math.min(0.5, (now - this.before) / 1000);
    const followed = this.followed === undefined ? undefined : this.tools[this.followed];
    if (followed?.group.visible && !this.dragging) {
      this.navigation.follow(followed.proxyPosition, seconds);
    }
    this.before = now;
    this.dropLines(now);
    this.navigation.update(seconds);
    const { look, stage, colouring } = this;
    this.clouds.forEach((cloud, i) => {
      cloud.points.visible = look.points && cloud.count > 0 && this.visible[i] === true;
      cloud.shade(colouring, this.clouds.length > 1, cloud.live ? this.time - cloud.stamp : 0, this.framing.heights, this.up);
      cloud.scale(look.disc);
    });
    stage.shown = look.points ? this.shownClouds() : [];
    // Whatever else is asked for, the eye and what clouds are made of decide what they look like.
    stage.clouds = [this.changes, colouring, colouring === "age" ? this.time : 0, look.disc, look.points, ...this.visible].join();
    stage.grain = this.lift();
    this.frusta.forEach((frustum, i) => {
      frustum.lines.visible = look.cameras && this.visible[i] === true;
    });
    this.surfaces.forEach((surface, i) => {
      surface.shown = look.surface;
      surface.press(this.tools[i]!);
      surface.update(stage.camera.position, this.lift());
    });
    for (const tool of this.tools) {
      tool.showSupport = look.support;
      tool.trail.line.visible = look.trail;
      const pixel = stage.pixelAt(tool.proxyPosition);
      tool.update({
        pixel,
        perNewton: Math.min(kArrow * this.framing.radius, kArrowPixels * pixel),
        camera: stage.camera,
        lift: this.lift(),
      });
    }
    stage.up.copy(this.up);
    stage.casters = this.tools.filter((tool) => tool.group.visible).map((tool) => tool.caster);
  }

  /** How far points stand out towards the eye: what lies in the surface is lifted above them. */
  private lift(): number {
    const spacing = this.clouds.reduce((most, cloud) => Math.max(most, cloud.spacing), 0);
    return this.look.points ? kStand * spacing : 0;
  }

  private shownClouds(): Cloud[] {
    return this.clouds.filter((cloud, i) => cloud.count > 0 && this.visible[i] === true);
  }

  private dropLines(now: number): void {
    if (now - this.dropped < kDropInterval) return;
    this.dropped = now;
    for (const tool of this.tools) {
      const free = tool.group.visible && !tool.touching;
      tool.below = free ? nearestTo(tool.hipPosition, this.shownClouds()) : undefined;
    }
  }

  private objects(): Object3D[] {
    return [
      ...this.clouds.map((cloud) => cloud.points), ...this.frusta.map((frustum) => frustum.lines),
      ...this.surfaces.map((surface) => surface.mesh), ...this.tools.map((tool) => tool.group),
    ];
  }

  private clear(): void {
    for (const object of this.objects()) {
      this.stage.scene.remove(object);
      object.traverse((part) => {
        if (!(part instanceof Mesh || part instanceof Points || part instanceof Line)) return;
        (part.geometry as BufferGeometry).dispose();
        (part.material as Material).dispose();
      });
    }
  }
}
