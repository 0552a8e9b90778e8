// Every guard on, a stiffness that the device can bear: no surface gives a hand more than it put
// in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>

#include "palpate/device/exploration.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "safety/given_energy.hpp"
#include "support/effort.hpp"
#include "support/kind_name.hpp"
#include "support/point_shapes.hpp"
#include "support/random_hand.hpp"
#include "support/snapshots.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 300'000;
constexpr int kExplored = 5'000;  // steps

constexpr double kMost = 1e-3;  // given in all, J

// Given in one contact, J, where the brake may owe more for a while: it is never stronger than a
// sampled damper can be.
struct MostOwed {
  double in_a_contact;
  double beyond_the_spring;
};
constexpr MostOwed kByExplorations{1e-3, 1.5e-3};
constexpr MostOwed kByRandomHands{1e-3, 25e-3};
constexpr MostOwed kByThreeSteps{40e-3, 40e-3};  // of delay

// `of`: what the numbers are of, where a test has more than one.
void expect_paid(const GivenEnergy& given, const MostOwed& owed, const std::string& of = "") {
  const auto record = [&of](const char* name, double energy) {
    testing::Test::RecordProperty(name + of, std::to_string(energy));
  };
  record("in_all_J", given.in_all);
  record("in_a_contact_J", given.in_a_contact);
  record("beyond_the_spring_J", given.beyond_the_spring);
  EXPECT_LE(given.in_all, kMost);
  EXPECT_LE(given.in_a_contact, owed.in_a_contact);
  EXPECT_LE(given.beyond_the_spring, owed.beyond_the_spring);
  EXPECT_GT(given.largest_force, 0.5) << "hardly anything was touched";
}

// A person who wants to go where RandomHand goes.
class RandomGuide final : public TargetSource {
 public:
  explicit RandomGuide(const RandomHand& hand) : hand_(hand) {}
  [[nodiscard]] TargetSource::Target target(double, const Vector3d&) noexcept override {
    return {hand_.next(), 0};
  }

 private:
  RandomHand hand_;
};

struct EnergyFuzzScene {
  const char* name;
  std::vector<TestPoint> points;
};

std::vector<EnergyFuzzScene> energy_fuzz_scenes() {
  const Sampling clean;
  const Sampling noisy{.jitter = 0.2, .noise = 0.25, .tilt = 0.1};
  return {{"sphere", ball(clean, 0.03)},
          {"noisy_sphere", ball(noisy, 0.03)},
          {"sheet", sheet(noisy, 0.03)},
          {"plate", plate(noisy, 0.03, 0.008)},
          {"corner", wedge(noisy, std::numbers::pi / 2, 0.03)}};
}

using EnergyFuzzCase = std::tuple<int, FieldOptions::Kind>;
class EnergyFuzz : public testing::TestWithParam<EnergyFuzzCase> {};

TEST_P(EnergyFuzz, NoSurfaceGivesMoreThanWasPutIn) {
  const auto& [index, kind] = GetParam();
  const EnergyFuzzScene made = energy_fuzz_scenes()[static_cast<std::size_t>(index)];
  Scene scene;
  scene.add("points").publish(still(made.points));
  ServoOptions options;
  options.field.kind = kind;
  for (const auto& [mu, delay] : {std::pair{0.0, 1}, {0.4, 1}, {0.0, 3}, {0.4, 3}}) {
    options.proxy.friction = {.static_coefficient = mu, .dynamic_coefficient = mu};
    RandomGuide guide(
        RandomHand(31 * static_cast<unsigned>(index) + static_cast<unsigned>(kind), 0.045));
    SimulatedDevice device({.delay = delay}, guide);
    const GivenEnergy given = given_energy(device, scene, options, effort(kSteps));
    SCOPED_TRACE(testing::Message() << "friction " << mu << ", delay " << delay);
    expect_paid(given, delay == 1 ? kByRandomHands : kByThreeSteps,
                (mu > 0 ? "_with_friction" : "") + std::string("_delay_") + std::to_string(delay));
    EXPECT_GT(given.contacts, effort(kSteps) / 10'000) << "friction " << mu;
  }
}

std::string energy_fuzz_name(const testing::TestParamInfo<EnergyFuzzCase>& tested) {
  const auto& [index, kind] = tested.param;
  return std::string(energy_fuzz_scenes()[static_cast<std::size_t>(index)].name) + "_" +
         kind_name(kind);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EnergyFuzz,
                         testing::Combine(testing::Range(0, 5),
                                          testing::Values(FieldOptions::Kind::metaball,
                                                          FieldOptions::Kind::pointset,
                                                          FieldOptions::Kind::balanced)),
                         energy_fuzz_name);

TEST(Energy, WithoutTheGuardAStiffBallGivesWhatNobodyPutIn) {
  Scene scene;
  scene.add("points").publish(still(ball({}, 0.03)));
  ServoOptions options;
  options.proxy.stiffness = 2000;
  options.guard.on = false;
  RandomGuide guide(RandomHand(1, 0.045));
  SimulatedDevice device({}, guide);
  const GivenEnergy given = given_energy(device, scene, options, kSteps);
  EXPECT_GT(given.in_all, 10 * kMost);
  EXPECT_GT(given.beyond_the_spring, 1.5 * kByRandomHands.beyond_the_spring);
}

// A sheet that heaves: 5 mm up and down at 1 Hz, in snapshots of 30 ms, as a camera's surface does.
class HeavingSheet {
 public:
  explicit HeavingSheet(Source& source) : source_(source) {}

  void show(double time) {
    if (time < end_) return;
    const double start = end_;
    end_ += kInterval;
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->start = start;
    snapshot->end = end_;
    snapshot->layers.push_back({moving(height(start), height(end_)), 1, 1});
    source_.publish(std::move(snapshot));
  }

 private:
  static constexpr double kInterval = 0.03;

  static double height(double time) { return 5e-3 * std::sin(2 * std::numbers::pi * time); }

  static std::shared_ptr<const SurfacePoints> moving(double from, double to) {
    SurfacePoints points = make_points(plane(from));
    for (const auto& p : points.grid.points()) {
      points.end_positions.push_back(p + Eigen::Vector3f(0, 0, static_cast<float>(to - from)));
    }
    finish(points);
    return share(std::move(points));
  }

  Source& source_;
  double end_ = 0;
};

TEST(Energy, AHeavingSheetGivesNoMoreThanItDoesItself) {
  Scene scene;
  HeavingSheet sheet(scene.add("sheet"));
  SimulatedDevice device({}, {{0, {0, 0, 0.01}}, {1, {0, 0, -4e-3}}, {20, {0.02, 0.01, -4e-3}}});
  const int steps = std::max(1'000, effort(10'000));  // at least until it is pressed
  const GivenEnergy given =
      given_energy(device, scene, {}, steps, [&](double time) { sheet.show(time); });
  expect_paid(given, kByExplorations);
}

// An exploration as `palpate touch` plans it, on a surface as stiff as the device bears.
void expect_exploration_is_paid(const PointCloud& cloud) {
  Scene scene;
  scene.add("cloud", cloud);
  ServoOptions options;
  const Placement plan = plan_exploration(scene, options.field, {.duration = 1e-3 * kExplored});
  options.workspace = plan.workspace;
  options.proxy.stiffness = plan.stiffness;
  SimulatedDevice device({}, plan.target);
  expect_paid(given_energy(device, scene, options, kExplored), kByExplorations);
}

class SyntheticEnergy : public testing::TestWithParam<std::string> {};

TEST_P(SyntheticEnergy, ExplorationGivesNoMoreThanWasPutIn) {
  expect_exploration_is_paid(synthetic_cloud(GetParam()));
}

std::string energy_test_name(const testing::TestParamInfo<std::string>& tested) {
  std::string name = std::filesystem::path(tested.param).stem();
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

std::vector<std::string> clouds_to_pay_for() {
  std::vector<std::string> names;
  for (const SyntheticName& each : synthetic_names()) names.emplace_back(each.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Of, SyntheticEnergy, testing::ValuesIn(clouds_to_pay_for()),
                         energy_test_name);

class RealEnergy : public testing::TestWithParam<std::string> {};

TEST_P(RealEnergy, ExplorationGivesNoMoreThanWasPutIn) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  if (is_slow_build()) GTEST_SKIP() << kSlowBuild;
  const std::filesystem::path file = std::filesystem::path(data) / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no such file: " << file;
  ReadOptions options;
  options.intrinsics = Pinhole{.fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5};
  expect_exploration_is_paid(read_cloud(file, options));
}

INSTANTIATE_TEST_SUITE_P(
    Of, RealEnergy,
    testing::Values("stanford_bunny/bun_zipper.ply", "stanford_dragon/dragon_vrip.ply.gz",
                    "pcl_tabletop/osd_test0.pcd", "pcl_tabletop/room_scan1.pcd",
                    "realsense_makerspace_mit/depth/000125.png", "redwood_open3d_mit/fragment.pcd",
                    "multiview_shelf_apc/depth/000000.png", "pdal_small/autzen_trim.las",
                    "lamppost/lamppost.pcd"),
    energy_test_name);

}  // namespace
}  // namespace palpate::test
