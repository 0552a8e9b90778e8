// The page: who hears of what.

import "./styles/app.css";
import { App } from "./app";
import { readLink } from "./protocol/link";

const link = readLink(location.hash);
window.addEventListener("hashchange", () => {
  if (readLink(location.hash).token !== link.token) location.reload();
});
new App(link).start();
