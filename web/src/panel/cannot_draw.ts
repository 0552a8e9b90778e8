// A browser that cannot draw the view says so, and what helps.

import { byId, say } from "./dom";

export function sayCannotDraw(): void {
  byId("link-state").dataset["phase"] = "refused";
  say(byId("link-words"), "cannot render");
  say(byId("cover-title"), "This browser cannot render the view");
  say(byId("cover-text"),
    "WebGL 2 is missing or disabled: enable hardware acceleration in the browser's settings, " +
    "or open this address in another browser.");
  byId("cover").hidden = false;
}
