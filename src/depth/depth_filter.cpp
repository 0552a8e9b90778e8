#include "palpate/depth/depth_filter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "depth/block_fits.hpp"
#include "depth/blocks.hpp"
#include "depth/neighbors.hpp"
#include "depth/output.hpp"
#include "depth/undistort.hpp"
#include "depth/window_fits.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// Until the sensor's noise is known: that of a common structured-light camera.
constexpr NoiseModel kCommonNoise{{0.0015, -0.0015, 0.0019}, 1};

void check(const DepthFilterOptions& options) {
  if (!(options.normal_error > 0 && options.normal_error < 1)) {
    throw Error(fmt::format("depth filter: normal_error is {} rad; take a value from 0.001 to 0.1",
                            options.normal_error));
  }
  if (options.memory < 1) {
    throw Error(fmt::format("depth filter: memory is {} frames; take 1 or more", options.memory));
  }
  const bool range =
      options.nearest > 0 && options.farthest > options.nearest && std::isfinite(options.farthest);
  if (!range) {
    throw Error(
        fmt::format("depth filter: depths from {} to {} m are none; take 0 < nearest < "
                    "farthest",
                    options.nearest, options.farthest));
  }
  if (!options.noise) return;
  const NoiseModel& noise = *options.noise;
  for (const double z : {options.nearest, options.farthest}) {
    if (!(noise.sigma(z) > 0 && std::isfinite(noise.sigma(z)))) {
      throw Error(
          fmt::format("depth filter: the noise at {} m is {} m; give a model that is "
                      "positive from nearest to farthest",
                      z, noise.sigma(z)));
    }
  }
  if (!(noise.correlation >= 1 && std::isfinite(noise.correlation))) {
    throw Error(
        fmt::format("depth filter: the noise's correlation is {}; take 1 (independent "
                    "pixels) or more",
                    noise.correlation));
  }
}

void check(const DepthFrame& frame) {
  const CameraModel& camera = frame.camera;
  if (camera.width < 2 || camera.height < 2) {
    throw Error(
        fmt::format("depth filter: a frame of {} x {} pixels has no block of 2 x 2; give "
                    "the camera's width and height",
                    camera.width, camera.height));
  }
  const auto pixels = static_cast<std::size_t>(camera.width) * camera.height;
  if (frame.depth.size() != pixels) {
    throw Error(fmt::format("depth filter: {} depths for {} x {} pixels; give {}",
                            frame.depth.size(), camera.width, camera.height, pixels));
  }
  const Pinhole& p = camera.pinhole;
  const bool is_camera = p.fx > 0 && p.fy > 0 && std::isfinite(p.fx) && std::isfinite(p.fy) &&
                         std::isfinite(p.cx) && std::isfinite(p.cy);
  if (!is_camera) {
    throw Error(
        fmt::format("depth filter: a pinhole with fx {}, fy {}, cx {}, cy {} is none; give "
                    "the focal lengths and the centre in pixels",
                    p.fx, p.fy, p.cx, p.cy));
  }
}

}  // namespace

struct DepthFilter::State {
  DepthFilterOptions options;
  depth::Undistorter undistorter;
  depth::Blocks blocks;
  depth::BlockFits fits;
  depth::FitRegion region;
  depth::WindowFits window_fits;
  std::vector<float> last_depth;
  std::vector<float> scratch;
  FilteredDepth out;
  bool seen_before = false;
  bool seen = false;  // is there a frame in last_depth?

  // Is it bit for bit the last frame? Keeps it.
  bool repeats(const DepthFrame& frame) {
    const std::size_t bytes = frame.depth.size() * sizeof(float);
    const bool same = seen && last_depth.size() == frame.depth.size() &&
                      std::memcmp(last_depth.data(), frame.depth.data(), bytes) == 0;
    if (!same) last_depth = frame.depth;
    seen = true;
    return same;
  }

  void resize(const CameraModel& camera) {
    const depth::BlockGrid grid = depth::block_grid(camera);
    if (blocks.grid == grid) return;
    blocks.resize(grid);
    fits.resize(grid);
    depth::resize(grid, out);
    forget();
  }

  void forget() {
    seen = false;
    seen_before = false;
  }

  // Compares with the points that are still those of the frame before.
  void mark_jumps() {
    const depth::SameSurface same(out.noise, fits.grid);
    for (std::size_t i = 0; i < fits.size(); ++i) {
      const float before = 1 / out.positions[i].z();
      const bool known = seen_before && out.states[i] != BlockState::empty;
      out.jumped[i] = !(known && std::abs(fits.rho[i] - before) <= same.limit(before));
    }
    seen_before = true;
  }

  const FilteredDepth& filter(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor) {
    resize(frame.camera);
    out.duplicate = repeats(frame);
    out.stamp = frame.stamp;
    out.T_world_sensor = T_world_sensor;
    out.noise = options.noise.value_or(kCommonNoise);
    const float* image = undistorter.undistort(frame.camera, frame.depth);
    depth::average_blocks(image, frame.camera.width, out.noise, options, blocks);
    depth::reject_flying(out.noise, blocks, scratch);
    depth::fit_plain(blocks, out.noise, fits);
    window_fits.fit(blocks, out.noise, options.normal_error, region, fits);
    mark_jumps();
    depth::write_points(fits, out);
    return out;
  }
};

DepthFilter::DepthFilter(const DepthFilterOptions& options) : state_(std::make_unique<State>()) {
  check(options);
  state_->options = options;
}
DepthFilter::~DepthFilter() = default;
DepthFilter::DepthFilter(DepthFilter&&) noexcept = default;
DepthFilter& DepthFilter::operator=(DepthFilter&&) noexcept = default;

const FilteredDepth& DepthFilter::filter(const DepthFrame& frame,
                                         const Eigen::Isometry3d& T_world_sensor,
                                         std::span<const Ball> fit_within) {
  check(frame);
  state_->region.set(depth::block_grid(frame.camera), T_world_sensor, fit_within);
  return state_->filter(frame, T_world_sensor);
}

const FilteredDepth& DepthFilter::filter(const DepthFrame& frame,
                                         const Eigen::Isometry3d& T_world_sensor) {
  check(frame);
  state_->region.set(depth::block_grid(frame.camera));
  return state_->filter(frame, T_world_sensor);
}

void DepthFilter::reset() {
  state_->forget();
}

}  // namespace palpate
