// Runs that are shown on a page. What the page itself does is tested in a browser (tests/page).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"

namespace palpate::app {
namespace {

TEST(ViewProgram, TheDemoSaysWhereItsPageIsAndEndsWhenItIsTold) {
  Shell shell;
  const Outcome outcome = shell.run("demo --headless --duration 1 --port 0 --record demo.mcap");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(shell.run("replay demo.mcap").code, 0);
  EXPECT_NE(outcome.err.find("page: http://127.0.0.1:"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("camera:simulated:desk"), std::string::npos) << outcome.out;
}

TEST(ViewProgram, APageOnAllNetworksIsToldByItsAddressesThere) {
  Shell shell;
  if (std::system(fmt::format("hostname -I > '{}'", shell.path("all")).c_str()) != 0) GTEST_SKIP();
  std::istringstream addresses(shell.read("all"));
  const std::string run = "demo scan --headless --duration 0.5 --port 0 --listen ";
  const std::string told = shell.run(run + "0.0.0.0").err;
  for (std::string each; addresses >> each;) {
    if (each.find(':') != std::string::npos) continue;
    EXPECT_NE(told.find("from other machines: http://" + each + ":"), std::string::npos) << told;
  }
  EXPECT_EQ(shell.run(run + "127.0.0.1").err.find("other machines"), std::string::npos);
}

TEST(ViewProgram, TheDemosForceIsBounded) {
  Shell shell;
  const Outcome outcome = shell.run("demo scan --headless --duration 1 --port 0 --maximum-force 1");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("at most 1 N"), std::string::npos) << outcome.out;
}

TEST(ViewProgram, ACloudIsExploredInRealTimeWhileItIsShown) {
  Shell shell;
  const Outcome outcome =
      shell.run("touch synthetic:sphere --view --port 0 --duration 1 --json run.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("page: http://"), std::string::npos);
  const Json run = Json::parse(shell.read("run.json"));
  EXPECT_EQ(run["interrupted"], false);
  EXPECT_GE(run["real_s"], 0.9);
}

TEST(ViewProgram, AStoreThatIsReadAroundTheToolsIsShownAndNotRecorded) {
  Shell shell;
  ASSERT_EQ(shell.run("tile synthetic:terrain:2e4 --out hill").code, 0);
  const std::string run = "touch hill --cache 1M --view --port 0 --duration 0.5";
  const Outcome outcome = shell.run(run);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("page: http://"), std::string::npos);
  EXPECT_NE(outcome.out.find("points on disk"), std::string::npos) << outcome.out;
  const Outcome recorded = shell.run(run + " --record run.mcap");
  EXPECT_EQ(recorded.code, 1);
  EXPECT_NE(recorded.err.find("--record needs all of hill"), std::string::npos) << recorded.err;
}

TEST(ViewProgram, WithoutATerminalThereIsNoPageUnlessOneIsAskedFor) {
  Shell shell;
  const Outcome outcome = shell.run("touch camera:simulated --duration 0.5");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("page:"), std::string::npos) << outcome.err;
}

TEST(ViewProgram, RefusesWhatCannotBeShown) {
  Shell shell;
  EXPECT_EQ(shell.run("demo nowhere").code, 2);
  EXPECT_EQ(shell.run("demo --port 70000").code, 2);
  const Outcome nowhere = shell.run("demo --headless --duration 1 --listen 300.0.0.1");
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_NE(nowhere.err.find("--listen: '300.0.0.1' is not an IP address"), std::string::npos)
      << nowhere.err;
  EXPECT_EQ(shell.run("touch synthetic:sphere --view --simulated-time").code, 2);
}

}  // namespace
}  // namespace palpate::app
