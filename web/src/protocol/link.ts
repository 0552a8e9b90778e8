// The part of the address after '#': the program's token, where it has one, then settings as key=value, and the view.
// A person with such a link may steer the program: it says so where it is copied.

import type { Setting, SettingValue, Vector, Welcome } from "./messages";

/** Where the eye is and what it looks at, both less the scene's origin (m), and what is up. */
export interface View {
  eye: Vector;
  target: Vector;
  up: Vector;
}

export interface Link {
  token: string;
  values: Map<string, string>;
  view?: View;
}

const kView = "view"; // no setting has that key
const kDigits = 9; // a heading from above is a thousandth of the distance; of a millionth of that nobody sees anything
const kFarthest = 1e9; // m; farther than any cloud, and its square is a number

export function readLink(fragment: string): Link {
  const parts = fragment.replace(/^#/, "").split("&");
  const token = parts[0]?.includes("=") === true ? "" : (parts.shift() ?? "");
  const values = new Map<string, string>();
  for (const part of parts) {
    const at = part.indexOf("=");
    if (at <= 0) continue;
    values.set(unescapePart(part.slice(0, at)), unescapePart(part.slice(at + 1)));
  }
  const view = viewFromText(values.get(kView));
  if (view === undefined) return { token: unescapePart(token), values };
  values.delete(kView);
  return { token: unescapePart(token), values, view };
}

export function writeLink(token: string, values: Iterable<[string, SettingValue]>, view?: View): string {
  const parts = token === "" ? [] : [encodeURIComponent(token)];
  for (const [key, value] of values) {
    parts.push(`${encodeURIComponent(key)}=${encodeURIComponent(String(value))}`);
  }
  if (view !== undefined) {
    const numbers = [view.eye, view.target, view.up].flat().map((value) => Number(value.toPrecision(kDigits)));
    parts.push(`${kView}=${numbers.join()}`);
  }
  return `#${parts.join("&")}`;
}

function viewFromText(text: string | undefined): View | undefined {
  const numbers = text?.split(",").map((one) => (one.trim() === "" ? NaN : Number(one)));
  if (numbers?.length !== 9 || !numbers.every((value) => Math.abs(value) <= kFarthest)) return undefined;
  const [a, b, c, d, e, f, g, h, i] = numbers as [number, number, number, number, number, number, number, number, number];
  const [distance, upward] = [Math.hypot(a - d, b - e, c - f), Math.hypot(g, h, i)];
  const isView = distance > 1e-6 * Math.hypot(a, b, c, d, e, f) && upward > 0; // less is rounding
  return isView ? { eye: [a, b, c], target: [d, e, f], up: [g / upward, h / upward, i / upward] } : undefined;
}

/** The value that a link's text means for a setting; undefined where it cannot be one. */
export function settingFromText(setting: Setting, text: string): SettingValue | undefined {
  if (setting.kind === "switch") {
    return text === "true" ? true : text === "false" ? false : undefined;
  }
  if (setting.kind === "choice") return setting.choices?.includes(text) ? text : undefined;
  const value = Number(text);
  if (text.trim() === "" || !Number.isFinite(value)) return undefined;
  const { least = -Infinity, most = Infinity } = setting;
  return value >= least && value <= most ? value : undefined;
}

/** Sets what a link asks for, and says what it cannot. What begins the run anew comes first and alone: true, and the rest
 * of the link is to be set in that run; so is all of it where there are no settings yet, as while clouds are read. */
export function applyLink(
  link: Link, { settings, timeline }: Pick<Welcome, "settings" | "timeline">,
  set: (key: string, value: SettingValue) => void, warn: (text: string) => void,
): boolean {
  const waits = settings.length === 0 && timeline === undefined; // a recording gets none
  if (waits) return link.values.size > 0 || link.view !== undefined;
  const wanted = [...link.values].map(([key, text]) => {
    const setting = settings.find((one) => one.key === key);
    return { key, text, setting, value: setting === undefined ? undefined : settingFromText(setting, text) };
  });
  const anew = wanted.find(({ setting, value }) => setting?.restarts === true && value !== undefined && value !== setting.value);
  if (anew !== undefined) {
    link.values.delete(anew.key);
    set(anew.key, anew.value!);
    return true;
  }
  for (const { key, text, setting, value } of wanted) {
    if (value === undefined) warn(`the link's ${key} = ${text} is not a setting of this run`);
    else if (value !== setting?.value) set(key, value);
  }
  return false;
}

function unescapePart(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
