#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

// OpenNI2 is not ours: sanitizers are not to mind its locks, nor what its drivers leave behind.
void bear_with_foreign_faults(const Shell& shell) {
  shell.write("suppressions", "mutex:OpenNI2\ndeadlock:OpenNI2\nrace:OpenNI2\nthread:OpenNI2\n");
  const std::string options = "suppressions=" + shell.path("suppressions");
  setenv("TSAN_OPTIONS", options.c_str(), 1);
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
}

TEST(Cameras, ListsDriversDevicesAndWhatIsMissing) {
  Shell shell;
  bear_with_foreign_faults(shell);
  const Outcome outcome = shell.run("cameras --json cameras.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word :
       {"simulated:table", "sequence", "openni2", "freenect", "Kinect", "ros", "bag", "remote"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  const auto drivers = nlohmann::json::parse(shell.read("cameras.json"));
  ASSERT_EQ(drivers.size(), 7u);
  for (const auto& driver : drivers) {
    const bool available = driver["available"].get<bool>();
    EXPECT_EQ(available, driver["missing"].get<std::string>().empty()) << driver["name"];
    if (available) continue;
    EXPECT_NE(outcome.out.find(driver["missing"].get<std::string>()), std::string::npos);
  }
  EXPECT_EQ(drivers[0]["devices"][0]["name"], "simulated:table");
}

TEST(Cameras, GivesDataAloneOnStandardOutput) {
  Shell shell;
  bear_with_foreign_faults(shell);
  const Outcome outcome = shell.run("cameras --json -");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out).size(), 7u);
}

}  // namespace
}  // namespace palpate::app
