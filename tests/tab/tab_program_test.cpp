#include "tab/tab_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "palpate/base/error.hpp"
#include "session/length_unit.hpp"
#include "sim/simulated_scene.hpp"
#include "support/effort.hpp"
#include "tab/heard_page.hpp"
#include "tab/tab_hand.hpp"

namespace palpate::tab {
namespace {

struct Page : HeardPage {
  explicit Page(Touched touched = simulated("synthetic:torus"), const std::string& news = {})
      : HeardPage([&](Outside outside, const Clock& clock) {
          return std::make_unique<TabProgram>(std::move(touched), std::move(outside), clock, news);
        }) {}

  [[nodiscard]] double value(const std::string& key) const {
    return last("settings")["values"][key];
  }

  // Lowers the hand onto the ring of the torus, or another place that looks up, `depth` under its
  // top (world, m), and waits.
  void press(double depth, const Eigen::Vector3d& top = {0.07, 0, 0.03}) {
    const json origin = last("welcome")["origin"];
    const Eigen::Vector3d at = top - Eigen::Vector3d(origin[0], origin[1], origin[2]);
    for (int i = 0; i <= 100; ++i) {
      const double z = at.z() + 0.01 - (0.01 + depth) * i / 100;
      say({{"type", "hand"}, {"device", 0}, {"position", {at.x(), at.y(), z}}, {"buttons", 0}});
      run(12e-3);
    }
    for (int i = 0; i < 20; ++i) run(0.05);  // its force rises in 0.3 s
  }
};

TEST(TabProgram, WelcomesAPageAndShowsItsCloud) {
  Page page;
  page.run(0.1);
  const json welcome = page.last("welcome");
  EXPECT_EQ(welcome["scene"], "torus");
  EXPECT_EQ(welcome["devices"][0]["takeable"], true);
  EXPECT_GT(welcome["opens"], 1e8);
  EXPECT_EQ(page.clouds, 1);
  ASSERT_FALSE(page.states.empty());
  EXPECT_EQ(page.force(), Eigen::Vector3d::Zero());
}

// Two springs in a row, the hand's 300 N/m and the surface's 500 N/m at the hand, share the depth;
// dry friction of 0.05 N may hold a part of it.
TEST(TabProgram, AHandThatPressesOnATorusFeelsTheForceOfTwoSprings) {
  Page page;
  const double scale = page.last("welcome")["devices"][0].value("scale", 1.0);
  const double depth = 6e-3 * scale;
  page.press(depth);
  const double expected = 6e-3 * 300 * 500 / (300 + 500);
  EXPECT_NEAR(page.force().z(), expected, 0.06 + 0.05 * expected);
  EXPECT_LT(page.force().head<2>().norm(), 0.1);
  EXPECT_EQ(test::u32(page.state(), 4) & 5U, 5U) << "touching, and taken";
  page.say({{"type", "release"}, {"device", 0}});
  page.run(3);
  EXPECT_LT(page.force().norm(), 0.06) << "nobody pulls it";
}

// The table of the simulated scene, by fifteen frames a second.
TEST(TabProgram, AHandPressesOnWhatACameraSees) {
  Page page(simulated("camera:simulated:still"));
  const json welcome = page.last("welcome");
  EXPECT_EQ(welcome["scene"], "still");
  EXPECT_EQ(welcome["sources"][0]["camera"], true);
  page.run(2);
  EXPECT_GT(page.clouds, 10);
  EXPECT_NEAR(page.last("sources")["sources"][0]["rate"], 15, 0.5);
  EXPECT_EQ(page.last("notice"), json()) << "nothing is late";
  const double scale = welcome["devices"][0].value("scale", 1.0);
  page.press(6e-3 * scale, make_simulated_table().free_patch);
  const double expected = 6e-3 * 300 * 500 / (300 + 500);
  EXPECT_NEAR(page.force().z(), expected, 0.06 + 0.1 * expected);
  page.say({{"type", "set"}, {"key", "policy"}, {"value", "replace"}});
  page.run(1);
  EXPECT_NEAR(page.force().z(), expected, 0.06 + 0.1 * expected) << "by other means";
}

TEST(TabProgram, WhatACameraShowedLastStays) {
  Page page(simulated("camera:simulated:still,frames=3"));
  page.run(3);
  page.press(4e-3, make_simulated_table().free_patch);
  EXPECT_GT(page.force().z(), 0.5);
}

TEST(TabProgram, ACameraWithoutAFrameIsRefusedInWords) {
  try {
    const Page page(simulated("camera:simulated:still,phase=0.5"));
    ADD_FAILURE() << "there is nothing to touch";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "still: no frame within 0.05 s");
  }
}

TEST(TabProgram, ACameraGivesTheSameForcesAgain) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Page one(simulated("camera:simulated:desk"));
  Page other(simulated("camera:simulated:desk"));
  const Eigen::Vector3d patch = make_simulated_table().free_patch;
  one.press(4e-3, patch);
  other.press(4e-3, patch);
  EXPECT_GT(one.force().norm(), 0.1);
  EXPECT_EQ(one.force(), other.force());
}

TEST(TabProgram, TheSameCallsGiveTheSameForces) {
  Page one;
  Page other;
  one.press(4e-3);
  other.press(4e-3);
  EXPECT_GT(one.force().norm(), 0.1);
  EXPECT_EQ(one.force(), other.force());
}

TEST(TabProgram, StepsAThousandTimesASecondAndLeavesOutWhatIsTooLate) {
  Page page;
  EXPECT_NEAR(page.run(1), 1000, 1);
  EXPECT_NEAR(page.tab->run(page.now += 10), 1000 * kMostLate, 1);
  EXPECT_NEAR(page.run(1), 1000, 1);
}

TEST(TabProgram, SettingsAndPresetsActAndAreTold) {
  Page page;
  page.say({{"type", "set"}, {"key", "stiffness"}, {"value", 200}});
  EXPECT_EQ(page.value("stiffness"), 200);
  page.say({{"type", "preset"}, {"name", "rubber"}});
  EXPECT_EQ(page.value("friction"), 1);
  page.say({{"type", "set"}, {"key", "stiffness"}, {"value", 1e9}});
  EXPECT_THAT(std::string(page.last("refused")["text"]), testing::HasSubstr("Stiffness"));
  page.say({{"type", "record"}, {"on", true}});
  EXPECT_THAT(std::string(page.last("refused")["text"]), testing::HasSubstr("record"));
  EXPECT_EQ(page.opened, "");
  page.say({{"type", "set"}, {"key", "scene"}, {"value", "room"}});
  EXPECT_EQ(page.opened, "synthetic:room");
  page.say({{"type", "set"}, {"key", "scene"}, {"value", "desk"}});
  EXPECT_EQ(page.opened, "camera:simulated:desk");
}

TEST(TabProgram, ACloudIsPreparedAnewAndStaysWhereThatFails) {
  Page page;
  page.run(0.2);
  page.say({{"type", "set"}, {"key", "smoothing"}, {"value", 2}});
  EXPECT_EQ(page.value("smoothing"), 2);
  page.run(0.5);
  EXPECT_EQ(page.clouds, 2);
  page.press(4e-3);
  EXPECT_GT(page.force().norm(), 0.1);
}

// What waits while a cloud is prepared comes at once.
TEST(TabProgram, APageMaySayAnyNumberOfThingsInASecond) {
  Page page;
  for (int i = 0; i < 1000; ++i) {
    page.say({{"type", "hand"}, {"device", 0}, {"position", {0.07, 0, 0.05}}, {"buttons", 0}});
  }
  page.run(0.1);
  EXPECT_EQ(page.closed, 0);
  EXPECT_EQ(test::u32(page.state(), 4) & 4U, 4U) << "taken";
}

TEST(TabProgram, OfASliderThatMovesTheLastValueIsPrepared) {
  Page page;
  page.run(0.2);
  for (int i = 10; i <= 30; ++i) {
    page.say({{"type", "set"}, {"key", "smoothing"}, {"value", i / 10.0}});
  }
  EXPECT_EQ(page.value("smoothing"), 3);
  page.run(0.5);
  EXPECT_EQ(page.clouds, 2) << "prepared once";
}

TEST(TabProgram, APageThatTalksNonsenseIsClosedAndMayComeAgain) {
  Page page;
  for (int i = 0; i < 30; ++i) page.say({{"type", "hand"}, {"device", 7}});
  EXPECT_EQ(page.closed, 1008);
  page.said.clear();
  page.say({{"type", "ping"}, {"id", 1}});
  EXPECT_TRUE(page.said.empty()) << "nobody is there";
  page.connect();
  EXPECT_EQ(page.last("welcome")["scene"], "torus");
}

TEST(TabProgram, AHandOfAPageThatFallsSilentIsReleased) {
  Page page;
  page.press(4e-3);
  page.run(6);
  EXPECT_EQ(page.last("lost")["device"], 0);
  EXPECT_LT(page.force().norm(), 0.06);
}

TEST(TabProgram, NewsAreToldOnce) {
  Page page(simulated("torus"), "bunny.ply is cut");
  page.run(0.1);
  EXPECT_EQ(page.last("notice")["text"], "bunny.ply is cut");
  page.said.clear();
  page.connect();
  page.run(0.1);
  EXPECT_EQ(page.last("notice"), json());
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// A square floor of 900 points.
std::string floor_of(double spacing) {
  std::string rows;
  for (int i = 0; i < 900; ++i) {
    rows += std::to_string(spacing * (i % 30)) + " " + std::to_string(spacing * (i / 30)) + " 0\n";
  }
  return rows;
}

// A square plate as a printer's software writes it, 30 units a side.
std::string plate() {
  return "v 0 0 0\nv 30 0 0\nv 30 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n";
}

json unit_of(const Page& page) {
  const json welcome = page.last("welcome");
  for (const json& setting : welcome["settings"]) {
    if (std::string(setting["key"]).starts_with("unit.")) return setting;
  }
  return {};
}

double width_of(const Touched& touched) {
  return session::core_of(touched.cloud).size().x();
}

TEST(TabProgram, APersonIsAskedForTheUnitOfAFileThatStatesNone) {
  Page page(of_file(bytes_of(floor_of(20)), "floor.xyz", 0));
  EXPECT_EQ(unit_of(page)["key"], "unit.floor");
  EXPECT_EQ(unit_of(page)["value"], "m");
  EXPECT_EQ(unit_of(page)["question"], "floor: 580 x 580 x 0 mm?");
  page.say({{"type", "set"}, {"key", "unit.floor"}, {"value", "m"}});
  EXPECT_EQ(page.opened_in, 0) << "it is";
  page.say({{"type", "set"}, {"key", "unit.floor"}, {"value", "mm"}});
  EXPECT_EQ(page.opened_in, 0.001);
  page.say({{"type", "set"}, {"key", "unit.floor"}, {"value", "furlong"}});
  EXPECT_EQ(page.last("refused").is_null(), false);
}

TEST(TabProgram, AFileThatWasOpenedInAUnitIsNotAskedForAgain) {
  Touched touched = of_file(bytes_of(floor_of(20)), "floor.xyz", 0.001);
  EXPECT_NEAR(width_of(touched), 0.58, 1e-6);
  const Page page(std::move(touched));
  EXPECT_EQ(unit_of(page)["value"], "mm");
  EXPECT_FALSE(unit_of(page).contains("question"));
}

TEST(TabProgram, PartsOfMachinesAreTakenAsMillimetres) {
  Touched touched = of_file(bytes_of(plate()), "plate.obj", 0);
  EXPECT_NEAR(width_of(touched), 0.03, 1e-4) << "but for the spacing of its points";
  const Page page(std::move(touched));
  EXPECT_EQ(unit_of(page)["value"], "mm");
  EXPECT_EQ(unit_of(page)["question"], "plate: 30 x 30 x 0 mm?");
  EXPECT_EQ(unit_of(Page()), json()) << "a formula has metres";
}

TEST(TabProgram, AFileHasTheNameThatTheProgramGivesIt) {
  EXPECT_EQ(of_file(bytes_of(floor_of(1e-3)), "floor.xyz", 0).name, "floor");
  EXPECT_EQ(of_file(bytes_of(floor_of(1e-3)), "floor.xyz.gz", 0).name, "floor");
}

TEST(TabProgram, FilesAreReadByTheirBytesOrRefusedInWords) {
  Page page(of_file(bytes_of(floor_of(1e-3)), "floor.xyz", 0));
  EXPECT_EQ(page.last("welcome")["scene"], "floor");
  EXPECT_EQ(page.last("welcome")["sources"][0]["name"], "floor");
  EXPECT_THROW((void)of_file({}, "nothing.ply", 0), Error);
  EXPECT_THROW((void)of_file(bytes_of("1 2 3\n4 5\n"), "cut.xyz", 0), Error);
  EXPECT_THROW((void)simulated("synthetic:unicorn"), Error);
  EXPECT_THROW((void)simulated("camera:simulated:unicorn"), Error);
  EXPECT_THROW((void)simulated("camera:simulated:desk,rate=-1"), Error);
  EXPECT_THROW((void)simulated("camera:simulatedly"), Error);
}

}  // namespace
}  // namespace palpate::tab
