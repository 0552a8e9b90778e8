#include "palpate/depth/depth_filter.hpp"

#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "depth/blocks.hpp"
#include "depth/input.hpp"
#include "depth/neighbors.hpp"
#include "depth/noise_tracker.hpp"
#include "depth/output.hpp"
#include "depth/temporal_filter.hpp"
#include "depth/window_fits.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

struct DepthFilter::State {
  explicit State(const DepthFilterOptions& given)
      : options(given), tracker(given.noise.value_or(unknown_sensor_noise())) {}

  DepthFilterOptions options;
  depth::Undistorter undistorter;
  depth::Blocks blocks;
  depth::FitRegion region;
  depth::FitRegion last_region;
  depth::BlockFits fits;
  depth::WindowFits window_fits;
  depth::NoiseTracker tracker;
  depth::TemporalFilter temporal;
  FilteredDepth out;
  DepthFrame last;
  std::vector<float> scratch;
  bool seen = false;  // is there a last frame?

  void resize(const CameraModel& camera) {
    const depth::BlockGrid grid = depth::block_grid(camera);
    if (blocks.grid == grid) return;
    blocks.resize(grid);
    fits.resize(grid);
    depth::resize(grid, out);
    seen = false;
  }

  // Is it bit for bit the last frame? Keeps it.
  bool repeats(const DepthFrame& frame) {
    const std::vector<float>& depth = frame.depth;
    const bool same =
        seen && last.depth.size() == depth.size() &&
        std::memcmp(last.depth.data(), depth.data(), depth.size() * sizeof(float)) == 0;
    if (!same) last.depth = depth;
    last.camera = frame.camera;
    seen = true;
    return same;
  }

  NoiseModel noise(const DepthFrame& frame) {
    if (options.noise) return *options.noise;
    const CameraModel& camera = frame.camera;
    const double focal = (camera.pinhole.fx + camera.pinhole.fy) / 2;
    return tracker.update({frame.depth, camera.width, camera.height, focal,
                           static_cast<float>(options.nearest),
                           static_cast<float>(options.farthest)});
  }

  // Fits, in this view, without regard to earlier frames.
  void fit(const DepthFrame& frame) {
    const float* image = undistorter.undistort(frame.camera, frame.depth, out.noise, options);
    depth::average_blocks(image, frame.camera.width, out.noise, options, blocks);
    depth::reject_flying(out.noise, blocks, scratch);
    depth::fit_plain(blocks, out.noise, fits);
    window_fits.fit(blocks, out.noise, options.normal_error, region, fits);
  }

  const FilteredDepth& filter(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor) {
    resize(frame.camera);
    const bool same_view =
        seen && region == last_region && T_world_sensor.matrix() == out.T_world_sensor.matrix();
    out.duplicate = repeats(frame);
    out.stamp = frame.stamp;
    out.T_world_sensor = T_world_sensor;
    last_region = region;
    if (out.duplicate && same_view) return out;
    out.noise = noise(frame);
    return points(frame);
  }

  // In its view, from what has been measured and what is remembered.
  const FilteredDepth& points(const DepthFrame& frame) {
    fit(frame);
    temporal.filter(
        depth::temporal_options(options.memory, out.noise.correlation, options.normal_error),
        out.T_world_sensor, fits);
    depth::write_points(fits, {options.nearest, options.farthest}, out);
    return out;
  }
};

DepthFilter::DepthFilter(const DepthFilterOptions& options) {
  depth::check(options);
  state_ = std::make_unique<State>(options);
}
DepthFilter::~DepthFilter() = default;
DepthFilter::DepthFilter(DepthFilter&&) noexcept = default;
DepthFilter& DepthFilter::operator=(DepthFilter&&) noexcept = default;

const FilteredDepth& DepthFilter::filter(const DepthFrame& frame,
                                         const Eigen::Isometry3d& T_world_sensor,
                                         std::span<const Ball> fit_within) {
  depth::check(frame);
  depth::check(T_world_sensor);
  state_->region.set(depth::block_grid(frame.camera), T_world_sensor, fit_within);
  return state_->filter(frame, T_world_sensor);
}

const FilteredDepth& DepthFilter::filter(const DepthFrame& frame,
                                         const Eigen::Isometry3d& T_world_sensor) {
  depth::check(frame);
  depth::check(T_world_sensor);
  state_->region.set(depth::block_grid(frame.camera));
  return state_->filter(frame, T_world_sensor);
}

const FilteredDepth* DepthFilter::fit_all() {
  State& state = *state_;
  if (!state.seen) return nullptr;
  state.region.set(depth::block_grid(state.last.camera));
  if (std::exchange(state.last_region, state.region) == state.region) return &state.out;
  return &state.points(state.last);
}

void DepthFilter::reset() {
  state_->temporal.reset();
  state_->tracker.reset();
  state_->seen = false;
}

namespace {

// From recordings: docs/method.md 6.2. Structured light (the first Kinect, the Xtion) has a
// fixed pattern besides, which is why c stands above what differences of frames give.
constexpr std::array<SensorProfile, 4> kProfiles{{
    {"kinect1", {{0.00039, 0, 0.00093}, 6}},
    {"xtion", {{0.00014, 0, 0.00099}, 6}},
    {"realsense", {{0, 0, 0.00247}, 11}},
    {"tof", {{0, 0, 0.015}, 4.8}},
}};

}  // namespace

std::span<const SensorProfile> sensor_profiles() {
  return kProfiles;
}

const SensorProfile& sensor_profile(std::string_view name) {
  std::string names;
  for (const SensorProfile& profile : kProfiles) {
    if (profile.name == name) return profile;
    if (!names.empty()) names += ", ";
    names += profile.name;
  }
  throw Error("unknown noise profile \"" + std::string(name) + "\"; give one of " + names +
              ", or none to measure the noise");
}

NoiseModel unknown_sensor_noise() {
  return {{0.0004, 0, 0.0025}, 6};
}

}  // namespace palpate
