// Fits a plane to each block's window, in the requested region.
#include "depth/window_fits.hpp"

#include <algorithm>
#include <cmath>

#include "depth/blocks.hpp"
#include "geometry/parallel.hpp"

namespace palpate::depth {
namespace {

using Eigen::Vector3d;

struct Interval {
  double low;
  double high;
};

// Ratios a / z of all points (a, z) of a disc of radius r that have z > 0: what lies between the
// two tangents from the origin.
Interval tangents(double a, double z, double r) {
  const double distance = std::hypot(a, z);
  if (distance <= r) return {-HUGE_VAL, HUGE_VAL};
  const double middle = std::atan2(a, z);
  const double half = std::asin(r / distance);
  constexpr double kAside = 1.5;  // rad; beyond it the tangent grows without bound
  return {middle - half < -kAside ? -HUGE_VAL : std::tan(middle - half),
          middle + half > kAside ? HUGE_VAL : std::tan(middle + half)};
}

// Numbers 0 ... count - 1 of blocks at origin + number * step that are in the interval.
std::pair<int, int> numbers(const Interval& in, double origin, double step, int count) {
  const auto clamped = [&](double ratio) {
    return std::clamp((ratio - origin) / step, -1.0, static_cast<double>(count));
  };
  const double first = std::ceil(clamped(in.low));
  const double last = std::floor(clamped(in.high));
  return {std::max(static_cast<int>(first), 0), std::min(static_cast<int>(last), count - 1)};
}

BlockRange range_of(const BlockGrid& grid, const Ball& ball) {
  const Vector3d& c = ball.center;
  if (c.z() + ball.radius <= 0) return {};
  const auto [left, right] =
      numbers(tangents(c.x(), c.z(), ball.radius), grid.x0, grid.step_x, grid.columns);
  const auto [top, bottom] =
      numbers(tangents(c.y(), c.z(), ball.radius), grid.y0, grid.step_y, grid.rows);
  return {left, top, right - left + 1, bottom - top + 1};
}

BlockRange united(const BlockRange& a, const BlockRange& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int left = std::min(a.first_column, b.first_column);
  const int top = std::min(a.first_row, b.first_row);
  return {left, top, std::max(a.first_column + a.columns, b.first_column + b.columns) - left,
          std::max(a.first_row + a.rows, b.first_row + b.rows) - top};
}

}  // namespace

void FitRegion::set(const BlockGrid& grid) {
  everything_ = true;
  range_ = {0, 0, grid.columns, grid.rows};
}

void FitRegion::set(const BlockGrid& grid, const Eigen::Isometry3d& T_world_sensor,
                    std::span<const Ball> balls) {
  everything_ = false;
  range_ = {};
  balls_.clear();
  const Eigen::Isometry3d T_sensor_world = T_world_sensor.inverse();
  for (const Ball& ball : balls) {
    const Ball local{T_sensor_world * ball.center, ball.radius};
    if (!(local.center.allFinite() && local.radius > 0)) continue;
    const BlockRange range = range_of(grid, local);
    if (range.empty()) continue;
    balls_.push_back(local);
    range_ = united(range_, range);
  }
}

bool FitRegion::operator==(const FitRegion& other) const {
  const auto same = [](const Ball& a, const Ball& b) {
    return a.center == b.center && a.radius == b.radius;
  };
  return everything_ == other.everything_ && range_ == other.range_ &&
         std::equal(balls_.begin(), balls_.end(), other.balls_.begin(), other.balls_.end(), same);
}

BlockRange FitRegion::change_from(const FitRegion& other) const {
  return *this == other ? BlockRange{} : united(range_, other.range_);
}

bool FitRegion::contains(const Vector3d& point) const {
  return std::any_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
    return (point - ball.center).squaredNorm() <= ball.radius * ball.radius;
  });
}

int FitRegion::columns(const Blocks& blocks, const KeptTiles& kept, int row,
                       std::int32_t* columns) const {
  if (!range_.has_row(row)) return 0;
  const double y = blocks.grid.y(row);
  int count = 0;
  for (int column = range_.first_column; column < range_.first_column + range_.columns; ++column) {
    const float rho = blocks.rho[blocks.at(column, row)];
    if (!(rho > 0) || kept.at(column, row)) continue;
    if (everything_ || contains(Vector3d(blocks.grid.x(column), y, 1) / double(rho))) {
      columns[count++] = column;
    }
  }
  return count;
}

namespace {

// Blocks that a window reaches at most when it is moved by all of its reach (derived).
constexpr int kBorder = 2 * simd::kLargestWindow;

simd::BlockRows rows_of(const Blocks& blocks) {
  const std::size_t first = blocks.at(0, 0);
  return {blocks.rho.data() + first, blocks.counts.data() + first,
          static_cast<std::ptrdiff_t>(blocks.stride)};
}

}  // namespace

simd::FitInput WindowFits::input(const Blocks& blocks, const NoiseModel& noise, double normal_error,
                                 const BlockRange& range) {
  const BlockGrid& grid = blocks.grid;
  const auto& s = noise.coefficients;
  const double share = block_share(noise.correlation);
  return {.table = {.sums = table_.front().sums,
                    .first_column = range.first_column,
                    .first_row = range.first_row,
                    .columns = range.columns,
                    .rows = range.rows},
          .blocks = rows_of(blocks),
          .x0 = grid.x0,
          .y0 = grid.y0,
          .step_x = grid.step_x,
          .step_y = grid.step_y,
          .noise = {share * s[0], share * s[1], share * s[2]},
          .shared = shared_error(noise.correlation),
          .pixel_noise = {s[0], s[1], s[2]},
          .close = double{SameSurface::kClose},
          .steep = double{SameSurface(noise, grid).steep},
          .normal_error = normal_error,
          .growth = std::min(2.0, std::sqrt(noise.correlation))};
}

BlockRange WindowFits::fit(const Blocks& blocks, const NoiseModel& noise, double normal_error,
                           const FitRegion& region, const KeptTiles& kept, BlockFits& fits) {
  const BlockGrid& grid = blocks.grid;
  if (filled_.grid != grid) {
    table_.resize(static_cast<std::size_t>(grid.columns + 1) * (grid.rows + 1));
    columns_.resize(grid.size());
  }
  if (region.range().empty()) return {};
  const BlockRange range = region.range().grown(kBorder, grid);
  fill_gaps(blocks, noise, range, filled_);
  const simd::FitInput in = input(blocks, noise, normal_error, range);
  const auto fit_plainly = [&](int row) {
    kept.each_other(row, [&](int first_column, int count) {
      fit_plain(blocks, noise, row, first_column, count, fits);
    });
  };
  detail::parallel_pair([&] { functions_->table(in.table, rows_of(filled_)); },
                        [&] { for_rows(range, fit_plainly); });
  for_rows(range, [&](int row) {
    const std::size_t first = grid.index(0, row);
    std::int32_t* const columns = &columns_[first];
    const int count = region.columns(blocks, kept, row, columns);
    functions_->fit(in, row, columns, count, fits.row(row));
    for (int k = 0; k < count; ++k) {
      fits.states[first + static_cast<std::size_t>(columns[k])] = FilteredDepth::State::fitted;
    }
  });
  bent_.refit(in, noise, kept, fits);
  faces_.refit(in, filled_, noise, kept, fits);
  return range;
}

}  // namespace palpate::depth
