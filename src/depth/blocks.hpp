#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "depth/simd/fits.hpp"
#include "geometry/parallel.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::depth {

/// Rays of the 2x2 blocks of an undistorted image: block (column, row) looks along
/// (x(column), y(row), 1).
struct BlockGrid {
  int columns = 0;
  int rows = 0;
  double x0 = 0;  ///< of column 0
  double y0 = 0;
  double step_x = 0;  ///< from column to column
  double step_y = 0;

  [[nodiscard]] double x(double column) const { return x0 + column * step_x; }
  [[nodiscard]] double y(double row) const { return y0 + row * step_y; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * columns + column;
  }

  bool operator==(const BlockGrid&) const = default;
};

/// An odd last column or row of pixels belongs to no block.
[[nodiscard]] inline BlockGrid block_grid(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return {camera.width / 2,    camera.height / 2, (0.5 - p.cx) / p.fx,
          (0.5 - p.cy) / p.fy, 2 / p.fx,          2 / p.fy};
}

/// A rectangle of blocks.
struct BlockRange {
  int first_column = 0;
  int first_row = 0;
  int columns = 0;
  int rows = 0;

  bool operator==(const BlockRange&) const = default;
  [[nodiscard]] bool empty() const { return columns <= 0 || rows <= 0; }
  [[nodiscard]] bool overlaps(const BlockRange& other) const {
    return !empty() && !other.empty() && first_column < other.first_column + other.columns &&
           other.first_column < first_column + columns &&
           first_row < other.first_row + other.rows && other.first_row < first_row + rows;
  }
  [[nodiscard]] bool has_row(int row) const { return row >= first_row && row < first_row + rows; }
  /// Larger by `border` on all sides, as far as the grid goes.
  [[nodiscard]] BlockRange grown(int border, const BlockGrid& grid) const {
    const int left = std::max(first_column - border, 0);
    const int top = std::max(first_row - border, 0);
    return {left, top, std::min(first_column + columns + border, grid.columns) - left,
            std::min(first_row + rows + border, grid.rows) - top};
  }
};

inline constexpr std::size_t kLinesAtATime = 8;  ///< that a thread takes at once (judgement)

/// Calls body(row) for each row of a range, on several threads: see parallel_ranges().
template <class Body>
void for_rows(const BlockRange& range, const Body& body) {
  detail::parallel_each(static_cast<std::size_t>(range.rows), kLinesAtATime,
                        [&](std::size_t row) { body(range.first_row + static_cast<int>(row)); });
}

/// The same for all rows.
template <class Body>
void for_rows(const BlockGrid& grid, const Body& body) {
  for_rows(BlockRange{0, 0, grid.columns, grid.rows}, body);
}

/// Largest difference of depths on one surface: three deviations of a pixel, plus the slope over
/// `pixels` of a surface seen at an incidence of 72 degrees.
[[nodiscard]] inline simd::DepthGate depth_gate(const BlockGrid& grid, float pixels,
                                                const NoiseModel& noise,
                                                const DepthFilterOptions& range) {
  constexpr float kDeviations = 3;  // of a pixel (judgement)
  constexpr float kSteepest = 3;    // tangent of the incidence (judgement)
  const auto& s = noise.coefficients;
  const double pixel = std::max(std::abs(grid.step_x), std::abs(grid.step_y)) / 2;
  return {static_cast<float>(range.nearest),
          static_cast<float>(range.farthest),
          {static_cast<float>(kDeviations * s[0]),
           static_cast<float>(kDeviations * s[1] + kSteepest * pixels * pixel),
           static_cast<float>(kDeviations * s[2])}};
}

/// The measured means of 2x2 blocks, in rows with a margin of empty blocks all around so that
/// neighbours may be looked at without a check of where the image ends.
struct Blocks {
  static constexpr int kMargin = 8;  ///< blocks on each side; kPlainLanes requires it (derived)

  BlockGrid grid;
  std::size_t stride = 0;            ///< from row to row
  std::vector<float> rho;            ///< 1 / mean depth, 1/m; 0: empty
  std::vector<std::uint8_t> counts;  ///< pixels in the mean, 0-4
  std::vector<float> measured;       ///< `rho` before reject_flying()

  void resize(const BlockGrid& new_grid);
  /// Index of a block in the columns; from -kMargin to columns + kMargin - 1, rows alike.
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row + kMargin) * stride +
           static_cast<std::size_t>(column + kMargin);
  }
};

/// Averages what lies within three sigma of a block's median depth (and what a steep surface may
/// differ by within a block). A block whose pixels are all farther from their median, because it
/// looks half at one surface and half at another, is empty. `image` has rows of `width` pixels.
void average_blocks(const float* image, int width, const NoiseModel& noise,
                    const DepthFilterOptions& range, Blocks& blocks);

/// Deviation of the mean of a full block in those of a pixel: half of it where its four pixels err
/// alone, all of it where they err together.
[[nodiscard]] inline double block_share(double correlation) {
  return std::min(0.5 * correlation, 1.0);
}

/// Ratio of the variance of a mean of many blocks to that if blocks erred alone.
[[nodiscard]] inline double shared_error(double correlation) {
  return std::max(0.25 * correlation * correlation, 1.0);
}

/// The same of a term of degree 0 (the mean itself), 1 or 2 over so many blocks.
[[nodiscard]] inline double shared_error(double correlation, int degree, double blocks) {
  const double shared = shared_error(correlation);
  return shared / (1 + simd::kUnseenShare[degree] * (shared - 1) / blocks);
}

/// Are residuals larger than noise of this variance for each of `degrees` of freedom makes them: by
/// three deviations of chi^2? `excess`: their sum of squares above the one expected. `shared`: by
/// how much means of many vary more than if their blocks erred alone; squares share half of it.
[[nodiscard]] inline bool exceeds_noise(double excess, double degrees, double variance,
                                        double shared) {
  constexpr double kExplained = 18;  // 2 x 3^2 (docs/method.md 6.3)
  const double together = std::max(0.5 * shared, 1.0);
  return excess > 0 && excess * excess > kExplained * together * degrees * variance * variance;
}

inline constexpr double kOffFace = 16;  ///< four deviations, squared (docs/method.md 6.4)
/// Times the variance of slopes by a window; a vaguer face adds nothing (judgement).
inline constexpr double kLessPrecise = 2;

/// Deviation of the mean of a full block, 1/m, at inverse depth rho.
[[nodiscard]] inline float block_sigma(const NoiseModel& noise, float rho) {
  const auto& s = noise.coefficients;
  const double pixel = s[2] + rho * (s[1] + rho * s[0]);  // sigma(z) / z^2
  return static_cast<float>(block_share(noise.correlation) * (pixel > 0 ? pixel : 0));
}

/// Results for each block of one frame, in the sensor's frame: the fits write them, the temporal
/// filter changes them, the output is made from them. Row by row; all columns have grid.size()
/// entries, those of empty blocks mean nothing.
///
/// Along the ray (x, y, 1) of a block its inverse depth is `rho`; near it, it is
/// rho + slope_x (x' - x) + slope_y (y' - y). A plane is exactly that: its points p keep
/// (slope_x, slope_y, rho - slope_x x - slope_y y) . p = 1.
struct BlockFits {
  BlockGrid grid;
  std::vector<FilteredDepth::State> states;
  std::vector<float> rho;             ///< inverse depth, 1/m
  std::vector<float> variance;        ///< of rho, 1/m^2, with the noise's correlation in it
  std::vector<float> slope_x;         ///< d rho / d x, 1/m
  std::vector<float> slope_y;         ///< d rho / d y, 1/m
  std::vector<float> slope_variance;  ///< of either slope (the larger one), 1/m^2
  std::vector<float> confidences;     ///< of the slopes, 0-1; 0: they are unknown and 0

  // Fitted blocks only:
  std::vector<std::uint8_t> flat;     ///< simd::Flatness of its window
  std::vector<std::uint8_t> reach_u;  ///< blocks to the side of the largest window; 0: no edge near
  std::vector<std::uint8_t> reach_v;  ///< and to its top

  [[nodiscard]] std::size_t size() const { return states.size(); }

  /// Takes memory when the size is new, and no more.
  void resize(const BlockGrid& new_grid) {
    grid = new_grid;
    const std::size_t size = new_grid.size();
    states.resize(size, FilteredDepth::State::empty);
    for (auto* column : {&flat, &reach_u, &reach_v}) column->resize(size);
    for (auto* column : {&rho, &variance, &slope_x, &slope_y, &slope_variance, &confidences}) {
      column->resize(size);
    }
  }

  /// Writes a surface that is certain of its slopes, given from block to block as their variance
  /// is.
  void set(std::size_t i, double new_rho, double new_variance, double x, double y,
           double new_slope_variance) {
    const double least = std::min(grid.step_x * grid.step_x, grid.step_y * grid.step_y);
    rho[i] = static_cast<float>(new_rho);
    variance[i] = static_cast<float>(new_variance);
    slope_x[i] = static_cast<float>(x / grid.step_x);
    slope_y[i] = static_cast<float>(y / grid.step_y);
    slope_variance[i] = static_cast<float>(new_slope_variance / least);
    confidences[i] = 1;
  }

  /// Pointers to a block of a row in each column.
  [[nodiscard]] simd::FitRow row(int row, int column = 0) {
    const std::size_t i = grid.index(column, row);
    return {reinterpret_cast<std::uint8_t*>(&states[i]),
            &rho[i],
            &variance[i],
            &slope_x[i],
            &slope_y[i],
            &slope_variance[i],
            &confidences[i],
            &flat[i],
            &reach_u[i],
            &reach_v[i]};
  }
};

/// Limits by how much the inverse depths of neighbouring blocks differ on one surface.
struct SameSurface {
  static constexpr float kClose = 4.3F;  ///< 3 sigma of two blocks' difference: 3 sqrt(2) (derived)

  NoiseModel noise;
  float steep = 0;  ///< relative change of depth from block to block

  SameSurface(const NoiseModel& noise_model, const BlockGrid& grid);
  /// `distance` in blocks.
  [[nodiscard]] float limit(float rho, float distance = 1) const {
    return kClose * block_sigma(noise, rho) + steep * distance * rho;
  }
};

/// Empties blocks that stand between surfaces: those that fewer than two of their eight neighbours
/// continue, be it by lying close or by lying on a line with the block and its opposite neighbour.
void reject_flying(const NoiseModel& noise, Blocks& blocks);

/// Plain fits of some blocks of a row: each block's own mean, its slopes by least squares over
/// those of its eight neighbours that show the same surface.
void fit_plain(const Blocks& blocks, const NoiseModel& noise, int row, int first, int count,
               BlockFits& fits);

inline constexpr int kLongestGap = 3;  ///< blocks (docs/method.md 6.3)

/// Blocks of `range` without small holes: `filled` gets a copy in which gaps in rows, then in
/// columns, of up to kLongestGap blocks between two ends that may be one surface are bridged.
/// Filled blocks have a count of 0. One hole would otherwise cost all windows around it.
void fill_gaps(const Blocks& blocks, const NoiseModel& noise, const BlockRange& range,
               Blocks& filled);

}  // namespace palpate::depth
