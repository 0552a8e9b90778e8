#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "io/mesh/gltf_data.hpp"

namespace palpate::io {

/// A mesh at a place of a scene.
struct GltfInstance {
  std::size_t mesh = 0;
  const nlohmann::json* node = nullptr;
  Eigen::Affine3d transform;          ///< to a world whose z is up
  std::optional<std::size_t> skin{};  ///< whose joints place it instead, each vertex by its own
};

/// What the nodes of a glTF file place, and where.
class GltfScene {
 public:
  /// @throws Error for nodes that are not there or have two parents, and for more than three
  /// million instances. `file` must outlive it.
  GltfScene(GltfFile& file, const ReadOptions& options);

  /// Meshes in the order of the nodes; those of EXT_mesh_gpu_instancing as often as it says.
  [[nodiscard]] const std::vector<GltfInstance>& instances() const { return instances_; }

  /// What leads a vertex along with each joint of a skin: from where it is bound to the world.
  [[nodiscard]] const std::vector<Eigen::Affine3d>& joints(std::size_t skin);

 private:
  [[nodiscard]] std::vector<std::size_t> roots() const;
  [[nodiscard]] std::vector<std::size_t> nobodys_children() const;
  void walk(const std::vector<std::size_t>& from, bool in_scene, const ReadOptions& options);
  void place(std::size_t node);

  GltfFile& file_;
  std::vector<Eigen::Affine3d> places_;  // of nodes
  std::vector<bool> seen_;               // nodes
  std::vector<GltfInstance> instances_;
  std::map<std::size_t, std::vector<Eigen::Affine3d>> joints_;  // of skins that were asked for
};

}  // namespace palpate::io
