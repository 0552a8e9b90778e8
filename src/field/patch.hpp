#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/simd/sums.hpp"
#include "palpate/field/field.hpp"
#include "palpate/field/surface_points.hpp"

namespace palpate {

/// One layer of points as it counts at the present moment.
struct ActiveLayer {
  const SurfacePoints* points = nullptr;
  int source = 0;
  double weight = 1;    ///< C_k
  double progress = 0;  ///< 0 at the points' start (A), 1 at their end (B)
  double rate = 0;      ///< d progress / dt, 1/s
};

struct GatherOptions {
  double radius = 0;         ///< R of all points, m; 0: each has its own
  bool raw_weights = false;  ///< leave out the density weights
  bool normals = true;       ///< copy normals and confidences; metaballs need none
};

/// The points around a place, copied into columns relative to that place: what the sums run over.
///
/// It holds every point whose support reaches into the ball (center, extra), so a sample anywhere
/// in that ball is exact. All memory is taken by the constructor. When more points are near than it
/// holds, every 2nd, 4th, ... of the index's order is taken and weighs as much more.
class Patch {
 public:
  explicit Patch(std::size_t capacity);

  /// `layers` in the order of their sources.
  void gather(std::span<const ActiveLayer> layers, int sources, const Eigen::Vector3d& center,
              double extra, const GatherOptions& options = {}) noexcept;

  /// The radius of the point nearest to x (the paper's section III-D), m; 0 of an empty patch.
  [[nodiscard]] double nearest_radius(const Eigen::Vector3d& x) const noexcept;

  /// Covers nothing until the next gather.
  void clear() noexcept { extra_ = -1; }

  [[nodiscard]] bool covers(const Ball& ball) const noexcept {
    const double slack = extra_ - ball.radius;
    return slack >= 0 && (ball.center - center_).squaredNorm() <= slack * slack;
  }
  [[nodiscard]] const Eigen::Vector3d& center() const noexcept { return center_; }
  [[nodiscard]] std::size_t points() const noexcept { return count_; }
  [[nodiscard]] bool thinned() const noexcept { return stride_ > 1; }
  [[nodiscard]] double smallest_radius() const noexcept { return smallest_radius_; }
  /// Mean of the points' radii; of an empty patch, its own reach.
  [[nodiscard]] double mean_radius() const noexcept { return mean_radius_; }
  [[nodiscard]] const simd::Columns& columns() const noexcept { return columns_; }

  /// Of the k-th column entry; 1, 1 and 0 where no layer has any.
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
    kSharp,
    kSlope,
    kTrusted,
    kCloseness,
    kMaterial = kCloseness + 2,
    kPresence,
    kVelocity,
    kColumns = kVelocity + 3
  };

  [[nodiscard]] double* column(int c) noexcept { return data_.data() + c * pitch_; }
  [[nodiscard]] const double* column(int c) const noexcept { return data_.data() + c * pitch_; }
  [[nodiscard]] bool gather_all(std::span<const ActiveLayer> layers, int sources) noexcept;
  [[nodiscard]] bool gather_layer(const ActiveLayer& layer) noexcept;
  [[nodiscard]] bool take_near(const ActiveLayer& layer, std::uint32_t begin,
                               std::uint32_t end) noexcept;
  void fill(const ActiveLayer& layer, std::uint32_t first) noexcept;
  void fill_normals(const ActiveLayer& layer, std::uint32_t first) noexcept;
  void fill_sharpness(const ActiveLayer& layer, std::uint32_t first) noexcept;
  [[nodiscard]] double inverse_square(double radius) noexcept;
  void pad() noexcept;

  std::size_t capacity_;
  std::size_t pitch_;  // from column to column; no power of two, or they share cache sets
  std::vector<double> data_;
  std::vector<std::uint32_t> index_;  // in its layer, for each entry of a column
  simd::Columns columns_{};
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double extra_ = -1;
  GatherOptions options_;
  std::vector<std::uint32_t> near_;  // scratch of the sums
  bool has_sharp_ = false;
  bool has_materials_ = false;
  bool has_presences_ = false;
  bool has_motion_ = false;
  std::uint32_t used_ = 0;  // with padding
  std::size_t count_ = 0;   // without
  std::uint32_t stride_ = 1;
  double smallest_radius_ = 0;
  double largest_radius_ = 0;
  double radius_sum_ = 0;
  double mean_radius_ = 0;
  double last_radius_ = 0;
  double last_inverse_r2_ = 0;
};

/// The position of a layer's point now, relative to `center` (world frame).
[[nodiscard]] Eigen::Vector3d position_now(const ActiveLayer& layer, std::uint32_t i,
                                           const Eigen::Vector3d& center) noexcept;

/// The support radius of a layer's point now, m.
[[nodiscard]] double radius_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// Does a point count for nothing at any time (speckle)?
[[nodiscard]] bool weightless(const SurfacePoints& points, std::uint32_t i) noexcept;

/// Do any of the points have a presence of their own?
[[nodiscard]] inline bool fades(const SurfacePoints& points) noexcept {
  return !points.presences.empty() || !points.end_presences.empty();
}

/// a_i C_k now; C_k alone with `raw_weights`.
[[nodiscard]] double weight_now(const ActiveLayer& layer, std::uint32_t i,
                                bool raw_weights) noexcept;

}  // namespace palpate
