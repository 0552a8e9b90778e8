// The real-time contract (docs/architecture.md, contract 1) on every path that a servo step takes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "realtime/rig.hpp"

namespace palpate::realtime {
namespace {

using Eigen::Vector3d;

constexpr double kSpacing = 2e-3;  // m
constexpr double kRadius = 5e-3;   // m
constexpr double kExtent = 0.06;   // m, half an edge

// A square of gently waved ground around `center`, normals up.
PointCloud ground(const Vector3d& center = Vector3d::Zero()) {
  PointCloud cloud;
  cloud.origin = center;
  for (double x = -kExtent; x <= kExtent; x += kSpacing) {
    for (double y = -kExtent; y <= kExtent; y += kSpacing) {
      const double z = 1e-3 * std::sin(x / 0.01) * std::sin(y / 0.01);
      cloud.positions.push_back(Vector3d(x, y, z).cast<float>());
    }
  }
  cloud.viewpoint = center + Vector3d(0, 0, 1);
  return cloud;
}

SourceOptions prepared_with(double radius) {
  SourceOptions options;
  options.prepare.voxel = 0;
  options.prepare.radius = radius;
  return options;
}

// Down from free space, 4 mm in, across, over the edge, back in from there, and up.
void tour(Rig& rig) {
  rig.move({0, 0, 0.05}, 1);
  rig.move({0, 0, -0.004}, 60);
  rig.move({0.03, 0.02, -0.004}, 200);
  rig.move({0.09, 0.02, -0.004}, 300);
  rig.move({0.02, 0.01, -0.004}, 300);
  rig.move({0, 0, 0.05}, 60);
}

void expect_clean(const Run& run) {
  EXPECT_EQ(run.offences.total(), 0) << run.offences;
  EXPECT_EQ(run.infinite, 0);
}

class ServoStep : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_trap_system_calls()) {
      GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
    }
  }
  Scene scene_;
};

struct Case {
  const char* name;
  FieldOptions field;
  ProxyOptions proxy;
};

Case plain(const char* name, FieldOptions::Kind kind) {
  return {name, FieldOptions{.kind = kind}, ProxyOptions{}};
}

std::vector<Case> cases() {
  std::vector<Case> all = {plain("balanced", FieldOptions::Kind::balanced),
                           plain("pointset", FieldOptions::Kind::pointset),
                           plain("metaball", FieldOptions::Kind::metaball)};
  all.push_back({"wendland", FieldOptions{.kernel = Kernel::wendland}, {}});
  all.push_back(
      {"paper", paper_field(), ProxyOptions{.method = ProxyOptions::Method::single_step}});
  ProxyOptions rough;
  rough.friction = {.static_coefficient = 0.5, .dynamic_coefficient = 0.3, .viscous = 2};
  rough.texture = {.amplitude = 5e-5, .wavelength = 4e-3};
  all.push_back({"rough", {}, rough});
  return all;
}

class ServoStepOf : public ServoStep, public testing::WithParamInterface<Case> {};

TEST_P(ServoStepOf, KeepsTheContractInFreeSpaceContactAndOverTheEdge) {
  scene_.add("ground", ground(), prepared_with(kRadius));
  Rig rig(scene_, GetParam().field, GetParam().proxy);
  tour(rig);
  EXPECT_GT(rig.run().touching, 300);
  EXPECT_LT(rig.run().touching, rig.run().steps - 50);
  expect_clean(rig.run());
}

INSTANTIATE_TEST_SUITE_P(Kinds, ServoStepOf, testing::ValuesIn(cases()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_F(ServoStep, KeepsTheContractWhileSlidingWithFriction) {
  scene_.add("ground", ground(), prepared_with(kRadius));
  ProxyOptions rough;
  rough.friction = {.static_coefficient = 0.5, .dynamic_coefficient = 0.3, .viscous = 0};
  Rig rig(scene_, {}, rough);
  tour(rig);
  EXPECT_GT(rig.run().sliding, 100);
  expect_clean(rig.run());
}

// The first step after construction, wherever the hand is: nothing is warm.
TEST_F(ServoStep, KeepsTheContractWhenCold) {
  scene_.add("ground", ground(), prepared_with(kRadius));
  for (const double z : {1.0, 0.01, 0.001, -0.001, -0.02}) {
    Rig rig(scene_);
    rig.step({0.01, 0.01, z});
    expect_clean(rig.run());
  }
}

TEST_F(ServoStep, KeepsTheContractWithoutAnySurface) {
  scene_.add("nothing yet");
  Rig rig(scene_);
  tour(rig);
  EXPECT_EQ(rig.run().touching, 0);
  EXPECT_TRUE(has(rig.run().field_notes, FieldNote::no_surface));
  expect_clean(rig.run());
}

// More points within R than the patch holds.
TEST_F(ServoStep, KeepsTheContractWhenThePatchOverflows) {
  scene_.add("ground", ground(), prepared_with(0.05));
  Rig rig(scene_);
  tour(rig);
  EXPECT_TRUE(has(rig.run().field_notes, FieldNote::thinned));
  EXPECT_GT(rig.run().touching, 300);
  expect_clean(rig.run());
}

TEST_F(ServoStep, KeepsTheContractWhenTheHandJumps) {
  scene_.add("ground", ground(), prepared_with(kRadius));
  Rig rig(scene_);
  for (int i = 0; i < 200; ++i) {
    const double z = i % 2 == 0 ? 0.3 : -0.3;
    rig.step({0.05 * std::sin(i), 0.05 * std::cos(3 * i), z});
  }
  for (int i = 0; i < 50; ++i) rig.step({1e3 * i, -1e5, 1e8});
  expect_clean(rig.run());
}

TEST_F(ServoStep, KeepsTheContractWithTwoSources) {
  scene_.add("one", ground(), prepared_with(kRadius));
  scene_.add("other", ground({0.02, 0, 0.001}), prepared_with(2 * kRadius));
  Rig rig(scene_);
  tour(rig);
  EXPECT_GT(rig.run().touching, 300);
  expect_clean(rig.run());
}

// The same points, moving up by 2 mm while the snapshot lasts.
std::unique_ptr<const Snapshot> rising(const Source& source, double start) {
  auto points = std::make_shared<SurfacePoints>(*source.points());
  points->end_positions.assign(points->grid.points().begin(), points->grid.points().end());
  for (auto& position : points->end_positions) position.z() += 2e-3f;
  points->end_normals = points->normals;
  points->end_density_weights = points->density_weights;
  finish(*points);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = start;
  snapshot->end = start + 0.033;
  snapshot->layers.push_back({.points = std::move(points)});
  return snapshot;
}

TEST_F(ServoStep, KeepsTheContractWhileSnapshotsChange) {
  Source& source = scene_.add("ground", ground(), prepared_with(kRadius));
  Rig rig(scene_);
  int step = 0;
  rig.between_steps([&] {
    if (++step % 33 == 0) source.publish(rising(source, rig.now() + 2e-3));
  });
  tour(rig);
  EXPECT_GT(rig.run().touching, 300);
  expect_clean(rig.run());
}

// A thread that publishes as fast as it can, as no camera would.
TEST_F(ServoStep, KeepsTheContractWhileAnotherThreadPublishes) {
  Source& source = scene_.add("ground", ground(), prepared_with(kRadius));
  Rig rig(scene_);
  std::jthread publisher([&](const std::stop_token& stop) {
    for (int i = 0; !stop.stop_requested(); ++i) source.publish(rising(source, 1e-3 * (i % 900)));
  });
  tour(rig);
  publisher.request_stop();
  publisher.join();
  expect_clean(rig.run());
}

TEST_F(ServoStep, KeepsTheContractWhenTheSurfaceVanishesUnderTheProxy) {
  Source& source = scene_.add("ground", ground(), prepared_with(kRadius));
  Rig rig(scene_);
  rig.move({0, 0, 0.05}, 1);
  rig.move({0, 0, -0.004}, 60);
  source.publish(std::make_unique<const Snapshot>());
  for (int i = 0; i < 100; ++i) rig.step({0, 0, -0.004});
  source.publish(nullptr);
  for (int i = 0; i < 100; ++i) rig.step({0, 0, -0.004});
  EXPECT_LT(rig.run().touching, 150);
  expect_clean(rig.run());
}

TEST_F(ServoStep, KeepsTheContractOnFaults) {
  scene_.add("ground", ground(), prepared_with(kRadius));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    Rig rig(scene_);
    rig.move({0, 0, 0.05}, 1);
    rig.move({0, 0, -0.004}, 60);
    EXPECT_GT(rig.step({0, 0, -0.004}).force.norm(), 0);
    EXPECT_EQ(rig.step({0, bad, -0.004}).force, Vector3d::Zero());
    EXPECT_EQ(rig.step({0, 0, -0.004}).force, Vector3d::Zero()) << "the fault stays";
    EXPECT_TRUE(has(rig.run().contact_notes, ContactNote::fault));
    expect_clean(rig.run());
  }
}

TEST_F(ServoStep, KeepsTheContractWhenTheClockIsNotFinite) {
  Source& source = scene_.add("ground", ground(), prepared_with(kRadius));
  Rig rig(scene_);
  source.publish(rising(source, 0));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300}) {
    rig.set_now(bad);
    tour(rig);
  }
  expect_clean(rig.run());
}

}  // namespace
}  // namespace palpate::realtime
