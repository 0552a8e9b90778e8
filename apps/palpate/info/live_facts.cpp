#include "apps/palpate/info/live_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/sources/open_live.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kFrames = 30;
constexpr int kTries = 200;    // answers of any kind
constexpr double kWait = 0.1;  // s

void look_at_depths(const DepthFrame& frame, LiveFacts& facts) {
  std::vector<float> depths;
  for (const float z : frame.depth) {
    if (z > 0) depths.push_back(z);
  }
  facts.valid = static_cast<double>(depths.size()) / static_cast<double>(frame.depth.size());
  if (depths.empty()) return;
  std::sort(depths.begin(), depths.end());
  facts.nearest = quantile(depths, 0.01);
  facts.depth = quantile(depths, 0.5);
  facts.farthest = quantile(depths, 0.99);
}

}  // namespace

LiveFacts study_live(const CloudArgument& argument) {
  const Waiting waiting("studying " + argument.name);
  ChosenSource source;
  source.argument = argument;
  const std::unique_ptr<DepthCamera> camera = open_live_at_any_pace(source);
  LiveFacts facts;
  facts.argument = argument;
  DepthFrame frame = first_frame(*camera);
  const double start = frame.stamp;
  double last = start;
  facts.width = frame.camera.width;
  facts.height = frame.camera.height;
  facts.pinhole = frame.camera.pinhole;
  facts.distorted = !frame.camera.distortion.none();
  facts.posed = frame.T_world_sensor.has_value();
  look_at_depths(frame, facts);
  DepthFilter filter;
  CameraStatus status = CameraStatus::frame;
  for (int i = 0; i < kTries && facts.frames < kFrames && status != CameraStatus::ended; ++i) {
    if (status == CameraStatus::frame) {
      const Eigen::Isometry3d pose = frame.T_world_sensor.value_or(Eigen::Isometry3d::Identity());
      const FilteredDepth& depth = filter.filter(frame, pose, {});
      facts.noise = depth.noise;
      facts.repeated += depth.duplicate ? 1 : 0;
      ++facts.frames;
      last = frame.stamp;
    }
    status = camera->read(frame, kWait);
    const bool failed = status == CameraStatus::damaged || status == CameraStatus::failed;
    facts.failures += failed ? 1 : 0;
    facts.unposed += status == CameraStatus::unposed ? 1 : 0;
  }
  if (last > start) facts.rate = static_cast<double>(facts.frames - 1) / (last - start);
  return facts;
}

void print_facts(const LiveFacts& facts, std::FILE* out) {
  const Style style(out);
  const Pinhole& p = facts.pinhole;
  fmt::print(out, "{} {} ({} x {} pixels)\n", style.heading(facts.argument.name),
             facts.argument.path, facts.width, facts.height);
  fmt::print(out, "  intrinsics {:.6g}, {:.6g}, {:.6g}, {:.6g}{}\n", p.fx, p.fy, p.cx, p.cy,
             facts.distorted ? ", with distortion" : "");
  fmt::print(out, "  frames     {:.1f} a second; of the first {} {} repeated, {} failed\n",
             facts.rate, facts.frames, facts.repeated, facts.failures);
  fmt::print(
      out, "  poses      {}{}\n",
      facts.posed ? "frames tell where they were taken" : "none; --pose says where it stands",
      facts.unposed > 0 ? fmt::format("; {} without one left out", facts.unposed) : "");
  fmt::print(out, "  depth      {:.0f} % of the pixels have one, {} to {}, median {}\n",
             100 * facts.valid, length(facts.nearest), length(facts.farthest), length(facts.depth));
  const auto& c = facts.noise.coefficients;
  fmt::print(out, "  noise      {} a pixel at the median; --noise {:.4g},{:.4g},{:.4g},{:.3g}\n",
             length(facts.noise.sigma(facts.depth)), c[0], c[1], c[2], facts.noise.correlation);
}

nlohmann::ordered_json json_facts(const LiveFacts& facts) {
  const Pinhole& p = facts.pinhole;
  return {
      {"name", facts.argument.name},
      {"camera", facts.argument.path},
      {"width", facts.width},
      {"height", facts.height},
      {"intrinsics", {p.fx, p.fy, p.cx, p.cy}},
      {"distorted", facts.distorted},
      {"posed", facts.posed},
      {"frames_unposed", facts.unposed},
      {"rate_Hz", facts.rate},
      {"frames", facts.frames},
      {"frames_repeated", facts.repeated},
      {"failures", facts.failures},
      {"valid_share", facts.valid},
      {"depth_m",
       {{"hundredth", facts.nearest}, {"median", facts.depth}, {"last_hundredth", facts.farthest}}},
      {"noise",
       {{"coefficients", facts.noise.coefficients},
        {"correlation", facts.noise.correlation},
        {"at_median_m", facts.noise.sigma(facts.depth)}}}};
}

}  // namespace palpate::app
