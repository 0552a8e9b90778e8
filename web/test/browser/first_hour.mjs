// What a person meets in the first hour.

import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./browser.mjs";
import { kSmall, text, withPage } from "./with_page.mjs";

test("work under way has one notice that stays, with a percentage, until it is done", () =>
  withPage(kSmall, async (page, program) => {
    const tell = (words, share) => program.tell({ type: "notice", level: "info", text: words, share });
    tell("reading survey.laz", 0);
    await until("no share yet", async () => /reading survey.laz\s*…/.test(await text(page, "#notices")));
    tell("reading survey.laz", 0.42);
    await until("a share", async () => /reading survey.laz\s*42 %/.test(await text(page, "#notices")));
    for (const words of ["one", "two", "three"]) program.tell({ type: "notice", level: "warning", text: words });
    await until("three others", async () => /three/.test(await text(page, "#notices")));
    assert.match(await text(page, "#notices"), /reading survey/, "others do not push it out");
    tell("preparing survey.laz", 0.1);
    await until("another", async () => /preparing survey.laz\s*10 %/.test(await text(page, "#notices")));
    assert.doesNotMatch(await text(page, "#notices"), /reading/, "one at a time");
    tell("preparing survey.laz", 1);
    await until("gone", async () => !/preparing/.test(await text(page, "#notices")));
  }));
