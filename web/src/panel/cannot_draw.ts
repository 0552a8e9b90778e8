// A browser that cannot draw the view says so, and what helps.

import { byId, say } from "./dom";

export function sayCannotDraw(): void {
  byId("link-state").dataset["phase"] = "refused";
  say(byId("link-words"), "nothing can be drawn");
  say(byId("cover-title"), "This browser cannot draw the view");
  say(byId("cover-text"),
    "It has no WebGL 2, or it is switched off: turn on the use of the graphics card in the browser's settings, " +
    "or open this address in another browser.");
  byId("cover").hidden = false;
}
