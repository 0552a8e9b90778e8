// The depth filter's frame: the fits of its blocks, then the filter over time, then points.
#include "palpate/depth/depth_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "depth/blocks.hpp"
#include "depth/input.hpp"
#include "depth/noise_tracker.hpp"
#include "depth/still_tiles.hpp"
#include "depth/temporal_filter.hpp"
#include "depth/window_fits.hpp"
#include "palpate/base/error.hpp"

namespace palpate::depth {
namespace {

using Eigen::Vector3f;

// Block widths to a neighbour, at most: a plane that seems to be seen at less than 6 degrees is
// noise (judgement; 1 / sin 6 degrees).
constexpr float kMostGrazing = 10;

// Share by which a fit may leave the range of measured depths (judgement).
constexpr double kBeyond = 0.25;

// Outputs of some blocks of a row, in columns so that the compiler can vectorise.
struct Part {
  static constexpr int kMost = KeptTiles::kTogether;  // blocks
  float x[kMost], z[kMost], normal_x[kMost], normal_y[kMost], normal_z[kMost];
};

// The rays are (x, y, 1). How far the next column's and row's points are on the tangent plane is
// the spacing.
struct Rays {
  float y, step_x, step_y, pitch;

  void follow(const BlockFits& fits, std::size_t first, int count, Part& part,
              FilteredDepth& out) const {
    const float* const rho = &fits.rho[first];
    const float* const slope_x = &fits.slope_x[first];
    const float* const slope_y = &fits.slope_y[first];
    const float* const variance = &fits.variance[first];
    float* const deviations = &out.deviations[first];
    float* const spacings = &out.spacings[first];
    for (int k = 0; k < count; ++k) {
      const float x = part.x[k];
      const float z = rho[k] > 0 ? 1 / rho[k] : 0;  // of an empty block: nowhere
      const float a = slope_x[k];
      const float b = slope_y[k];
      const float c = rho[k] - a * x - b * y;
      // Towards the sensor: the plane (a, b, c) . p = 1 has its origin in front.
      const float per_length = -1 / std::sqrt(a * a + b * b + c * c);
      part.z[k] = z;
      part.normal_x[k] = per_length * a;
      part.normal_y[k] = per_length * b;
      part.normal_z[k] = per_length * c;
      const float za = z * a;
      const float zb = z * b;
      const float ahead = 1 - za * x;
      const float along = 1 - zb * y;
      const float right2 = (ahead * ahead + za * za * (y * y + 1)) * step_x * step_x;
      const float below2 = (along * along + zb * zb * (x * x + 1)) * step_y * step_y;
      const float spacing = z * std::sqrt(right2 > below2 ? right2 : below2);
      const float most = kMostGrazing * z * pitch;
      spacings[k] = spacing < most ? spacing : most;
      deviations[k] = std::sqrt(variance[k] * (x * x + y * y + 1)) * z * z;
    }
  }
};

// Makes room for one entry a block.
void resize(const BlockGrid& grid, FilteredDepth& out) {
  out.columns = grid.columns;
  out.rows = grid.rows;
  out.pitch = std::max(std::abs(grid.step_x), std::abs(grid.step_y));
  const std::size_t size = grid.size();
  out.states.resize(size, FilteredDepth::State::empty);
  out.positions.resize(size, Vector3f::Zero());
  out.normals.resize(size, Vector3f::Zero());
  out.confidences.resize(size);
  out.deviations.resize(size);
  out.spacings.resize(size);
}

// Writes states, positions, normals, deviations and spacings of blocks from their fits. A block
// that a fit puts clearly out of range, or behind the camera, is empty. Leaves the rest of `out`
// alone.
void write(const BlockFits& fits, int row, int first, int count, const DepthFilterOptions& range,
           FilteredDepth& out) {
  const BlockGrid& grid = fits.grid;
  const auto farthest = static_cast<float>(1 / ((1 + kBeyond) * range.farthest));
  const auto nearest = static_cast<float>((1 + kBeyond) / range.nearest);
  const Rays rays{static_cast<float>(grid.y(row)), static_cast<float>(grid.step_x),
                  static_cast<float>(grid.step_y), static_cast<float>(out.pitch)};
  Part part;
  std::size_t i = grid.index(first, row);
  for (int k = 0; k < count; ++k) part.x[k] = static_cast<float>(grid.x(first + k));
  rays.follow(fits, i, count, part, out);
  for (int k = 0; k < count; ++k, ++i) {
    const bool sane = fits.rho[i] >= farthest && fits.rho[i] <= nearest;
    out.states[i] = sane ? fits.states[i] : FilteredDepth::State::empty;
    out.positions[i] = part.z[k] * Vector3f(part.x[k], rays.y, 1);
    const bool has_normal = fits.confidences[i] > 0;
    const Vector3f normal(part.normal_x[k], part.normal_y[k], part.normal_z[k]);
    out.normals[i] = has_normal ? normal : Vector3f(Vector3f::Zero());
    out.confidences[i] = fits.confidences[i];
  }
}

}  // namespace
}  // namespace palpate::depth

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
  depth::StillTiles tiles;
  FilteredDepth out;
  std::optional<DepthFrame> last;

  void resize(const CameraModel& camera) {
    const depth::BlockGrid grid = depth::block_grid(camera);
    if (blocks.grid == grid) return;
    blocks.resize(grid);
    fits.resize(grid);
    depth::resize(grid, out);
    last.reset();
  }

  // Is it bit for bit the last frame? Keeps it.
  bool repeats(const DepthFrame& frame) {
    const std::vector<float>& depth = frame.depth;
    const bool same =
        last && last->depth.size() == depth.size() &&
        std::memcmp(last->depth.data(), depth.data(), depth.size() * sizeof(float)) == 0;
    if (!last) last.emplace();
    if (!same) last->depth = depth;
    last->camera = frame.camera;
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

  // Averages the blocks of a frame without regard to earlier ones.
  void average(const DepthFrame& frame) {
    const float* image = undistorter.undistort(frame.camera, frame.depth, out.noise, options);
    depth::average_blocks(image, frame.camera.width, out.noise, options, blocks);
    depth::reject_flying(out.noise, blocks);
  }

  const FilteredDepth& filter(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor) {
    resize(frame.camera);
    const bool same_pose = last && T_world_sensor.matrix() == out.T_world_sensor.matrix();
    out.duplicate = repeats(frame);
    out.stamp = frame.stamp;
    out.T_world_sensor = T_world_sensor;
    const bool again = out.duplicate && same_pose;
    if (again && region == last_region) return out;
    if (!again) out.noise = noise(frame);
    return points(frame, again);
  }

  // Keeps the tiles that hold no plain block: their frame is not averaged twice.
  void keep_fitted() {
    const int side = KeptTiles::kSide;
    for (int row = 0; row < out.rows; row += side) {
      for (int column = 0; column < out.columns; column += side) {
        bool plain = false;
        for (int r = row; r < std::min(row + side, out.rows); ++r) {
          const auto* const states = &out.states[fits.grid.index(column, r)];
          const auto* const end = states + std::min(side, out.columns - column);
          plain = plain || std::find(states, end, FilteredDepth::State::plain) != end;
        }
        out.kept.flags[out.kept.index(column, row)] = plain ? 0 : 1;
      }
    }
  }

  // Fits what does not stand still in its own view and averages it with what is remembered.
  // `again`: the last frame, now for another region.
  const FilteredDepth& points(const DepthFrame& frame, bool again) {
    average(frame);
    if (!temporal.begin(fits.grid, out.T_world_sensor)) tiles.forget(fits.grid);
    tiles.find(blocks, out.noise, region.change_from(last_region), options.memory > 1, out.kept);
    if (again) keep_fitted();
    last_region = region;
    const depth::BlockRange fitted =
        window_fits.fit(blocks, out.noise, options.normal_error, region, out.kept, fits);
    const depth::TemporalOptions in_time =
        depth::temporal_options(options.memory, out.noise.correlation, options.normal_error);
    depth::for_rows(fits.grid, [&](int row) {
      // All of it while the processor's cache holds it.
      out.kept.each_other(row, [&](int first, int count) {
        std::uint8_t settled[KeptTiles::kTogether];
        if (!fitted.has_row(row)) depth::fit_plain(blocks, out.noise, row, first, count, fits);
        temporal.filter(in_time, row, first, count, fits, settled);
        depth::write(fits, row, first, count, options, out);
        tiles.remember(blocks, row, first, count, settled);
      });
    });
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
  if (!state.last) return nullptr;
  state.region.set(depth::block_grid(state.last->camera));
  if (state.last_region == state.region) return &state.out;
  return &state.points(*state.last, true);
}

void DepthFilter::reset() {
  state_->temporal.reset();
  state_->tiles.forget(state_->fits.grid);
  state_->tracker.reset();
  state_->last.reset();
}

namespace {

// From recordings: docs/method.md 6.2. Structured light (the first Kinect, the Xtion) has a
// fixed pattern besides, which is why c stands above what differences of frames give.
constexpr std::array<std::pair<std::string_view, NoiseModel>, 4> kSensors{{
    {"kinect1", {{0.00039, 0, 0.00093}, 6}},
    {"xtion", {{0.00014, 0, 0.00099}, 6}},
    {"realsense", {{0, 0, 0.00247}, 11}},
    {"tof", {{0, 0, 0.015}, 4.8}},
}};

}  // namespace

NoiseModel sensor_noise(std::string_view sensor) {
  std::string names;
  for (const auto& [name, noise] : kSensors) {
    if (name == sensor) return noise;
    if (!names.empty()) names += ", ";
    names += name;
  }
  throw Error("unknown noise profile \"" + std::string(sensor) + "\"; give one of " + names +
              ", or none to measure the noise");
}

NoiseModel unknown_sensor_noise() {
  return {{0.0004, 0, 0.0025}, 6};
}

}  // namespace palpate
