// Records a run and does it again.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"

namespace palpate::app {

/// Records `touch ARGUMENTS` without a page as run.mcap, with its report run.json, and does it
/// again: expects the same forces, bit for bit. The replay's report.
inline Json record_and_replay(Shell& shell, const std::string& arguments) {
  const Outcome run =
      shell.run("touch " + arguments + " --no-view --record run.mcap --json run.json");
  EXPECT_EQ(run.code, 0) << run.err;
  const Outcome replay = shell.run("replay run.mcap --json replay.json");
  EXPECT_EQ(replay.code, 0) << replay.out << replay.err;
  Json found = Json::parse(shell.read("replay.json"));
  EXPECT_TRUE(found["exact"]) << replay.out;
  EXPECT_FALSE(found["hands"].empty());
  for (const Json& hand : found["hands"]) {
    EXPECT_EQ(hand["largest_difference_N"], 0.0);
    EXPECT_GT(hand["steps"], 100);
  }
  return found;
}

}  // namespace palpate::app
