// The part of the address after '#': the program's token, where it has one, then settings as key=value.
// A person with such a link may steer the program: it says so where it is copied.

import type { Setting, SettingValue, Welcome } from "./messages";

export interface Link {
  token: string;
  values: Map<string, string>;
}

export function readLink(fragment: string): Link {
  const parts = fragment.replace(/^#/, "").split("&");
  const token = parts[0]?.includes("=") === true ? "" : (parts.shift() ?? "");
  const values = new Map<string, string>();
  for (const part of parts) {
    const at = part.indexOf("=");
    if (at <= 0) continue;
    values.set(unescapePart(part.slice(0, at)), unescapePart(part.slice(at + 1)));
  }
  return { token: unescapePart(token), values };
}

export function writeLink(token: string, values: Iterable<[string, SettingValue]>): string {
  const parts = token === "" ? [] : [encodeURIComponent(token)];
  for (const [key, value] of values) {
    parts.push(`${encodeURIComponent(key)}=${encodeURIComponent(String(value))}`);
  }
  return `#${parts.join("&")}`;
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
  if (waits) return link.values.size > 0;
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
