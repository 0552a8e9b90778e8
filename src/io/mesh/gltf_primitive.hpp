#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "io/mesh/gltf_data.hpp"
#include "io/mesh/mesh.hpp"

namespace palpate::io {

/// Where the vertices of a mesh go.
struct GltfPlace {
  Eigen::Affine3d transform;
  const std::vector<Eigen::Affine3d>* joints = nullptr;  ///< of its skin; null: it has none
  std::vector<double> weights{};                         ///< of morph targets
};

/// A part of a mesh: its vertices with their places and colours, and its corners.
class GltfPrimitive {
 public:
  /// `file` must outlive it.
  explicit GltfPrimitive(GltfFile& file) : file_(file) {}

  /// Makes it this part. False: that has no vertices. `place` must outlive what follows.
  [[nodiscard]] bool take(const nlohmann::json& primitive, const GltfPlace& place);

  [[nodiscard]] std::size_t vertex_count() const { return positions_.count; }
  [[nodiscard]] std::size_t corner_count() const {
    return corners_ ? corners_->count : positions_.count;
  }
  /// The vertex that a corner names. @throws Error where there is none.
  [[nodiscard]] std::size_t index_of_corner(std::size_t i) const;
  [[nodiscard]] MeshVertex vertex_at(std::size_t i) const;
  [[nodiscard]] bool has_colors() const {
    return colors_.has_value() || factor_ != std::array<double, 4>{1, 1, 1, 1};
  }

 private:
  void take_colors(const nlohmann::json& primitive, const nlohmann::json& attributes);
  void take_skin(const nlohmann::json& attributes);
  void take_morphs(const nlohmann::json& primitive);
  [[nodiscard]] Eigen::Vector3d position(std::size_t i) const;
  [[nodiscard]] Eigen::Vector3d led_by_joints(std::size_t i, const Eigen::Vector3d& local) const;

  GltfFile& file_;
  const GltfPlace* place_ = nullptr;
  GltfNumbers positions_;
  std::optional<GltfNumbers> corners_;
  std::optional<GltfNumbers> colors_;
  std::optional<std::pair<GltfNumbers, GltfNumbers>> skin_;  // joints and their shares
  std::vector<std::pair<double, GltfNumbers>> morphs_;       // weights and shifts
  std::array<double, 4> factor_{};
};

}  // namespace palpate::io
