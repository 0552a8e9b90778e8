// What a page hears of the program, for a test to measure.

/** Runs in the page, before its own scripts: keeps each tool's newest state, counts states and clouds. */
export function listen() {
  window.heard = { states: 0, clouds: 0, points: 0, tools: [] };
  const three = (view, at) => [0, 4, 8].map((i) => view.getFloat32(at + i, true));
  const hear = ({ data }) => {
    if (!(data instanceof ArrayBuffer)) return;
    const view = new DataView(data);
    const kind = view.getUint8(0);
    if (kind === 2) {
      window.heard.clouds += 1;
      window.heard.points = view.getUint32(4, true);
      if (window.heard.clouds === 1) { // drawn in the next picture, which is over when the one after begins
        requestAnimationFrame(() => requestAnimationFrame((now) => (window.heard.firstCloud = now)));
      }
    }
    if (kind !== 1) return;
    window.heard.states += 1;
    window.heard.time = view.getFloat64(8, true);
    window.heard.tools[view.getUint8(1)] = {
      flags: view.getUint32(4, true), hip: three(view, 16), proxy: three(view, 28),
      normal: three(view, 40), force: three(view, 52),
    };
  };
  for (const end of ["WebSocket", "Worker"]) { // a program elsewhere, or in the page's own tab
    window[end] = class extends window[end] {
      constructor(...all) {
        super(...all);
        window.end = this;
        this.addEventListener("message", hear);
      }
    };
  }
  localStorage.setItem("palpate.points", "10000"); // drawn in software
}

/** ms from the page's request until the browser painted something of it, and until its first cloud was drawn. */
export function firstPaint(page) {
  return page.evaluate(() => ({
    paint: window.performance.getEntriesByName("first-contentful-paint")[0]?.startTime,
    cloud: window.heard.firstCloud,
  }));
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((x, i) => x - b[i]);
const length = (a) => Math.hypot(...a);

export const heard = (page) => page.evaluate(() => window.heard);

/** A tool's newest state in numbers: force (N), depth (m) and what they make of stiffness (N/m). */
export async function felt(page, device = 0) {
  const state = (await heard(page)).tools[device];
  if (state === undefined) return { touching: false, taken: false, paused: false, force: 0 };
  const force = length(state.force);
  const depth = length(minus(state.proxy, state.hip));
  const flag = (bit) => (state.flags & bit) !== 0;
  return { ...state, force, depth, stiffness: force / depth, touching: flag(1), paused: flag(2), taken: flag(4) };
}

/** How far hand and proxy went into the surface from one state to another, m. */
export function waysInto(from, to) {
  return { hip: -dot(from.normal, minus(to.hip, from.hip)), proxy: -dot(from.normal, minus(to.proxy, from.proxy)) };
}

export const distance = (a, b) => length(minus(a, b));
