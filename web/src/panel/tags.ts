// Where there are several hands: which is which, as words beside each in its colour.

import type { Welcome } from "../protocol/messages";
import { handColour } from "../view/colours";
import type { World } from "../view/world";
import { byId, make } from "./dom";

const kAside = 12; // pixels

export class Tags {
  private tags: HTMLElement[] = [];

  constructor(private readonly world: World) {}

  begin({ devices }: Welcome): void {
    const several = devices.length > 1;
    this.tags = several ? devices.map(({ name }, i) => makeTag(name, i)) : [];
    byId("tags").replaceChildren(...this.tags);
  }

  /** Before every picture; `chosen`: the device whose force is shown. */
  update(chosen: number): void {
    const { camera, width, height } = this.world.stage;
    this.tags.forEach((tag, i) => {
      const tool = this.world.tools[i]!;
      const at = tool.hipPosition.clone().project(camera);
      tag.hidden = !tool.group.visible || Math.abs(at.x) > 1 || Math.abs(at.y) > 1 || at.z > 1;
      if (tag.hidden) return;
      tag.classList.toggle("chosen", i === chosen);
      const right = ((at.x + 1) / 2) * width + kAside;
      const down = ((1 - at.y) / 2) * height + kAside;
      tag.style.transform = `translate(${right.toFixed(1)}px, ${down.toFixed(1)}px)`;
    });
  }
}

function makeTag(name: string, device: number): HTMLElement {
  const tag = make("span", { hidden: true }, make("i"), name);
  tag.style.setProperty("--swatch", `var(${handColour(device)})`);
  return tag;
}
