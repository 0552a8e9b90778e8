// A hand that holds hardware: the makers' libraries are doubles (tests/device/fake_dhd.cpp,
// fake_hd.cpp).
#include <gtest/gtest.h>

#include "apps/program.hpp"
#include "support/contains.hpp"

namespace palpate::app {
namespace {

using test::contains;

const std::string kDevice = std::string("--device forcedimension,library=") + PALPATE_FAKE_DHD;

TEST(HardwareProgram, RunsWithWhatADriverReaches) {
  Shell shell;
  const Outcome outcome =
      shell.run("touch synthetic:torus --duration 0.5 --json report.json " + kDevice);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "using forcedimension:0 (omega.3)")) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "origin ")) << outcome.out;
  const std::string report = shell.read("report.json");
  EXPECT_TRUE(contains(report, "origin_m")) << report;
  EXPECT_TRUE(contains(report, "forcedimension:0 (omega.3)")) << report;
}

TEST(HardwareProgram, RunsInTheMakersScheduler) {
  Shell shell;
  const Outcome outcome = shell.run(
      "touch synthetic:torus --duration 0.5 --json report.json --device "
      "openhaptics,library=" PALPATE_FAKE_HD);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "using openhaptics:Default Device (Touch)")) << outcome.err;
  EXPECT_TRUE(contains(shell.read("report.json"), "openhaptics:Default Device (Touch)"));
}

TEST(HardwareProgram, DevicesOfTwoMakersHoldOneScene) {
  Shell shell;
  const Outcome outcome = shell.run("touch synthetic:torus --duration 0.5 --json report.json " +
                                    kDevice + " --device openhaptics,library=" PALPATE_FAKE_HD);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string report = shell.read("report.json");
  EXPECT_TRUE(contains(report, "forcedimension:0 (omega.3)")) << report;
  EXPECT_TRUE(contains(report, "openhaptics:Default Device (Touch)")) << report;
}

TEST(HardwareProgram, SaysWhyItIsNotThere) {
  Shell shell;
  const auto refused = [&](const std::string& device, int code, const std::string& word) {
    const Outcome outcome = shell.run("touch synthetic:torus " + device);
    EXPECT_EQ(outcome.code, code) << device;
    EXPECT_TRUE(contains(outcome.err, word)) << outcome.err;
  };
  refused("--device forcedimension,library=/none/libdhd.so.3", 1, "/none/libdhd.so.3");
  refused("--device forcedimension,libary=x", 1, "libary");
  refused("--device phantom", 2, "palpate devices");
  refused(kDevice + " " + kDevice, 2, "two hands cannot share");
  refused(kDevice + " --simulated-time", 2, "real time");
}

TEST(HardwareProgram, MeasuresWallsOnlyWhenSomebodyHasConfirmed) {
  Shell shell;
  const Outcome unasked = shell.run("zwidth " + kDevice);
  EXPECT_EQ(unasked.code, 2) << unasked.err;
  EXPECT_TRUE(contains(unasked.err, "This moves the device")) << unasked.err;
  EXPECT_TRUE(contains(unasked.err, "--confirm")) << unasked.err;
  EXPECT_FALSE(contains(unasked.err, "using forcedimension")) << "it was opened";
  const Outcome alone = shell.run("zwidth --confirm --patience 0.7 --json found.json " + kDevice);
  EXPECT_EQ(alone.code, 1) << alone.err;
  EXPECT_TRUE(contains(alone.err, "hold the device still")) << alone.err;
  // A machine that is too slow for the device loses it.
  EXPECT_TRUE(contains(alone.err, "timed out") || contains(alone.err, "stopped responding"))
      << alone.err;
  EXPECT_TRUE(contains(shell.read("found.json"), "stable_N_per_m")) << shell.read("found.json");
  EXPECT_EQ(shell.run("zwidth --confirm").code, 2) << "of which device?";
  EXPECT_EQ(shell.run("zwidth --rate 1000 " + kDevice).code, 2) << "both simulated and not";
}

}  // namespace
}  // namespace palpate::app
