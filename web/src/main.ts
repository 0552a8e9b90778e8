// The page: who hears of what.

import "./styles/app.css";
import { App } from "./app";
import { sayCannotDraw } from "./panel/cannot_draw";
import { Panels } from "./panel/panels";
import { readLink } from "./protocol/link";
import { graphics } from "./view/graphics";

const link = readLink(location.hash);
const panels = new Panels(link.values.size > 0); // at once, so that no other page is painted first

function start(): void {
  const found = graphics();
  if (found === undefined) sayCannotDraw();
  else new App(link, found, panels).start();
}

window.addEventListener("hashchange", () => location.reload());
// What is there already is painted first: making the view takes a while where the processor draws.
if (document.hidden) start();
else requestAnimationFrame(() => setTimeout(start));
