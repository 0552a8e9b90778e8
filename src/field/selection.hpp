// Chooses the points of a patch: all whose supports reach into a ball.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

inline constexpr std::size_t kMostLayers = 64;  ///< that a patch is gathered from; judgement

/// One layer of points as it counts at the present moment.
struct ActiveLayer {
  const SurfacePoints* points = nullptr;
  int source = 0;
  double weight = 1;    ///< C_k
  double progress = 0;  ///< 0 at the points' start (A), 1 at their end (B)
  double rate = 0;      ///< d progress / dt, 1/s

  /// Patches that are gathered now can be advanced until progress is this; below `progress`: they
  /// cannot.
  double until = 0;
  double last_weight = 0;  ///< C_k then

  /// No R is below this, m; a point that it widens weighs as much less as it covers more.
  double least_radius = 0;
};

/// The position of a layer's point now, relative to `center` (world frame).
[[nodiscard]] inline Eigen::Vector3d position_now(const ActiveLayer& layer, std::uint32_t i,
                                                  const Eigen::Vector3d& center) noexcept {
  const SurfacePoints& points = *layer.points;
  Eigen::Vector3d position = points.grid.points()[i].cast<double>();
  if (!points.end_positions.empty()) {
    position += layer.progress * (points.end_positions[i].cast<double>() - position);
  }
  return position - (center - points.origin);
}

[[nodiscard]] Eigen::Vector3d normal_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// m/s
[[nodiscard]] Eigen::Vector3d velocity_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// a_i C_k now; C_k alone with `raw_weights`.
[[nodiscard]] double weight_now(const ActiveLayer& layer, std::uint32_t i,
                                bool raw_weights) noexcept;

/// The support radius of a layer's point now, m.
[[nodiscard]] double radius_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// The largest support radius of a layer's point at any time, m.
[[nodiscard]] inline float largest_radius(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const float start = std::max(points.radii[i], static_cast<float>(layer.least_radius));
  return points.end_radii.empty() ? start : std::max(start, points.end_radii[i]);
}

[[nodiscard]] double confidence_now(const ActiveLayer& layer, std::uint32_t i) noexcept;
[[nodiscard]] double presence_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// Does a layer's point lie beside an edge at any time?
[[nodiscard]] inline bool has_edge(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const std::vector<std::uint32_t>& edges = layer.points->edges.of_point;
  return !edges.empty() && edges[i] != SurfacePoints::Edges::kNone;
}
/// The plane beyond it; share 0: there is none.
[[nodiscard]] SurfacePoints::EdgePlane edge_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// Does a point count for nothing at any time (an outlier)?
[[nodiscard]] inline bool weightless(const SurfacePoints& points, std::uint32_t i) noexcept {
  return points.density_weights[i] <= 0 &&
         (points.end_density_weights.empty() || points.end_density_weights[i] <= 0);
}

/// Are the points others at their end (B) than at their start (A)?
[[nodiscard]] bool has_end(const SurfacePoints& points) noexcept;
/// Do a layer's points change their positions now?
[[nodiscard]] inline bool moves(const ActiveLayer& layer) noexcept {
  return layer.rate > 0 && !layer.points->end_positions.empty();
}

/// Do any of the points have a presence of their own?
[[nodiscard]] inline bool fades(const SurfacePoints& points) noexcept {
  return !points.presences.empty() || !points.end_presences.empty();
}

/// The cells still to visit in a depth-first walk through an index.
class CellStack {
 public:
  explicit CellStack(const SurfacePoints& points) noexcept {
    if (!points.grid.cells().empty()) cells_[size_++] = 0;
  }

  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::uint32_t pop() noexcept { return cells_[--size_]; }

  void push(std::uint32_t cell) noexcept { cells_[size_++] = cell; }

  /// The first child is visited next: points come in sorted order.
  void push_children(const CellGrid::Cell& cell) noexcept {
    for (std::uint32_t k = cell.children; k-- > 0;) cells_[size_++] = cell.first_child + k;
  }

 private:
  std::array<std::uint32_t, CellGrid::kMaxStack> cells_;
  std::size_t size_ = 0;
};

/// Returns which cells come near a position, in single precision and on the safe side: what
/// rounding takes away is given back by a little slack.
class CellTest {
 public:
  /// x relative to the points' origin, m.
  explicit CellTest(const Eigen::Vector3d& x) noexcept
      : x_(x.cast<float>()), slack_(4e-7f * x_.cwiseAbs().maxCoeff()) {}

  /// False only when the cell's box is certainly further away than `reach`, m.
  [[nodiscard]] bool near(const CellGrid::Cell& cell, double reach) const noexcept {
    const float limit = static_cast<float>(reach) * (1 + 1e-6f) + slack_;
    return squared_distance(cell) <= limit * limit;
  }

  /// To the cell's box, rounded, m^2.
  [[nodiscard]] float squared_distance(const CellGrid::Cell& cell) const noexcept {
    float squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float below = cell.lower[axis] - x_[axis];
      const float above = x_[axis] - cell.upper[axis];
      const float outside = std::max(std::max(below, above), 0.0f);
      squared += outside * outside;
    }
    return squared;
  }

 private:
  Eigen::Vector3f x_;
  float slack_;
};

/// Returns which points certainly stay away from a position on all of their path: in single
/// precision and on the safe side, since most of a cell's points do.
class PointTest {
 public:
  /// x relative to the points' origin, m.
  PointTest(const SurfacePoints& points, const Eigen::Vector3d& x) noexcept
      : starts_(points.grid.points().data()),
        ends_(points.end_positions.empty() ? starts_ : points.end_positions.data()),
        x_(x.cast<float>()),
        slack_(4e-7f * x_.cwiseAbs().maxCoeff()) {}

  /// True only when the i-th point is certainly further away than `reach`, m, at any time.
  [[nodiscard]] bool far(std::uint32_t i, float reach) const noexcept {
    Eigen::Vector3f from = starts_[i] - x_;
    if (ends_ != starts_) {
      const Eigen::Vector3f path = ends_[i] - starts_[i];
      from += 0.5f * path;
      reach += 0.5f * std::sqrt(path.squaredNorm());
    }
    const float limit = reach * (1 + 1e-5f) + slack_;
    return from.squaredNorm() > limit * limit;
  }

 private:
  const Eigen::Vector3f* starts_;
  const Eigen::Vector3f* ends_;
  Eigen::Vector3f x_;
  float slack_;
};

struct SelectOptions {
  double radius = 0;         ///< R of all points, m; 0: each has its own
  bool raw_weights = false;  ///< density weights do not count
  int most_visits = 1 << 30;
};

/// Chooses the points of a patch: all whose support reaches into a ball at any time until the
/// layers' `until`. When they are more than there is room for, every 2nd, 4th, ... of the index's
/// order. All memory is taken by the constructor.
class Selection {
 public:
  /// The points that were chosen from one layer.
  struct Run {
    double from = 0;  ///< progress
    double until = 0;
    bool counts = false;      // does its weight let it be seen at any time until then?
    std::uint32_t first = 0;  ///< of the indices
    std::uint32_t count = 0;
  };

  /// `capacity`: the indices, when each source's are filled up to a multiple of simd::kLanes.
  explicit Selection(std::size_t capacity);

  /// `layers`: in the order of their sources. False when it has made `most_visits` and did not come
  /// to the end, or there are more than kMostLayers; then nothing is chosen.
  [[nodiscard]] bool choose(std::span<const ActiveLayer> layers, const Ball& ball,
                            const SelectOptions& options) noexcept;

  /// Chooses once more in the same ball. `before`: for each layer, which of the runs so far is also
  /// what would be chosen of it now, and is taken over; kNone: there is none.
  [[nodiscard]] bool renew(std::span<const ActiveLayer> layers, std::span<const std::size_t> before,
                           int most_visits) noexcept;

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();  ///< no run

  /// One for each layer.
  [[nodiscard]] std::span<const Run> runs() const noexcept { return runs_; }
  /// Indices in the layer's sorted order, rising.
  [[nodiscard]] std::span<const std::uint32_t> indices(const Run& run) const noexcept {
    return std::span(indices_).subspan(run.first, run.count);
  }
  [[nodiscard]] std::uint32_t stride() const noexcept { return stride_; }
  /// Cells and points that were looked at.
  [[nodiscard]] int visits() const noexcept { return visits_; }

 private:
  void begin() noexcept;
  [[nodiscard]] bool choose_all(std::span<const ActiveLayer> layers,
                                std::span<const std::size_t> before) noexcept;
  [[nodiscard]] bool take_over(const Run& run) noexcept;
  [[nodiscard]] bool take(std::uint32_t index) noexcept;
  [[nodiscard]] bool walk(const ActiveLayer& layer) noexcept;
  [[nodiscard]] bool take_near(const ActiveLayer& start, const ActiveLayer& last,
                               std::uint32_t begin, std::uint32_t end) noexcept;
  [[nodiscard]] bool reaches(const ActiveLayer& start, const ActiveLayer& last,
                             std::uint32_t i) const noexcept;
  [[nodiscard]] bool counts(const ActiveLayer& start, const ActiveLayer& last,
                            std::uint32_t i) const noexcept;
  void thin() noexcept;
  [[nodiscard]] std::size_t filled_up(std::span<const ActiveLayer> layers) const noexcept;

  std::vector<std::uint32_t> indices_, indices_before_;
  std::vector<Run> runs_, runs_before_;
  std::uint32_t used_ = 0;
  std::uint32_t stride_ = 1;
  int visits_ = 0;
  Ball ball_;
  SelectOptions options_;
};

}  // namespace palpate
