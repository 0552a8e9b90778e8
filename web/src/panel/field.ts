// One setting as a row: a slider with a number beside it, a choice, or a switch.

import type { Setting, SettingValue } from "../protocol/messages";
import { make, throttle } from "./dom";
import { inStep, Scale } from "./numbers";

export interface FieldRow {
  row: HTMLElement;
  show(value: SettingValue): void;
}

type Wanted = (value: SettingValue) => void;

const kSlider = 1000;
const kInterval = 60; // ms between messages of a moving slider
// Keys move a slider by whole steps of its setting, wherever on its scale it stands.
const kNotches: Record<string, number> = {
  ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10,
};
let made = 0;

function label(setting: Setting, id: string): HTMLElement {
  const text = make("label", { for: id }, setting.label);
  if (setting.unit) text.append(" ", make("span", { class: "unit" }, setting.unit));
  return text;
}

function numberRow(setting: Setting, id: string, wanted: Wanted): FieldRow {
  const { least = 0, most = 1, step } = setting;
  const scale = new Scale(least, most);
  const inUnit = setting.unit ? `${setting.label}, ${setting.unit}` : setting.label;
  const slider = make("input", { type: "range", min: 0, max: kSlider, step: 1, "aria-label": inUnit });
  const field = make("input", {
    type: "text", role: "spinbutton", id, "aria-valuemin": least, "aria-valuemax": most, inputmode: "decimal", autocomplete: "off",
  });
  const later = throttle<number>(kInterval, wanted);
  let held = Number(setting.value); // the program's value, or the last requested one
  const clamped = (value: number) => Math.min(most, Math.max(least, value));
  const snapped = (value: number) => {
    const near = step ? least + Math.round((value - least) / step) * step : value;
    return clamped(Number(near.toPrecision(9)));
  };
  const position = (value: number) => String(Math.round(scale.position(value) * kSlider));
  const write = (value: number) => {
    field.value = inStep(value, step);
    slider.setAttribute("aria-valuetext", `${field.value} ${setting.unit ?? ""}`.trim());
  };
  const typed = () => {
    const text = field.value.trim().replace(",", ".");
    return text === "" || text === inStep(held, step) || Number.isNaN(Number(text)) ? held : Number(text);
  };
  slider.addEventListener("input", () => {
    const value = slider.value === position(held) ? held : snapped(scale.value(Number(slider.value) / kSlider));
    write(value);
    later(value);
  });
  const move = (event: KeyboardEvent) => {
    const notches = kNotches[event.key];
    if (notches === undefined) return;
    event.preventDefault();
    const value = snapped(typed() + notches * (step ?? (most - least) / 100));
    write(value);
    slider.value = position(value);
    later(value);
  };
  slider.addEventListener("keydown", move);
  field.addEventListener("change", () => {
    const value = clamped(typed());
    write(value);
    slider.value = position(value);
    if (value !== held) wanted(value);
    held = value;
  });
  field.addEventListener("keydown", (event) => {
    if (event.key === "Escape") write(held);
    if (event.key === "ArrowUp" || event.key === "ArrowDown") move(event);
  });
  field.addEventListener("blur", () => write(held));
  return {
    row: make("div", { class: "field number" }, label(setting, id), field, slider),
    show: (value) => {
      held = Number(value);
      if (document.activeElement !== slider) slider.value = position(held);
      if (document.activeElement !== field) write(held);
    },
  };
}

function choiceRow(setting: Setting, id: string, wanted: Wanted): FieldRow {
  const options = (setting.choices ?? []).map((choice) => make("option", { value: choice }, choice));
  const select = make("select", { id, change: () => wanted(select.value) }, ...options);
  return {
    row: make("div", { class: "field choice" }, label(setting, id), select),
    show: (value) => (select.value = String(value)),
  };
}

function switchRow(setting: Setting, id: string, wanted: Wanted): FieldRow {
  const box = make("input", {
    type: "checkbox", role: "switch", id, change: () => wanted(box.checked),
  });
  return {
    row: make("div", { class: "field switch" }, label(setting, id), box),
    show: (value) => (box.checked = value === true),
  };
}

const kRows = { number: numberRow, choice: choiceRow, switch: switchRow };

export function fieldRow(setting: Setting, wanted: Wanted): FieldRow {
  made += 1;
  const field = kRows[setting.kind](setting, `field-${made}`, wanted);
  field.show(setting.value);
  return field;
}
