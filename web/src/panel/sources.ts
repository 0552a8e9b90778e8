// Table of what is felt: who sends, how often, how much, how old.

import type { SourceHistory } from "../model/session";
import { sourceColour } from "../view/colours";
import { byId, make, say } from "./dom";
import { distrust, fewer, millimetres, seconds, short } from "./numbers";

interface Row {
  rows: HTMLTableSectionElement;
  update(): void;
}

const kBad = new Set(["stalled", "failed"]);

function cell(title: string): HTMLTableCellElement {
  return make("td", { title });
}

function makeRow(source: SourceHistory, index: number, changed: () => void): Row {
  const box = make("input", {
    type: "checkbox", class: "swatch", "aria-label": `Show ${source.name}`, title: "Show in the view",
    change: () => {
      source.visible = box.checked;
      changed();
    },
  });
  box.checked = source.visible;
  box.style.setProperty("--swatch", `var(${sourceColour(index)})`);
  const phase = make("small");
  const rate = cell("frames per second");
  const points = cell("points");
  const latency = cell("latency from frame to touchable surface");
  const age = cell("age of the rendered surface");
  const dropped = cell("frames dropped");
  const trust = make("td", { colspan: 5, class: "trust" });
  const name = make("th", { scope: "rowgroup", colspan: 5 },
    make("label", {}, box, make("span", {}, source.name), phase));
  return {
    rows: make("tbody", {},
      make("tr", {}, name), make("tr", {}, rate, points, latency, age, dropped), make("tr", {}, trust)),
    update: () => {
      const report = source.report;
      if (report === undefined) return;
      const { rate: hertz = 0, disagreement = 0 } = report;
      const apart = disagreement > 0 ? ` · ${millimetres(disagreement)} apart` : "";
      say(phase, report.phase + apart);
      phase.classList.toggle("bad", kBad.has(report.phase));
      say(rate, hertz > 0 ? hertz.toFixed(hertz < 9.95 ? 1 : 0) : "–");
      say(points, short(report.points ?? 0));
      say(latency, source.camera ? seconds(report.latency ?? NaN) : "–");
      say(age, source.camera ? seconds(report.age ?? NaN) : "–");
      say(dropped, short(report.dropped ?? 0));
      say(trust, [fewer(source.shown, report.points ?? 0), distrust(source.untrusted)].filter(Boolean).join("; "));
    },
  };
}

export class SourcesPanel {
  private rows: Row[] = [];

  begin(sources: readonly SourceHistory[], changed: () => void): void {
    this.rows = sources.map((source, i) => makeRow(source, i, changed));
    const head = ["Hz", "Points", "Latency", "Age", "Drops"].map((text) =>
      make("th", { scope: "col" }, text),
    );
    byId("sources").replaceChildren(
      make("table", { class: "table" },
        make("thead", {}, make("tr", {}, ...head)),
        ...this.rows.map(({ rows }) => rows)),
    );
  }

  /** `robot`: what one that follows a tool does; undefined: there is none. */
  update(robot?: string): void {
    for (const row of this.rows) row.update();
    const line = byId("robot");
    line.hidden = robot === undefined;
    say(line, robot ?? "");
  }
}
