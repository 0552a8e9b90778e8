// Mouse, pen and finger. On the surface, a press that begins on it touches it (Stroke). Free, a drag that
// begins on the hand, or any drag while the tool is held, moves the hand in the plane through it that faces
// the eye; the wheel meanwhile changes its depth. Everything else is left to the navigation.

import { MathUtils, Plane, Raycaster, Vector2, Vector3 } from "three";
import type { World } from "../view/world";
import type { Hand } from "./hand";
import type { Stroke } from "./stroke";

const kGrasp = 24; // pixels around the hand
const kFinger = 40;
const kStill = 4; // pixels, below which a press was no drag
const kNotch = 0.012; // of the distance, a notch of the wheel
const kRoll = MathUtils.degToRad(5); // a notch of the wheel
const kHalfTurn = Math.PI; // a drag from the picture's top to its bottom

export class PointerInput {
  private inPlane = false; // it moves in the plane that faces the eye
  private pointer: number | undefined; // that drags the hand
  turns = false; // drags turn the tool, as with Shift
  private turning: Vector2 | undefined; // where a drag that turns it has come to, pixels
  private touches = new Set<number>();
  private began: Vector2 | undefined; // where a press beside the surface did, pixels
  missed = -Infinity; // ms, when such a press ended that was no drag; until the next that touches the surface
  private readonly offset = new Vector3();
  private readonly ray = new Raycaster();

  constructor(
    area: HTMLElement,
    private readonly canvas: HTMLCanvasElement,
    private readonly world: World,
    private readonly hand: Hand,
    private readonly stroke: Stroke,
    private readonly takeable: () => boolean,
    private readonly take: () => boolean,
  ) {
    area.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    area.addEventListener("pointermove", (event) => this.move(event), { capture: true });
    for (const type of ["pointerup", "pointercancel"] as const) {
      area.addEventListener(type, (event) => this.end(event), { capture: true });
    }
    area.addEventListener("wheel", (event) => this.wheel(event), { capture: true, passive: false });
  }

  /** Does a drag move the hand freely, not on the surface? */
  get free(): boolean {
    return this.inPlane;
  }

  set free(free: boolean) {
    this.inPlane = free;
    this.stroke.rest();
    this.drag(undefined);
  }

  private down(event: PointerEvent): void {
    if (event.target !== this.canvas) return;
    if (event.pointerType === "touch") this.touches.add(event.pointerId);
    const plain = event.button === 0 && !event.altKey && !event.ctrlKey && !event.metaKey;
    const turning = plain && this.touches.size <= 1 && (event.shiftKey || this.turns) && this.holdsTool() && this.take();
    const mine = turning || (plain && this.touches.size <= 1 && this.grasps(event) && this.take());
    const two = this.touches.size > 1; // fingers turn the view
    this.world.navigation.turnByDrag(!mine && !(this.free ? this.hand.held && this.touches.size > 0 : two));
    if (this.touches.size > 1) this.drag(undefined);
    this.began = plain && !mine && !this.free && this.touches.size <= 1 && this.takeable() ? new Vector2(event.clientX, event.clientY) : undefined;
    if (!mine) return;
    this.missed = -Infinity;
    this.drag(event.pointerId);
    this.canvas.setPointerCapture(event.pointerId);
    this.turning = turning ? new Vector2(event.clientX, event.clientY) : undefined;
    if (turning) return;
    if (this.free) {
      this.offset.copy(this.hand.position).sub(this.onPlane(event) ?? this.hand.position);
    } else {
      this.stroke.press(true);
      this.aim(event);
    }
  }

  private move(event: PointerEvent): void {
    if (this.pointer === undefined) {
      if (event.target === this.canvas && event.buttons === 0) this.hover(event);
    } else if (event.pointerId !== this.pointer) {
      return;
    } else if (this.turning !== undefined) {
      this.turnBy(this.turning, event);
    } else if (!this.free) {
      this.aim(event);
    } else {
      const position = this.onPlane(event);
      if (position !== undefined) this.hand.moveTo(position.add(this.offset));
    }
  }

  private holdsTool(): boolean {
    return this.world.tools[this.hand.device]?.shape !== undefined;
  }

  /** As a ball under the pointer turns. */
  private turnBy(from: Vector2, event: PointerEvent): void {
    const rate = kHalfTurn / this.canvas.getBoundingClientRect().height;
    this.hand.turn(this.world.stage.camera, rate * (event.clientY - from.y), rate * (event.clientX - from.x), 0);
    from.set(event.clientX, event.clientY);
  }

  private hover(event: PointerEvent): void {
    this.canvas.classList.toggle("graspable", this.takeable() && this.grasps(event));
    if (!this.free && !this.stroke.led && this.hand.held && event.pointerType !== "touch") this.aim(event);
  }

  private end(event: PointerEvent): void {
    this.touches.delete(event.pointerId);
    const isStill = this.began !== undefined && Math.hypot(event.clientX - this.began.x, event.clientY - this.began.y) < kStill;
    if (isStill && event.type === "pointerup") this.missed = performance.now(); // the browser takes others away, as to scroll
    this.began = undefined;
    if (event.pointerId === this.pointer) this.drag(undefined);
  }

  private drag(pointer: number | undefined): void {
    this.pointer = pointer;
    this.world.dragging = pointer !== undefined;
    if (pointer === undefined) this.turning = undefined;
    if (pointer === undefined) this.stroke.press(false);
  }

  private aim(event: PointerEvent): void {
    this.stroke.aim(this.seen(event), event.pointerType === "touch");
    if (event.pointerType === "pen" && event.pressure > 0) this.stroke.press(true, event.pressure);
  }

  private wheel(event: WheelEvent): void {
    const rolls = event.shiftKey && this.hand.held && this.hand.turned !== undefined;
    if (this.pointer === undefined && !rolls) return;
    event.preventDefault();
    event.stopPropagation();
    const delta = event.deltaY || event.deltaX; // browsers scroll sideways with Shift
    const notches = -delta / (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 100 : 3);
    if (rolls) return this.hand.turn(this.world.stage.camera, 0, 0, notches * kRoll);
    if (!this.free) return this.stroke.harder(notches);
    const camera = this.world.stage.camera;
    const away = notches * kNotch * camera.position.distanceTo(this.hand.position);
    this.hand.nudge(camera, 0, 0, away);
    this.offset.copy(this.hand.position).sub(this.onPlane(event) ?? this.hand.position);
  }

  /** Would a press here move the tool? */
  private grasps(event: PointerEvent): boolean {
    if (this.free) return this.hand.held || this.onHand(event);
    return this.stroke.under(this.seen(event), event.pointerType === "touch") !== undefined;
  }

  private seen(event: MouseEvent): Vector2 {
    const box = this.canvas.getBoundingClientRect();
    return new Vector2(
      (2 * (event.clientX - box.left)) / box.width - 1,
      1 - (2 * (event.clientY - box.top)) / box.height,
    );
  }

  private onPlane(event: MouseEvent): Vector3 | undefined {
    const camera = this.world.stage.camera;
    this.ray.setFromCamera(this.seen(event), camera);
    const plane = new Plane().setFromNormalAndCoplanarPoint(
      camera.getWorldDirection(new Vector3()), this.hand.position,
    );
    return this.ray.ray.intersectPlane(plane, new Vector3()) ?? undefined;
  }

  private onHand(event: PointerEvent): boolean {
    const tool = this.world.tools[this.hand.device];
    if (tool === undefined || !tool.group.visible) return false;
    const position = this.hand.held ? this.hand.position : tool.hipPosition;
    const at = position.clone().project(this.world.stage.camera);
    const box = this.canvas.getBoundingClientRect();
    const seen = this.seen(event);
    return Math.hypot((at.x - seen.x) * box.width, (at.y - seen.y) * box.height) / 2 < (event.pointerType === "touch" ? kFinger : kGrasp);
  }
}
