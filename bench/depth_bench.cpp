// From a decoded 640x480 depth frame in memory to a published snapshot, beside PCL's pipelines.
// Every row says what/who/pixels. Frames of a still table-top, noise a, over and over, so that the
// filter over time works as it does in use.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <string>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "peers/peers.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::bench {
namespace {

constexpr int kFrames = 16;  // judgement: about half a second
// m, of the peers' voxel filters; judgement: as many points as palpate feels
constexpr float kLeaf = 0.003F;
// m, around the tool; judgement: the reach of a hand in a frame
constexpr double kNearRadius = 0.1;
constexpr int kWarmUp = 80;  // frames; judgement: the filter over time has filled

std::vector<DepthFrame> record_frames() {
  const auto camera = open_simulated("still,noise=a,frames=" + std::to_string(kFrames), nullptr);
  std::vector<DepthFrame> frames;
  DepthFrame frame;
  while (camera->read(frame, 1) == DepthCamera::Status::frame) frames.push_back(frame);
  return frames;
}

// Frames in a ring, with stamps that go on.
class Ring {
 public:
  explicit Ring(std::vector<DepthFrame> frames) : frames_(std::move(frames)) {}
  DepthFrame& next() {
    DepthFrame& frame = frames_[count_ % frames_.size()];
    frame.stamp = static_cast<double>(++count_) / 30;
    return frame;
  }

 private:
  std::vector<DepthFrame> frames_;
  std::size_t count_ = 0;
};

// The place near the tool: the middle of the table that the camera looks at.
const std::vector<Ball> kNear = {{Eigen::Vector3d::Zero(), kNearRadius}};

template <class Push>
void repeat(benchmark::State& state, const Push& push) {
  Ring ring(record_frames());
  for (int i = 0; i < kWarmUp; ++i) push(ring.next());
  for (auto _ : state) push(ring.next());
}

// A hand that rests so deep that its field's reach is kNearRadius and what it feels around itself.
const Eigen::Vector3d kProxy = Eigen::Vector3d::Zero();
const Eigen::Vector3d kHand(0, 0, -0.1034);  // m

// m, by which a camera that moves goes to and fro: too little to see anything else
constexpr double kTrembles = 1e-4;

void touchable(benchmark::State& state, bool everywhere, bool moves = false) {
  SourceOptions options;
  options.policy.fit_everywhere = everywhere;
  Scene scene;
  Source& source = scene.add("camera", options);
  SceneField field(scene);
  int count = 0;
  repeat(state, [&](DepthFrame& frame) {
    if (moves) frame.T_world_sensor->translation().x() += ++count % 2 == 0 ? kTrembles : -kTrembles;
    field.update_from(frame.stamp, kHand, kProxy);
    source.push(frame, [&] { return frame.stamp + 0.01; });
  });
}

void filtered(benchmark::State& state, bool everywhere) {
  DepthFilter filter;
  repeat(state, [&](const DepthFrame& frame) {
    const Eigen::Isometry3d pose = frame.T_world_sensor.value();
    benchmark::DoNotOptimize(everywhere ? filter.filter(frame, pose)
                                        : filter.filter(frame, pose, kNear));
  });
}

template <class Pipeline>
void peer(benchmark::State& state, const Pipeline& pipeline) {
  Ring ring(record_frames());
  if (pipeline(ring.next(), kLeaf) == 0) return state.SkipWithError("built without PCL");
  for (auto _ : state) benchmark::DoNotOptimize(pipeline(ring.next(), kLeaf));
}

template <class Run>
auto* add(const std::string& name, const Run& run) {
  auto* const row = benchmark::RegisterBenchmark((name + "/307200").c_str(), run);
  return row->Unit(benchmark::kMillisecond);
}

void add_rows() {
  add("touchable_near_0.1m/palpate", [](benchmark::State& s) { touchable(s, false); });
  add("touchable_everywhere/palpate", [](benchmark::State& s) { touchable(s, true); });
  add("touchable_near_0.1m_moving_camera/palpate",
      [](benchmark::State& s) { touchable(s, false, true); });
  add("touchable_everywhere_moving_camera/palpate",
      [](benchmark::State& s) { touchable(s, true, true); });
  add("touchable_everywhere/pcl", [](benchmark::State& s) { peer(s, pcl_pipeline); });
  add("touchable_everywhere/pcl_organised",
      [](benchmark::State& s) { peer(s, pcl_organised_pipeline); });
  add("filter_near_0.1m/palpate", [](benchmark::State& s) { filtered(s, false); });
  add("filter_everywhere/palpate", [](benchmark::State& s) { filtered(s, true); });
}

}  // namespace
}  // namespace palpate::bench

// --two-threads as first argument: wall time of ours with the fit everywhere on two threads.
int main(int argc, char** argv) {
  using namespace palpate::bench;
  const bool two = argc > 1 && std::string(argv[1]) == "--two-threads";
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, two ? 2 : 1);
  if (two) {
    add("touchable_two_threads/palpate", [](benchmark::State& s) {
      touchable(s, true);
    })->UseRealTime();
  } else {
    add_rows();
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
