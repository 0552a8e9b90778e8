// The page: who hears of what.

import "./styles/app.css";
import { App } from "./app";
import { readLink } from "./protocol/link";

window.addEventListener("hashchange", () => location.reload());
new App(readLink(location.hash)).start();
