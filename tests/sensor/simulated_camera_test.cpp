#include "sim/simulated_camera.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numbers>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// Goes on by `tick` whenever it is asked.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(double now, double tick) : now_(now), tick_(tick) {}
  [[nodiscard]] double now() const noexcept override {
    const double now = now_;
    now_ = now + tick_;
    return now;
  }
  void set(double now) { now_ = now; }

 private:
  mutable std::atomic<double> now_;
  double tick_;
};

SimulatedCameraOptions small() {
  SimulatedCameraOptions options = make_simulated_setup("table").camera;
  options.camera = {64, 48, {52, 52, 31.5, 23.5}, {}};
  return options;
}

SimulatedCamera table_camera(const SimulatedCameraOptions& options) {
  return {make_simulated_setup("table").scene, options};
}

std::vector<DepthFrame> frames_of(SimulatedCamera& camera, int count) {
  std::vector<DepthFrame> frames;
  for (int i = 0; i < count; ++i) {
    frames.emplace_back();
    EXPECT_EQ(camera.read(frames.back(), 0), DepthCamera::Status::frame);
  }
  return frames;
}

TEST(SimulatedCamera, BeginsAgainWithoutAClockAlone) {
  SimulatedCamera camera = table_camera(small());
  const std::vector<DepthFrame> before = frames_of(camera, 3);
  camera.begin(5);
  for (int k = 0; const DepthFrame& frame : frames_of(camera, 3)) {
    EXPECT_NEAR(frame.stamp, 5 + k / 30.0, 1e-12);
    EXPECT_EQ(frame.depth, before[static_cast<std::size_t>(k)].depth);
    ++k;
  }
  const FakeClock clock(100, 1e-3);
  SimulatedCameraOptions options = small();
  options.clock = &clock;
  SimulatedCamera live = table_camera(options);
  live.begin(5);
  DepthFrame frame;
  ASSERT_EQ(live.read(frame, 1), DepthCamera::Status::frame);
  EXPECT_GE(frame.stamp, 100) << "it sees what happens now";
}

TEST(SimulatedCamera, TakesFrameKAtItsTime) {
  SimulatedCameraOptions options = small();
  options.phase = 0.013;
  options.start = 5;
  SimulatedCamera camera = table_camera(options);
  EXPECT_FALSE(camera.info().paces);
  for (int k = 0; const DepthFrame& frame : frames_of(camera, 5)) {
    EXPECT_NEAR(frame.stamp, 5.013 + k / 30.0, 1e-12);
    EXPECT_EQ(frame.depth.size(), 64u * 48u);
    ASSERT_TRUE(frame.T_world_sensor);
    EXPECT_TRUE(frame.T_world_sensor->isApprox(options.T_world_camera, 1e-12));
    ++k;
  }
}

TEST(SimulatedCamera, ShowsTheSceneAtTheStamp) {
  SimulatedCameraOptions options = small();
  options.noise.kind = NoiseKind::none;
  options.noise.silhouettes = false;
  options.noise.rounding = 0;
  options.rate = 1;
  SimulatedCamera camera = table_camera(options);
  DepthFrame frame;
  for (int k = 0; k < 4; ++k) {
    ASSERT_EQ(camera.read(frame, 0), DepthCamera::Status::frame);
    EXPECT_EQ(frame.depth, camera.exact_depth());
    for (std::size_t i = 0; i < frame.depth.size(); i += 37) {
      const auto u = static_cast<double>(i % 64);
      const auto v = static_cast<double>(i / 64);
      const Eigen::Vector3d x =
          camera.true_pose(k) *
          (frame.depth[i] * Eigen::Vector3d((u - 31.5) / 52, (v - 23.5) / 52, 1));
      EXPECT_LT(std::abs(distance_and_normal(camera.scene(), x, k).value), 2e-6);
    }
  }
}

TEST(SimulatedCamera, IsTheSameForTheSameSeed) {
  SimulatedCameraOptions options = small();
  options.jitter = 0.01;
  options.dropped = 0.3;
  SimulatedCamera a = table_camera(options);
  SimulatedCamera b = table_camera(options);
  options.noise.seed = 1;
  SimulatedCamera other = table_camera(options);
  const std::vector<DepthFrame> first = frames_of(a, 20);
  const std::vector<DepthFrame> second = frames_of(b, 20);
  const std::vector<DepthFrame> third = frames_of(other, 20);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].stamp, second[i].stamp);
    EXPECT_EQ(first[i].depth, second[i].depth);
    EXPECT_NE(first[i].depth, third[i].depth);
  }
}

TEST(SimulatedCamera, JittersAndDropsAsTold) {
  SimulatedCameraOptions options = small();
  options.jitter = 0.015;
  options.dropped = 0.25;
  SimulatedCamera camera = table_camera(options);
  double widest = 0;
  double last = -1;
  int k = 0;
  for (const DepthFrame& frame : frames_of(camera, 300)) {
    EXPECT_GT(frame.stamp, last);
    last = frame.stamp;
    k = static_cast<int>(std::lround(frame.stamp * 30));
    widest = std::max(widest, std::abs(frame.stamp - k / 30.0));
  }
  EXPECT_LE(widest, 0.015 + 1e-12);
  EXPECT_GT(widest, 0.014);
  EXPECT_NEAR(k, 400, 40);
}

TEST(SimulatedCamera, EndsLoopsAndMayKeepItsPoseToItself) {
  SimulatedCameraOptions options = small();
  options.loop = 3;
  options.frames = 7;
  options.report_pose = false;
  SimulatedCamera camera = table_camera(options);
  const std::vector<DepthFrame> frames = frames_of(camera, 7);
  EXPECT_EQ(frames[0].depth, frames[3].depth);
  EXPECT_EQ(frames[2].depth, frames[5].depth);
  EXPECT_NE(frames[0].depth, frames[1].depth);
  EXPECT_LT(frames[0].stamp, frames[3].stamp);
  EXPECT_FALSE(frames[0].T_world_sensor);
  DepthFrame frame;
  EXPECT_EQ(camera.read(frame, 0), DepthCamera::Status::ended);
}

TEST(SimulatedCamera, RepeatsFramesAndJumpsAsTold) {
  SimulatedCameraOptions options = small();
  options.frames = 200;
  options.repeated = 0.2;
  options.dropped = 0.1;
  options.jump = 2;
  SimulatedCamera camera = table_camera(options);
  EXPECT_FALSE(camera.info().repeats) << "it is a fault";
  DepthFrame frame;
  std::vector<float> before;
  double last = -1;
  int frames = 0;
  int repeated = 0;
  while (camera.read(frame, 0) == DepthCamera::Status::frame) {
    repeated += frame.depth == before ? 1 : 0;
    before = frame.depth;
    EXPECT_GT(frame.stamp, last);
    EXPECT_EQ(frame.stamp > 2 + 99.5 / 30, last >= 0 && frame.stamp > 99.5 / 30);
    last = frame.stamp;
    ++frames;
  }
  EXPECT_NEAR(repeated, 0.2 * frames, 15);
  EXPECT_NEAR(last, 2 + 199 / 30.0, 0.2);
}

TEST(SimulatedCamera, WaitsForItsClockAndLosesWhatNobodyAskedFor) {
  FakeClock clock(100, 1e-4);
  SimulatedCameraOptions options = small();
  options.clock = &clock;
  SimulatedCamera camera = table_camera(options);
  EXPECT_TRUE(camera.info().paces);
  DepthFrame frame;
  EXPECT_EQ(camera.read(frame, 1), DepthCamera::Status::frame);
  EXPECT_NEAR(frame.stamp, 100, 1e-3);
  EXPECT_EQ(camera.read(frame, 0.01), DepthCamera::Status::waiting);
  EXPECT_EQ(camera.read(frame, 0.1), DepthCamera::Status::frame);
  EXPECT_NEAR(frame.stamp, 100 + 1 / 30.0, 1e-3);
  EXPECT_GE(clock.now(), frame.stamp);
  clock.set(110.01);
  EXPECT_EQ(camera.read(frame, 0.1), DepthCamera::Status::frame);
  EXPECT_NEAR(frame.stamp, 110, 1e-3);
}

TEST(SimulatedCamera, TellsAPoseThatIsOffByTheCalibrationError) {
  SimulatedCameraOptions options = small();
  options.T_camera_reported = calibration_error(0.003, 0.5 * 3.14159265358979 / 180, 7);
  SimulatedCamera camera = table_camera(options);
  DepthFrame frame;
  ASSERT_EQ(camera.read(frame, 0), DepthCamera::Status::frame);
  const Eigen::Isometry3d error = camera.true_pose(0).inverse() * *frame.T_world_sensor;
  EXPECT_NEAR(error.translation().norm(), 0.003, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(error.rotation()).angle(), 0.5 * 3.14159265358979 / 180, 1e-9);
}

TEST(SimulatedCamera, RefusesWhatMakesNoSense) {
  for (const auto& spoil : {+[](SimulatedCameraOptions& o) { o.rate = 0; },
                            +[](SimulatedCameraOptions& o) { o.jitter = 0.02; },
                            +[](SimulatedCameraOptions& o) { o.dropped = 1; },
                            +[](SimulatedCameraOptions& o) { o.repeated = 1; },
                            +[](SimulatedCameraOptions& o) { o.jump = -1; },
                            +[](SimulatedCameraOptions& o) { o.loop = -1; },
                            +[](SimulatedCameraOptions& o) { o.frames = -1; }}) {
    SimulatedCameraOptions options = small();
    spoil(options);
    EXPECT_THROW((void)table_camera(options), Error);
  }
}

TEST(SimulatedSetup, OpensEveryNamedSceneAndReadsItsKeys) {
  for (const SimulatedName& named : simulated_names()) {
    const auto camera = open_simulated(named.name + ",noise=b,seed=3,frames=1", nullptr);
    EXPECT_EQ(camera->info().name, "simulated:" + named.name);
    DepthFrame frame;
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
    const auto seen = std::count_if(frame.depth.begin(), frame.depth.end(),
                                    [](float z) { return z > 0.3f && z < 3; });
    EXPECT_GT(seen, 200000) << named.name;
    EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::ended);
  }
  EXPECT_EQ(open_simulated("", nullptr)->info().name, "simulated:table");
  EXPECT_EQ(open_simulated("still,rate=60", nullptr)->info().rate, 60);
}

TEST(SimulatedSetup, ShowsOneWorldToCamerasOfOneClock) {
  FakeClock clock(1007.3, 1e-3);
  const auto one = open_simulated("table,view=40,noise=none,width=80", &clock);
  clock.set(1013.7);
  const auto two = open_simulated("table,view=40,noise=none,width=80", &clock);
  DepthFrame first;
  DepthFrame second;
  clock.set(1013.9);
  ASSERT_EQ(one->read(first, 1), DepthCamera::Status::frame);
  clock.set(1013.9);
  ASSERT_EQ(two->read(second, 1), DepthCamera::Status::frame);
  EXPECT_EQ(first.stamp, second.stamp);
  EXPECT_EQ(first.depth, second.depth);
  EXPECT_EQ(one->scene().solids.size(), two->scene().solids.size());
}

TEST(SimulatedSetup, TurnsShrinksAndMisleads) {
  const auto plain = open_simulated("still,noise=none", nullptr);
  const auto other =
      open_simulated("still,noise=none,view=40,width=160,seed=5,error=0.003", nullptr);
  DepthFrame a;
  DepthFrame b;
  ASSERT_EQ(plain->read(a, 0), DepthCamera::Status::frame);
  ASSERT_EQ(other->read(b, 0), DepthCamera::Status::frame);
  EXPECT_EQ(b.camera.width, 160);
  EXPECT_EQ(b.camera.height, 120);
  EXPECT_NEAR(b.camera.pinhole.cx, 79.5, 1e-12);
  EXPECT_NEAR(b.camera.pinhole.fx, 525 / 4.0, 1e-12);
  const Eigen::Isometry3d turn(
      Eigen::AngleAxisd(40 * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(other->true_pose(0).isApprox(turn * plain->true_pose(0), 1e-12));
  const Eigen::Isometry3d error = other->true_pose(0).inverse() * *b.T_world_sensor;
  EXPECT_NEAR(error.translation().norm(), 0.003, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(error.rotation()).angle() * 180 / std::numbers::pi, 0.5, 1e-6);
}

TEST(SimulatedSetup, SaysWhatItDoesNotKnow) {
  for (const char* wrong : {"moon", "table,noise=d", "table,seed=-1", "table,seed=1.5",
                            "table,rate=fast", "table,rate", "table,colour=1", "table,"}) {
    EXPECT_THROW((void)open_simulated(wrong, nullptr), Error) << wrong;
  }
}

}  // namespace
}  // namespace palpate
