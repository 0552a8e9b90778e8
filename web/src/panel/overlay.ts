// What lies over the view and follows the eye: scale, axes, the ramp of colours.

import { Quaternion, Vector3 } from "three";
import type { Colouring } from "../view/cloud";
import type { World } from "../view/world";
import { byId, say } from "./dom";
import { lengthInWords } from "../view/scale_bar";

const kArm = 18;
const kSpace = "http://www.w3.org/2000/svg";

function svg(tag: string, parent: Element, name: string): Element {
  const element = document.createElementNS(kSpace, tag);
  element.setAttribute("class", name);
  parent.append(element);
  return element;
}

export class Overlay {
  private readonly axes = ["x", "y", "z"].map((name) => {
    const line = svg("line", byId("axes"), `axis-${name}`);
    const text = svg("text", byId("axes"), `axis-${name}`);
    text.textContent = name;
    return { line, text };
  });

  constructor(private readonly world: World) {}

  update(): void {
    this.showAxes();
    this.showScale();
    this.showRamp();
    this.showFaded();
  }

  private showFaded(): void {
    const age = this.world.fadedAge;
    byId("faded").hidden = age === undefined;
    if (age !== undefined) say(byId("faded"), `grey: last seen ${age.toFixed(age < 10 ? 1 : 0)} s ago, not felt`);
  }

  private showAxes(): void {
    const turn = new Quaternion().copy(this.world.stage.camera.quaternion).invert();
    this.axes.forEach(({ line, text }, i) => {
      const axis = new Vector3().setComponent(i, 1).applyQuaternion(turn);
      line.setAttribute("x2", (kArm * axis.x).toFixed(1));
      line.setAttribute("y2", (-kArm * axis.y).toFixed(1));
      line.setAttribute("opacity", axis.z < -0.3 ? "0.4" : "1");
      text.setAttribute("x", ((kArm + 6) * axis.x).toFixed(1));
      text.setAttribute("y", (-(kArm + 6) * axis.y).toFixed(1));
    });
  }

  private showScale(): void {
    byId("scale").hidden = !this.world.known;
    if (!this.world.known) return;
    const { pixels, label } = this.world.scaleBar;
    const end = (pixels + 1).toFixed(1);
    byId("scale-bar").setAttribute("width", String(Math.ceil(pixels + 2)));
    byId("scale-path").setAttribute("d", `M1 1v6M1 4H${end}M${end} 1v6`);
    say(byId("scale-label"), label);
  }

  private showRamp(): void {
    const { x: low, y: high } = this.world.framing.heights;
    const ends: Partial<Record<Colouring, [string, string]>> = {
      height: ["0", `${lengthInWords(high - low)} high`], age: ["now", "1 s old"], trust: ["low trust", "high trust"],
    };
    const colouring = this.world.colouring;
    const words = ends[colouring];
    const ramp = byId("ramp");
    ramp.hidden = words === undefined;
    if (words === undefined) return;
    ramp.dataset["of"] = colouring;
    say(byId("ramp-low"), words[0]);
    say(byId("ramp-high"), words[1]);
  }
}
