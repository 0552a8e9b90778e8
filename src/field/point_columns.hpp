// The points of a patch in columns, which the sums run over.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/facing.hpp"
#include "field/selection.hpp"
#include "field/simd/sums.hpp"
#include "palpate/geometry/shapes.hpp"

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

/// The points that a patch has chosen, layer by layer, and what is decided of each.
struct GatheredPoints {
  explicit GatheredPoints(std::size_t capacity) : selection(capacity) {
    layers.reserve(kMostLayers);
    signs.reserve(capacity);
    labels.reserve(capacity);
  }

  Selection selection;
  std::vector<ActiveLayer> layers;   ///< as they are in the columns
  std::vector<std::int8_t> signs;    ///< of the chosen points; 0: it counts for nothing
  std::vector<std::uint8_t> labels;  ///< of the same
  int sources = 1;
  Ball ball{.radius = -1};  ///< they are all that reach into it; radius below 0: of no ball
  GatherOptions options;
};

/// What the sums read, and what else is stored of each point.
struct PatchColumns : simd::Columns {
  const double* material = nullptr;  ///< nullptr: all 1
  const double* presence = nullptr;  ///< 0-1; nullptr: all 1
  const double* velocity[3] = {};    ///< m/s, where it moves
  bool moves = false;                ///< does any point?
  double smallest_radius = 0;        ///< m
  double mean_radius = 0;            ///< m; without points, the radius of the patch's ball

  /// The radius of the point nearest to x (the paper's section III-D), m; 0: there is no point.
  /// `x`: from the centre, m.
  [[nodiscard]] double nearest_radius(const Eigen::Vector3d& x) const noexcept;
};

/// Writes points into columns as their layers are, relative to the centre of the ball. Memory is
/// taken by the constructor alone.
class PointColumns {
 public:
  /// `capacity`: points at most, a multiple of simd::kLanes.
  explicit PointColumns(std::size_t capacity);

  /// Writes points that were gathered.
  void write(const GatheredPoints& points) noexcept;
  /// Writes the same points, with other signs and labels.
  void sort(const GatheredPoints& points) noexcept;
  /// Brings the points to what their layers are now.
  void advance(GatheredPoints& points, std::span<const ActiveLayer> layers) noexcept;

  [[nodiscard]] const PatchColumns& columns() const noexcept { return columns_; }

 private:
  [[nodiscard]] double* column(int c) noexcept { return data_.data() + c * pitch_; }
  void lay_out(const GatheredPoints& points) noexcept;
  void pad(std::uint32_t begin, std::uint32_t end) noexcept;
  void each_of(const GatheredPoints& points, std::size_t k, const auto& visit) noexcept;
  void fill_layer(const GatheredPoints& points, std::size_t k) noexcept;
  void fill_weights(const GatheredPoints& points, std::size_t k) noexcept;
  void fill_normals(const GatheredPoints& points, std::size_t k) noexcept;
  void measure(double reach) noexcept;

  std::size_t pitch_;  // from column to column; no power of two, or they share cache sets
  std::vector<double> data_;
  std::vector<std::uint32_t> slots_;  // where each of the chosen points is in the columns
  std::vector<std::uint32_t> near_;   // scratch of the sums
  PatchColumns columns_{};
};

}  // namespace palpate
