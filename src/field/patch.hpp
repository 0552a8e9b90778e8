// A patch: the points around the tool, gathered once and summed many times.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/facing.hpp"
#include "field/selection.hpp"
#include "field/simd/sums.hpp"
#include "palpate/field/field.hpp"
#include "palpate/field/surface_points.hpp"

namespace palpate {

/// How points are gathered into a patch.
struct GatherOptions {
  double radius = 0;               ///< R of all points, m; 0: each has its own
  bool raw_weights = false;        ///< leave out the density weights
  bool normals = true;             ///< copy normals and confidences; metaballs need none
  Rise rise = {};                  ///< of the surface above its points
  int most_visits = 1 << 30;       ///< cells and points that may be looked at
  const Stance* stance = nullptr;  ///< that points are turned to; nullptr: they stay as they are
};

/// The points around a place, copied into columns relative to that place: what the sums run over.
///
/// It holds every point whose support reaches into the ball (center, extra), so a sample anywhere
/// in that ball is exact, and stays so while the points move: advance() follows them. All memory is
/// taken by the constructor. When more points are near than it holds, every 2nd, 4th, ... of the
/// index's order is taken and weighs as much more.
class Patch {
 public:
  explicit Patch(std::size_t capacity);

  /// `layers` in the order of their sources. False when it has looked at `most_visits` cells and
  /// points and did not come to the end; then it covers nothing.
  bool gather(std::span<const ActiveLayer> layers, int sources, const Eigen::Vector3d& center,
              double extra, const GatherOptions& options = {}) noexcept;

  /// Moves what was gathered to where it is now. `layers`: the same as then; where their points
  /// change, their progress between what it was then and the `until` of then. False when they are
  /// others; then the patch covers nothing. Layers are compared by address: call clear() before
  /// others can come to the same one.
  bool advance(std::span<const ActiveLayer> layers) noexcept;

  /// Turns points to the tool where it is now and sorts them by how their sheets meet.
  void face(const Stance& stance) noexcept;
  /// What is decided of the sheets; holds from the next face() on.
  [[nodiscard]] Facing& sides() noexcept { return facing_; }
  [[nodiscard]] const Facing& sides() const noexcept { return facing_; }

  /// Gathers again at the same place after advance() was refused, and looks for points in those
  /// layers alone that are others. False as gather() says it.
  bool renew(std::span<const ActiveLayer> layers, int sources, int most_visits,
             const Stance* stance = nullptr) noexcept;

  /// The radius of the point nearest to x (the paper's section III-D), m; 0 of an empty patch.
  [[nodiscard]] double nearest_radius(const Eigen::Vector3d& x) const noexcept;

  /// Covers nothing until the next gather.
  void clear() noexcept { extra_ = -1; }

  [[nodiscard]] bool covers(const Ball& ball) const noexcept { return !outdated_ && reaches(ball); }
  /// Would it cover the ball, once renewed?
  [[nodiscard]] bool reaches(const Ball& ball) const noexcept {
    const double slack = extra_ - ball.radius;
    return slack >= 0 && (ball.center - center_).squaredNorm() <= slack * slack;
  }
  /// Has advance() been refused since it was gathered?
  [[nodiscard]] bool outdated() const noexcept { return outdated_; }
  [[nodiscard]] const Eigen::Vector3d& center() const noexcept { return center_; }
  /// How far from its centre positions are covered, m; below 0: none is.
  [[nodiscard]] double extra() const noexcept { return extra_; }
  [[nodiscard]] std::size_t points() const noexcept { return count_; }
  /// 1: all points that are there were taken; n: every n-th.
  [[nodiscard]] std::uint32_t stride() const noexcept { return selection_.stride(); }
  [[nodiscard]] bool thinned() const noexcept { return stride() > 1; }
  /// Cells and points that the last gather looked at.
  [[nodiscard]] int visits() const noexcept { return selection_.visits(); }
  [[nodiscard]] double smallest_radius() const noexcept { return smallest_radius_; }
  /// Mean of the points' radii; of an empty patch, its own reach.
  [[nodiscard]] double mean_radius() const noexcept { return mean_radius_; }
  [[nodiscard]] const simd::Columns& columns() const noexcept { return columns_; }

  /// Material, presence (0-1) and velocity (m/s) of the k-th column entry; 1, 1 and 0 where no
  /// layer has any.
  [[nodiscard]] double material(std::uint32_t k) const noexcept {
    return has_materials_ ? column(kMaterial)[k] : 1;
  }
  [[nodiscard]] bool has_presences() const noexcept { return has_presences_; }
  [[nodiscard]] double presence(std::uint32_t k) const noexcept {
    return has_presences_ ? column(kPresence)[k] : 1;
  }
  [[nodiscard]] Eigen::Vector3d velocity(std::uint32_t k) const noexcept {
    if (!has_motion_) return Eigen::Vector3d::Zero();
    return {column(kVelocity)[k], column(kVelocity + 1)[k], column(kVelocity + 2)[k]};
  }

 private:
  enum Column {
    kPosition = 0,
    kNormal = 3,
    kWeight = 6,
    kConfidence,
    kRadius,
    kInverseR2,
    kEdgeNormal,
    kEdgeHeight = kEdgeNormal + 3,
    kEdgeShare,
    kSlope,
    kMaterial,
    kPresence,
    kVelocity,
    kColumns = kVelocity + 3
  };

  [[nodiscard]] double* column(int c) noexcept { return data_.data() + c * pitch_; }
  [[nodiscard]] const double* column(int c) const noexcept { return data_.data() + c * pitch_; }
  void copy(std::span<const ActiveLayer> layers, int sources, bool whole) noexcept;
  bool turn(const Stance& stance) noexcept;
  [[nodiscard]] bool follows(const ActiveLayer& now, std::size_t k) const noexcept;
  [[nodiscard]] std::size_t followed_by(const ActiveLayer& now) const noexcept;
  void lay_out() noexcept;
  void fill(std::span<const ActiveLayer> layers) noexcept;
  void each_of(std::size_t k, const auto& visit) noexcept;
  void fill_layer(std::size_t k) noexcept;
  void fill_all() noexcept;
  void fill_weights(std::size_t k) noexcept;
  void fill_normals(std::size_t k) noexcept;
  void fill_edges(std::size_t k) noexcept;
  [[nodiscard]] bool knows_edges() const noexcept;
  void measure() noexcept;
  void pad(std::uint32_t begin, std::uint32_t end) noexcept;

  std::size_t capacity_;
  std::size_t pitch_;  // from column to column; no power of two, or they share cache sets
  std::vector<double> data_;
  Selection selection_;
  std::vector<ActiveLayer> layers_;  // as they are in the columns
  Facing facing_;
  std::vector<std::int8_t> signs_;    // of the chosen places, layer by layer
  std::vector<std::uint8_t> labels_;  // of the same
  std::vector<std::uint32_t> slots_;  // where each of them is in the columns
  std::vector<std::uint32_t> near_;   // scratch of the sums
  simd::Columns columns_{};
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double extra_ = -1;
  bool outdated_ = false;
  GatherOptions options_;
  bool has_materials_ = false;
  bool has_presences_ = false;
  bool has_motion_ = false;
  int sources_ = 1;
  std::size_t count_ = 0;  // without the padding
  double smallest_radius_ = 0;
  double mean_radius_ = 0;
};

}  // namespace palpate
