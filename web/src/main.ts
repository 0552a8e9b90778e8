// The page: connects to the program, and starts the application where the browser can draw.

import "./styles/app.css";
import { App } from "./app";
import { sayCannotDraw } from "./panel/cannot_draw";
import { Panels } from "./panel/panels";
import { readLink } from "./protocol/link";
import { SocketEnd } from "./protocol/socket_end";
import { wantedAt } from "./tab/wanted";
import { WorkerEnd } from "./tab/worker_end";
import { graphics } from "./view/graphics";

const link = readLink(location.hash);
const here = document.querySelector('meta[name="palpate"][content="tab"]') !== null; // the program is in this tab, too
const end = here
  ? new WorkerEnd(wantedAt(location.href))
  : new SocketEnd(new URL("live", location.href.replace(/^http/, "ws").replace(/#.*/, "")).href, link.token);
document.body.dataset["end"] = here ? "tab" : "socket"; // styles/layout.css
const panels = new Panels(link.values.size > 0); // at once, so that no other page is painted first

function start(): void {
  const found = graphics();
  if (found === undefined) sayCannotDraw();
  else new App(link, end, found, panels).start();
}

window.addEventListener("hashchange", () => location.reload());
// What is there already is painted first: making the view takes a while where the processor draws.
if (document.hidden) start();
else requestAnimationFrame(() => setTimeout(start));
