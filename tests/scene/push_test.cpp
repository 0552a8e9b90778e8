// Checks what pushed frames and clouds become under each policy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/base/error.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/depth_frames.hpp"
#include "support/effort.hpp"
#include "support/rates.hpp"
#include "support/snapshots.hpp"
#include "support/stream_run.hpp"

namespace palpate {
namespace {

using test::kFrame;

using Eigen::Vector3d;
using test::frame_of;
using test::height_of;
using test::looking_down;
using test::small_camera;
using test::wall;

SourceOptions depth_source(Policy policy) {
  SourceOptions options;
  options.T_world_sensor = looking_down();
  options.policy.policy = policy;
  options.policy.fit_everywhere = true;
  return options;
}

void push(Source& source, double stamp, double height) {
  source.push(frame_of(small_camera(), stamp, wall(0.5 - height)), [=] { return stamp + 0.01; });
}

// Seen from the sensor's side.
double height_at(SceneField& field, double now) {
  field.update_from(now, Vector3d::Zero(), Vector3d(0, 0, 8e-3));
  return height_of(field);
}

TEST(Push, AFrameIsASurfaceWhereTheSensorSawIt) {
  for (const Policy policy : {Policy::replace, Policy::average, Policy::crossfade, Policy::morph}) {
    Scene scene;
    Source& source = scene.add("camera", depth_source(policy));
    SceneField field(scene);
    push(source, 0, 5e-3);
    EXPECT_NEAR(height_at(field, 0.01 + kFrame), 5e-3, 20e-6) << static_cast<int>(policy);
    EXPECT_EQ(source.state().frames, 1u);
    EXPECT_NEAR(source.state().latency, 0.01, 1e-12);
    EXPECT_GT(source.state().points, 4000u);
    EXPECT_LE(source.state().points, 4800u);
  }
}

TEST(Push, FramesKeepTheSmallestRadiusThatIsAskedFor) {
  for (const Policy policy : {Policy::replace, Policy::crossfade, Policy::morph}) {
    SourceOptions options = depth_source(policy);
    options.prepare.minimum_radius = 12e-3;
    const auto smallest = [&] {
      Scene scene;
      Source& source = scene.add("camera", options);
      push(source, 0, 0);
      return source.points()->smallest_radius;
    };
    EXPECT_NEAR(smallest(), 12e-3, 1e-8);
    options.prepare.radius = 14e-3;
    EXPECT_NEAR(smallest(), 14e-3, 1e-8);
    options.prepare.radius = -1.0;
    EXPECT_THROW(smallest(), Error);
  }
}

TEST(Push, MorphGoesInAStraightLineFromFrameToFrame) {
  Scene scene;
  Source& source = scene.add("camera", depth_source(Policy::morph));
  SceneField field(scene);
  push(source, 0, 0);
  push(source, kFrame, 0);
  push(source, 2 * kFrame, 3e-3);
  height_at(field, 0.01);
  height_at(field, 0.01 + kFrame);
  const double start = 0.01 + 2 * kFrame;
  EXPECT_NEAR(height_at(field, start), 0, 20e-6);
  for (const double u : {0.25, 0.5, 0.75, 1.0, 1.5}) {
    EXPECT_NEAR(height_at(field, start + u * kFrame), 3e-3 * std::min(u, 1.0), 30e-6) << u;
  }
}

TEST(Push, ReplaceIsAHardSwap) {
  Scene scene;
  Source& source = scene.add("camera", depth_source(Policy::replace));
  SceneField field(scene);
  push(source, 0, 0);
  height_at(field, 0.01);
  push(source, kFrame, 3e-3);
  EXPECT_NEAR(height_at(field, 0.0099 + kFrame), 0, 20e-6);
  EXPECT_NEAR(height_at(field, 0.0101 + kFrame), 3e-3, 20e-6);
}

TEST(Push, ACrossfadeIsSureOfItsFirstFrameOnceItHasFadedIn) {
  Scene scene;
  Source& source = scene.add("camera", depth_source(Policy::crossfade));
  SceneField field(scene);
  push(source, 0, 0);
  for (int tick = 0; tick < 60; ++tick) height_at(field, 1e-3 * tick);
  EXPECT_EQ(field.surface(Vector3d::Zero()).presence, 1);
}

TEST(Push, AChangedSourceGoesOnInItsNewWay) {
  Scene scene;
  Source& source = scene.add("camera", depth_source(Policy::morph));
  SceneField field(scene);
  for (int k = 0; k < 3; ++k) push(source, k * kFrame, 0);
  height_at(field, 0.01 + 3 * kFrame);
  source.change(depth_source(Policy::replace));
  EXPECT_EQ(*source.options().policy.policy, Policy::replace);
  EXPECT_NEAR(height_at(field, 0.01 + 3.5 * kFrame), 0, 20e-6) << "until the next frame";
  push(source, 4 * kFrame, 3e-3);
  EXPECT_NEAR(height_at(field, 0.0099 + 4 * kFrame), 0, 20e-6);
  EXPECT_NEAR(height_at(field, 0.0101 + 4 * kFrame), 3e-3, 20e-6);
  SourceOptions none = depth_source(Policy::average);
  none.policy.history = 0;
  EXPECT_THROW(source.change(none), Error);
  push(source, 5 * kFrame, 1e-3);
  EXPECT_NEAR(height_at(field, 0.0101 + 5 * kFrame), 1e-3, 20e-6) << "as it was before";
}

TEST(Push, CloudsCannotMorph) {
  Source source("cloud", depth_source(Policy::morph));
  PointCloud cloud;
  cloud.positions.assign(10, Eigen::Vector3f::Zero());
  EXPECT_THROW(source.push(cloud, 0, [] { return 0.0; }), Error);
}

TEST(Push, RefusesTimesThatAreNone) {
  Source source("camera", depth_source(Policy::morph));
  EXPECT_THROW(source.push(frame_of(small_camera(), NAN, wall(0.5)), [] { return 0.0; }), Error);
  EXPECT_THROW(source.push(frame_of(small_camera(), 0, wall(0.5)), [] { return NAN; }), Error);
  EXPECT_EQ(source.state().frames, 0u);
}

TEST(Push, RefusesOptionsThatAreNone) {
  SourceOptions options = depth_source(Policy::average);
  options.policy.history = 8;
  EXPECT_THROW(Source("camera", options), Error);
  options.policy.history = 4;
  options.policy.fade = 0;
  EXPECT_THROW(Source("camera", options), Error);
}

// What came with the last frames of a recording is there in full, and what they saw through is not.
TEST(Push, WhatHadJustComeIsThereWhenAStreamEnds) {
  for (const double height : {-0.2, 0.1}) {
    Scene scene;
    Source& source = scene.add("camera", depth_source(Policy::morph));
    test::StreamRun run(scene);
    for (int k = 0; k < 8; ++k) {
      run.at(k * kFrame, [=, &source] { push(source, k * kFrame, k < 6 ? height : 0); });
    }
    run.at(8 * kFrame, [&] { source.keep(); });
    double last = 0;
    run.until(
        2, [](double t) { return Vector3d(0, 0, std::clamp(0.27 - 0.15 * t, -0.003, 0.15)); },
        [&](double, const Contact& contact) { last = contact.force.z(); });
    EXPECT_NEAR(last, 500 * 0.003, 0.02) << height;
  }
}

}  // namespace
}  // namespace palpate
