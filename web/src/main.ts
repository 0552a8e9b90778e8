// The page: who hears of what.

import "./styles/app.css";
import { App } from "./app";
import { canDraw, sayCannotDraw } from "./panel/cannot_draw";
import { readLink } from "./protocol/link";

window.addEventListener("hashchange", () => location.reload());
if (canDraw()) new App(readLink(location.hash)).start();
else sayCannotDraw();
