#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "rivals/god_object.hpp"

namespace palpate::rivals {

/// A depth image tessellated into triangles ("terrain"), in the sensor's frame, m: two of them in
/// each square of four pixels, divided along the shorter diagonal, and none across a jump of depth.
class FrameMesh {
 public:
  /// Corners, numbered row by row as pixels are. Seen from the sensor they go round so that
  /// normal() points to it.
  using Triangle = std::array<int, 3>;

  FrameMesh() = default;
  /// `jump`: no triangle has corners whose depths differ by more pixel footprints than that.
  FrameMesh(const DepthFrame& frame, double jump);

  /// Vertices begin where they are in `before` and go in straight lines: `share` of the way.
  void come_from(const FrameMesh& before);
  void go_on(double share) { share_ = share; }

  [[nodiscard]] bool measured(int vertex) const {
    return vertices_[static_cast<std::size_t>(vertex)].z() > 0;
  }
  [[nodiscard]] Eigen::Vector3d at(int vertex) const {
    const auto i = static_cast<std::size_t>(vertex);
    if (share_ >= 1) return vertices_[i];
    return begins_[i] + share_ * (vertices_[i] - begins_[i]);
  }
  [[nodiscard]] int vertices() const { return static_cast<int>(vertices_.size()); }
  /// Unit, towards the sensor.
  [[nodiscard]] Eigen::Vector3d normal(const Triangle& triangle) const;
  /// Mean of the triangles at the corners, weighted by area, between which it is interpolated.
  [[nodiscard]] Eigen::Vector3d smooth_normal(const Triangle& triangle,
                                              const Eigen::Vector3d& place) const;
  /// Replaces `found` by the triangles that have this corner.
  void triangles_at(int vertex, std::vector<Triangle>& found) const;

  /// The first triangle whose front a point meets that goes straight from here to there, but those
  /// of `except`.
  [[nodiscard]] std::optional<Met<Triangle>> first_met(const Eigen::Vector3d& from,
                                                       const Eigen::Vector3d& to,
                                                       std::span<const Triangle> except) const;

  /// The front that hides a place from the sensor.
  [[nodiscard]] std::optional<Met<Triangle>> before(const Eigen::Vector3d& place) const {
    if (vertices() == 0) return std::nullopt;
    return first_met(place * (kBefore / place.z()), place, {});
  }

 private:
  static constexpr double kBefore = 0.02;  // m from the sensor; judgement: nothing is nearer
  struct Way;
  [[nodiscard]] bool joined(int a, int b, int c) const;
  [[nodiscard]] std::uint8_t divide(int corner) const;
  [[nodiscard]] int triangles_in(int column, int row, std::array<Triangle, 2>& found) const;
  [[nodiscard]] Eigen::Vector3d vertex_normal(int vertex) const;
  void meet(int column, int row, Way& way) const;

  int width_ = 0;
  int height_ = 0;
  double jump_ = 0;  // share of the depth
  Pinhole pinhole_;
  double share_ = 1;
  std::vector<Eigen::Vector3d> vertices_;  // z = 0: nothing measured
  std::vector<Eigen::Vector3d> begins_;    // where they come from; empty: they do not move
  std::vector<std::uint8_t> cells_;        // bits: which of the two triangles, and which diagonal
};

}  // namespace palpate::rivals
