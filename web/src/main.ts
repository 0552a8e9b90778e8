// The page: who hears of what.

import "./styles/app.css";
import { App } from "./app";
import { sayCannotDraw } from "./panel/cannot_draw";
import { readLink } from "./protocol/link";
import { graphics } from "./view/graphics";

function start(): void {
  const found = graphics();
  if (found === undefined) sayCannotDraw();
  else new App(readLink(location.hash), found).start();
}

window.addEventListener("hashchange", () => location.reload());
// What is there already is painted first: making the view takes a while where the processor draws.
if (document.hidden) start();
else requestAnimationFrame(() => setTimeout(start));
