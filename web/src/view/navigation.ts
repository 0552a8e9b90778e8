// The eye: orbit, zoom, pan; a first view that shows what the cameras see.

import { MOUSE, TOUCH, Vector3, type PerspectiveCamera } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Bounds } from "./bounds";

const kTurn = 1.6; // radians a second by keys
const kCloser = 1.2; // of the distance's logarithm a second
const kMargin = 0.88; // of the free picture that is used
const kFoot = 90; // pixels at its lower edge, where a hint and a button stand
const kLoose = 0.8; // of the radius, while no point is known
const kRounds = 4;
const kStep = 1.25; // of the distance: noise gives no other view at the next start
const kPole = 1e-3; // rad from straight above or below: there a place of the eye says nothing of its heading
const kLag = 0.25; // s
const kGlide = 0.13; // s, a time constant: 0.12 of the rest in each picture of a screen (judgement)

export class Navigation {
  controls: OrbitControls;
  touched = false; // somebody moved the eye
  private radius = 0.5;

  constructor(
    readonly camera: PerspectiveCamera,
    private readonly canvas: HTMLCanvasElement,
    private readonly changed: () => void,
  ) {
    this.controls = this.makeControls();
  }

  /** The controls learn what is up only when they are made. */
  setUp(up: Vector3): void {
    if (this.camera.up.distanceTo(up) < 1e-6) return;
    this.camera.up.copy(up);
    const { target, minDistance, maxDistance } = this.controls;
    this.controls.dispose();
    this.controls = Object.assign(this.makeControls(), { minDistance, maxDistance });
    this.controls.target.copy(target);
  }

  /** Shows all points, from a direction. */
  frame(bounds: Bounds, direction: Vector3): void {
    this.radius = bounds.radius;
    const { target, distance } = this.fitting(bounds, direction);
    this.camera.near = 0.004 * distance;
    this.camera.far = 60 * distance;
    this.camera.updateProjectionMatrix();
    this.controls.minDistance = 0.02 * bounds.radius;
    this.controls.maxDistance = 12 * bounds.radius;
    this.look(target.clone().addScaledVector(direction, distance), target);
  }

  /** Looks from one point at another. */
  look(from: Vector3, at: Vector3): void {
    this.controls.target.copy(at);
    this.camera.position.copy(from);
    const { touched } = this;
    this.controls.update();
    this.touched = touched; // this was nobody's
    this.changed();
  }

  /** Middle and distance from which all points are seen, with a margin. */
  private fitting(bounds: Bounds, direction: Vector3): { target: Vector3; distance: number } {
    const right = new Vector3().crossVectors(this.camera.up, direction).normalize();
    const upward = new Vector3().crossVectors(direction, right);
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const foot = Math.min(0.25, kFoot / Math.max(this.canvas.clientHeight, 1));
    const wide = half * kMargin * this.camera.aspect;
    const tall = half * kMargin * (1 - foot);
    const target = bounds.centre.clone();
    let distance = (kLoose * bounds.radius) / Math.min(tall, wide);
    for (let round = 0; round < kRounds && bounds.samples.length > 0; round += 1) {
      let [left, most, low, high, needed] = [Infinity, -Infinity, Infinity, -Infinity, 0];
      for (const { position } of bounds.samples) {
        const from = position.clone().sub(target);
        const [x, y, near] = [from.dot(right), from.dot(upward), from.dot(direction)];
        needed = Math.max(needed, near + Math.max(Math.abs(x) / wide, Math.abs(y) / tall));
        const depth = Math.max(distance - near, 1e-9);
        [left, most] = [Math.min(left, x / depth), Math.max(most, x / depth)];
        [low, high] = [Math.min(low, y / depth), Math.max(high, y / depth)];
      }
      target.addScaledVector(right, ((left + most) / 2) * distance);
      target.addScaledVector(upward, ((low + high) / 2) * distance);
      distance = Math.max(needed, 0.1 * bounds.radius); // all points may coincide
    }
    distance = kStep ** Math.ceil(Math.log(distance) / Math.log(kStep));
    target.addScaledVector(upward, -foot * half * distance);
    return { target, distance };
  }

  /** Whether a drag with the main button, or one finger, turns the view. */
  turnByDrag(on: boolean): void {
    this.controls.mouseButtons.LEFT = on ? MOUSE.ROTATE : null;
    this.controls.touches.ONE = on ? TOUCH.ROTATE : null;
    this.controls.touches.TWO = on ? TOUCH.DOLLY_PAN : TOUCH.DOLLY_ROTATE;
  }

  /** Looks at a position from a distance. */
  approach(position: Vector3, distance: number): void {
    const arm = this.camera.position.clone().sub(this.controls.target).setLength(distance);
    this.controls.target.copy(position);
    this.camera.position.copy(position).add(arm);
    this.changed();
  }

  /** Follows a position, smoothed. */
  follow(position: Vector3, seconds: number): void {
    const step = position.clone().sub(this.controls.target).multiplyScalar(1 - Math.exp(-seconds / kLag));
    this.controls.target.add(step);
    this.camera.position.add(step);
    this.changed();
  }

  /** Keys: right, up and closer, for how long each was held down, s. */
  turn(right: number, up: number, closer: number): void {
    this.touched = true;
    const arm = this.camera.position.clone().sub(this.controls.target);
    const axis = this.camera.up;
    const side = new Vector3().crossVectors(axis, arm).normalize();
    const tilt = Math.acos(Math.min(1, Math.max(-1, arm.clone().normalize().dot(axis))));
    const wanted = Math.min(Math.PI - 0.05, Math.max(0.05, tilt - up * kTurn));
    arm.applyAxisAngle(side, wanted - tilt);
    arm.applyAxisAngle(axis, right * kTurn);
    arm.multiplyScalar(Math.exp(-closer * kCloser));
    this.camera.position.copy(this.controls.target).add(arm);
    this.changed();
  }

  /** Lets the view glide on after a drag for `seconds`; what is left of that, once nobody could see it, is done at once:
   * the eye stands still then, and its picture becomes sharp. */
  update(seconds: number): void {
    const { camera, canvas, controls } = this;
    const from = camera.position.clone();
    controls.dampingFactor = 1 - Math.exp(-seconds / kGlide);
    controls.update();
    const left = camera.position.distanceTo(from) / controls.dampingFactor / controls.getDistance();
    if (!controls.enableDamping || left === 0 || left > (0.5 * camera.fov * Math.PI) / 180 / canvas.clientHeight) return;
    controls.enableDamping = false;
    controls.update();
    controls.enableDamping = true;
  }

  private makeControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.enableDamping = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    controls.rotateSpeed = 0.8;
    controls.zoomToCursor = true;
    controls.maxDistance = 12 * this.radius;
    [controls.minPolarAngle, controls.maxPolarAngle] = [kPole, Math.PI - kPole];
    let held = false;
    controls.addEventListener("start", () => (held = true));
    controls.addEventListener("end", () => (held = false));
    controls.addEventListener("change", () => {
      this.touched ||= held; // a press alone moves nothing
      this.changed();
    });
    return controls;
  }
}
