// Checks tools on a scan, and on clouds that follow one another.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>

#include "palpate/io/files.hpp"
#include "support/effort.hpp"
#include "support/random_hand.hpp"
#include "support/snapshots.hpp"
#include "tool/held_tool.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// A scan that is closed but for its rims, and a hand that wanders through it with three tools: at
// most a few steps are left open. Before all groups of a finger agreed on sides, more than half
// were.
TEST(ToolField, NoToolIsCaughtInAScan) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  const auto path = std::filesystem::path(data) / "stanford_dragon/dragon_vrip_res3.ply.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
  Scene scene;
  scene.add("dragon", read_cloud_file(path).cloud);
  const Box box = scene.source(0).points()->bounds();
  const Vector3d middle = 0.5 * (box.lower + box.upper);
  const int steps = effort(8000);
  unsigned seed = 11;
  int touching = 0;
  const double spacing = 0.5 * scene.source(0).points()->radius;
  for (const char* name : {"box:20x30x10", "cylinder:30x6", "gripper:6x12x30"}) {
    HeldTool held(scene, Tool::from_text(name, spacing), {});
    RandomHand hand(seed++, 0.08);
    int open = 0;
    held.reset(pose_at(middle + hand.next(), Vector3d::Zero(), 0.02));
    for (int i = 0; i < steps; ++i) {
      const double t = 1e-3 * i;
      const Vector3d turn = 3 * Vector3d(std::sin(0.5 * t), std::sin(0.7 * t), std::sin(0.3 * t));
      const ToolContact contact =
          held.step(pose_at(middle + hand.next(), turn, 0.02 + 0.02 * std::sin(t)));
      ASSERT_FALSE(has(contact.notes, ContactNote::fault));
      touching += contact.touching ? 1 : 0;
      open += has(contact.notes, ContactNote::not_converged) ? 1 : 0;
    }
    EXPECT_LE(open, steps / 50) << name;
  }
  EXPECT_GT(touching, steps / 20);
}

/// A source of snapshots of clouds, which are published one after the other.
class ClothesLine {
 public:
  void publish(const std::vector<TestPoint>& points, double now) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->start = snapshot->end = now;
    snapshot->interval = 0.05;
    snapshot->sequence = ++sequence_;
    snapshot->layers.push_back({.points = share(make_points(points))});
    source_.publish(std::move(snapshot));
  }
  Scene scene;

 private:
  Source& source_ = scene.add("clouds");
  std::uint64_t sequence_ = 0;
};

// Clouds of all sizes follow one another, some while no sample looks: their addresses come back.
TEST(ToolField, CloudsThatAreGoneAreForgotten) {
  ClothesLine clouds;
  HeldTool held(clouds.scene, Tool::box({0.02, 0.03, 0.01}, 4e-3));
  held.reset(pose_at({0, 0, 0.03}));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> half(0.01, 0.03);
  int touching = 0;
  for (int i = 0; i < 4000; ++i) {
    if (i % 47 == 0) clouds.publish(sheet({.spacing = 3e-3}, half(random)), 1e-3 * i);
    const double height = 0.012 + 0.01 * std::sin(2 * std::numbers::pi * i / 300);
    const ToolContact contact = held.step(pose_at({0, 0, height}));
    ASSERT_FALSE(has(contact.notes, ContactNote::fault)) << i;
    touching += contact.touching ? 1 : 0;
  }
  EXPECT_GT(touching, 400);
}

// A sheet that steps up by 0.4 R at a time takes the box along, as it does a point.
TEST(ToolField, ASheetThatStepsUpCarriesTheTool) {
  ClothesLine clouds;
  HeldTool held(clouds.scene, Tool::box({0.02, 0.03, 0.01}, 4e-3));
  clouds.publish(sheet({}, 0.05), 0);
  held.reset(pose_at({0, 0, 0.03}));
  held.to(pose_at({0, 0, 2e-3}), 300, 50);
  ToolContact contact;
  for (int step = 1; step <= 5; ++step) {
    clouds.publish(sheet({}, 0.05, 4e-3 * step), held.now());
    contact = held.to(pose_at({0, 0, 2e-3}), 1, 60);
    EXPECT_TRUE(contact.touching) << step;
    EXPECT_NEAR(held.pose().position.z(), 4e-3 * step + 5e-3, 1e-4) << step;
  }
}

}  // namespace
}  // namespace palpate::test
