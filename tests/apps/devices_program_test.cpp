#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

TEST(Devices, ListsDriversAndWhatIsMissing) {
  Shell shell;
  const Outcome outcome = shell.run("devices --json devices.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word :
       {"scripted", "simulated", "remote", "Force Dimension", "Touch", "Inverse3", "ROS 2"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  const auto drivers = nlohmann::json::parse(shell.read("devices.json"));
  ASSERT_EQ(drivers.size(), 7u);
  for (const auto& driver : drivers) {
    const bool available = driver["available"].get<bool>();
    EXPECT_EQ(available, driver["missing"].get<std::string>().empty()) << driver["name"];
    if (available) continue;
    EXPECT_NE(outcome.out.find(driver["missing"].get<std::string>()), std::string::npos);
  }
}

TEST(Devices, GivesDataAloneOnStandardOutput) {
  Shell shell;
  const Outcome outcome = shell.run("devices --json -");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out).size(), 7u);
}

}  // namespace
}  // namespace palpate::app
