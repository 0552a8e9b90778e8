// From where a scene is seen first: so that all of its clouds show, from its cameras' side, and the better the more of them are
// known, until somebody moves the eye; or as a link asks for it.

import { Quaternion, Vector2, Vector3 } from "three";
import type { CloudMessage } from "../protocol/decode";
import type { View } from "../protocol/link";
import type { SourceReport, Welcome } from "../protocol/messages";
import { boundsOf, heightsOf, samplesOf, type Sample } from "./bounds";
import { firstDirection } from "./first_view";
import type { Navigation } from "./navigation";

const kLonePoint = 5e-3; // m, two R of a cloud whose points are all at one place

export class Framing {
  radius = 0.5; // m, of the scene
  readonly heights = new Vector2(0, 1); // along up, low and high, m
  private samples: Sample[][] = [];
  private cameras: Vector3[] = []; // directions that lead back to them
  private eye: Vector3[] = []; // where it begins, if the program says so
  private framedBy = -1; // what was known of the scene when it was framed; less than now: once more
  private heard = false; // of the sources: where cameras are
  private asked: View | undefined; // by a link

  constructor(private readonly navigation: Navigation, private readonly up: Vector3) {}

  begin(welcome: Welcome, again: boolean): void {
    this.radius = welcome.radius > 0 ? welcome.radius : kLonePoint;
    this.eye = welcome.eye === undefined ? [] : [new Vector3(...welcome.eye)];
    this.samples = welcome.sources.map(() => []);
    this.heard = false;
    this.turn();
    if (!again) {
      this.asked = undefined;
      this.framedBy = -1;
      this.navigation.touched = false;
    }
    if (this.framedBy < 0) this.frame();
  }

  takeCloud(message: CloudMessage): void {
    if (this.samples.flat().length === 0) this.navigation.touched = false; // by a press before there was something
    this.samples[message.source] = samplesOf(message);
    this.measureHeights();
    this.settle();
  }

  takeSources(reports: readonly SourceReport[]): void {
    this.cameras = reports.flatMap(({ pose }) => (pose ? [new Vector3(0, 0, -1).applyQuaternion(new Quaternion(...pose.quaternion))] : []));
    this.heard = true;
    this.settle();
  }

  /** Holds until somebody moves the eye or frames the scene, and for this scene alone. */
  ask(view: View): void {
    this.asked = view;
    this.up.set(...view.up).normalize();
    this.turn();
    this.frame();
  }

  get view(): View {
    const { camera, controls } = this.navigation;
    return { eye: camera.position.toArray(), target: controls.target.toArray(), up: this.up.toArray() };
  }

  fit(): void {
    this.asked = undefined;
    this.frame();
  }

  /** What is up has changed. */
  turn(): void {
    this.navigation.setUp(this.up);
    this.measureHeights();
  }

  private settle(): void {
    const known = this.samples.filter((samples) => samples.length > 0).length + (this.heard ? 1 : 0);
    if (known <= this.framedBy) return;
    this.framedBy = known;
    if (!this.navigation.touched) this.frame();
  }

  private frame(): void {
    const samples = this.samples.flat();
    const centre = samples[0]?.position.clone() ?? new Vector3();
    const bounds = boundsOf(samples) ?? { samples: [], centre, radius: this.radius };
    const towards = this.cameras.length > 0 ? this.cameras : this.eye.map((place) => place.clone().sub(bounds.centre));
    this.navigation.frame(bounds, firstDirection(this.up, towards, bounds));
    if (this.asked !== undefined) this.navigation.look(new Vector3(...this.asked.eye), new Vector3(...this.asked.target));
  }

  private measureHeights(): void {
    const samples = this.samples.flat();
    if (samples.length > 1) this.heights.copy(heightsOf(samples, this.up));
  }
}
