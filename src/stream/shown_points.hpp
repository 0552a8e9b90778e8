// Declares the points that were shown last.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "depth/frame_timing.hpp"
#include "palpate/field/surface_points.hpp"
#include "stream/moving_points.hpp"

namespace palpate {

/// The points that were shown last, as they are when the next snapshot starts, and what is
/// remembered of each.
class ShownPoints {
 public:
  /// In a frame a surface may be so much faster than in the one before, m/s: at 500 N/m 0.3 N a
  /// millisecond, the guard's slew. No more speed than this is believed of what comes nearer.
  static constexpr float kSudden = 0.6f;

  /// Sets when the next snapshot starts; its points are relative to `origin`.
  void begin(const FrameTiming& next, const Eigen::Vector3d& origin);

  /// Takes what is shown from now on. `entries` of its points; gets those of before, to be
  /// overwritten.
  void replace(std::shared_ptr<const SurfacePoints> points, const FrameTiming& moment,
               std::vector<Entry>& entries);

  void forget();

  [[nodiscard]] bool any() const { return points_ != nullptr; }
  [[nodiscard]] double stamp() const { return moment_.stamp; }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] std::vector<Entry>& entries() { return entries_; }

  [[nodiscard]] PointState at(std::uint32_t i) const;
  /// The same of four that follow one another.
  [[nodiscard]] PointStates four_at(std::uint32_t i) const;
  /// The same of where they are at the end.
  [[nodiscard]] PointStates end_of_four(std::uint32_t i) const;

  /// Unit, from a point to where it was seen from.
  [[nodiscard]] Eigen::Vector3f to_eye(std::uint32_t i) const;

  /// Where a point's weight goes.
  [[nodiscard]] float end_weight(std::uint32_t i) const { return points_->end_density_weights[i]; }

  /// How fast a point has moved along its normal while the last snapshot lasted, m/s.
  [[nodiscard]] float speed_of(std::uint32_t i) const;

  /// The edge that each is beside, or SurfacePoints::Edges::kNone.
  [[nodiscard]] const std::vector<std::uint32_t>& edges() const { return points_->edges.of_point; }
  [[nodiscard]] SurfacePoints::EdgePlane edge_of(std::uint32_t i) const;

 private:
  std::shared_ptr<const SurfacePoints> points_;
  FrameTiming moment_;
  std::vector<Entry> entries_;
  double progress_ = 1;                              // at the next start
  Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();  // from their origin to the next one
};

}  // namespace palpate
