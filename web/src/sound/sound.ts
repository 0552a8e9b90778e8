// Contact and slip to hear, once a person asks for it.

import type { Surface } from "./surface";
import { Voice, type ContactState } from "./voice";

const kPatience = 1500; // ms; without a device for sound a browser never answers

export class Sound {
  private context: AudioContext | undefined;
  private voice: Voice | undefined;

  get on(): boolean {
    return this.context?.state === "running";
  }

  /** Has to come from a click: browsers let nothing sound before. */
  async toggle(): Promise<boolean> {
    const wasOn = this.on; // a new context may run at once
    this.context ??= new AudioContext();
    this.voice ??= new Voice(this.context);
    if (wasOn) await this.context.suspend();
    else await Promise.race([this.context.resume(), new Promise((late) => setTimeout(late, kPatience))]);
    return this.on;
  }

  play(state: ContactState, surface: Surface): void {
    if (this.on) this.voice!.play(state, surface);
  }
}
