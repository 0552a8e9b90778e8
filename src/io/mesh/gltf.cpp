// Reads the triangles of glTF and GLB scenes, or the points of those that have no triangles.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh/gltf_data.hpp"
#include "io/mesh/gltf_primitive.hpp"
#include "io/mesh/gltf_scene.hpp"
#include "io/mesh/mesh.hpp"

namespace palpate::io {
namespace {

using nlohmann::json;

// Corners and vertices of all instances. A small file can repeat a mesh without end; this takes 2
// GB at most (judgement)
constexpr std::size_t kMostCorners = 30'000'000;

// Primitives of all instances: many nodes can share a mesh of many empty ones. They are looked
// through in some seconds (judgement)
constexpr std::size_t kMostPrimitives = 3'000'000;

// Primitive modes: points, and those that have faces (format).
constexpr std::size_t kPoints = 0;
constexpr std::size_t kTriangles = 4;
constexpr std::size_t kStrip = 5;
constexpr std::size_t kFan = 6;

class GltfReader {
 public:
  explicit GltfReader(const Input& input) : input_(input), file_(input), part_(file_) {}

  CloudFile run() {
    GltfScene scene(file_, input_.options);
    for (const GltfInstance& each : scene.instances()) {
      const json& mesh = file_.element("meshes", each.mesh);
      add_mesh(mesh, {.transform = each.transform,
                      .joints = each.skin ? &scene.joints(*each.skin) : nullptr,
                      .weights = weights_of(*each.node, mesh)});
    }
    const std::string format = this->format();
    if (!mesh_.ends.empty()) return sample_faces(input_, mesh_, format);
    if (!points_.empty()) return cloud_of_points(format);
    fail(input_, "the scene of this glTF file has neither triangles nor points",
         "Export it again with its meshes");
  }

 private:
  // What of the scene is not felt.
  struct Left {
    bool lines = false;
    bool splats = false;  // as such: their centres are felt
    bool points = false;  // beside faces
    bool joints = false;  // beyond four of a vertex
  };

  [[nodiscard]] std::string format() const {
    std::string text = input_.text().starts_with("glTF") ? "glTF, binary" : "glTF";
    const std::size_t scenes = file_.list("scenes").size();
    if (scenes > 1) text += fmt::format(", one of {} scenes", scenes);
    if (left_.splats) text += ", of Gaussian splats the centres alone";
    if (left_.lines) text += ", without its lines";
    if (left_.points && !mesh_.ends.empty()) text += ", without its points";
    if (left_.joints) text += ", four joints a vertex";
    if (!file_.list("animations").empty()) text += ", without its animations";
    return text;
  }

  std::vector<double> weights_of(const json& node, const json& mesh) const {
    const json* weights = find_member(node, "weights");
    if (weights == nullptr) weights = find_member(mesh, "weights");
    std::vector<double> result;
    if (weights == nullptr || !weights->is_array()) return result;
    for (const json& each : *weights) {
      if (!each.is_number()) file_.wrong("\"weights\" are not all numbers");
      result.push_back(each.get<double>());
    }
    return result;
  }

  void add_mesh(const json& mesh, const GltfPlace& place) {
    const json* primitives = find_member(mesh, "primitives");
    if (primitives == nullptr || !primitives->is_array()) return;
    for (const json& each : *primitives) {
      if (++primitives_ > kMostPrimitives) {
        fail_too_large(fmt::format("{} million parts of meshes", kMostPrimitives / 1'000'000));
      }
      const std::size_t mode = file_.whole(each, "mode").value_or(kTriangles);
      const bool faces = mode >= kTriangles && mode <= kFan;
      left_.lines |= mode > kPoints && mode < kTriangles;
      if (!(faces || mode == kPoints) || !part_.take(each, place)) continue;
      mesh_.columns.colors |= part_.has_colors();
      note(each, faces);
      faces ? add_faces(mode, place.transform.linear().determinant() < 0) : add_points();
    }
  }

  void note(const json& primitive, bool faces) {
    const json* extensions = find_member(primitive, "extensions");
    left_.points |= !faces;
    left_.splats |=
        extensions != nullptr && find_member(*extensions, "KHR_gaussian_splatting") != nullptr;
    left_.joints |= find_member(primitive["attributes"], "JOINTS_1") != nullptr;
  }

  void add_points() {
    for (std::size_t i = 0; i < part_.corner_count(); ++i) {
      points_.push_back(part_.vertex_at(part_.index_of_corner(i)));
      if (points_.size() > kMostCorners) {
        fail_too_large(fmt::format("{} million points", kMostCorners / 1'000'000));
      }
    }
  }

  CloudFile cloud_of_points(const std::string& format) {
    CloudBuilder builder(input_, mesh_.columns, ColorScale::byte, points_.size());
    Row row{};
    for (const MeshVertex& vertex : points_) {
      std::copy_n(vertex.data(), 3, row.begin());
      std::copy_n(vertex.data() + 3, 3, row.begin() + index_of(Role::red));
      builder.add(row);
    }
    return builder.finish(format);
  }

  void add_faces(std::size_t mode, bool mirrored) {
    const std::size_t count = part_.corner_count();
    if (count < 3) return;
    if (index_.size() < part_.vertex_count()) index_.resize(part_.vertex_count(), kNowhere);
    for (std::size_t i = 0; i + 2 < count; i += mode == kTriangles ? 3 : 1) {
      const bool swapped = mirrored != (mode == kStrip && i % 2 == 1);
      const std::size_t first = corner(mode == kFan ? 0 : i);
      const std::size_t second = corner(i + (swapped ? 2 : 1));
      mesh_.add_triangle(first, second, corner(i + (swapped ? 1 : 2)));
      if (std::max(mesh_.corners.size(), mesh_.vertices.size()) > kMostCorners) {
        fail_too_large(fmt::format("{} million triangles", kMostCorners / 3'000'000));
      }
    }
    for (const std::size_t vertex : indexed_) index_[vertex] = kNowhere;
    indexed_.clear();
  }

  [[noreturn]] void fail_too_large(std::string_view most) const {
    fail(input_, fmt::format("its scene has more than {}", most),
         "Export the part that is to be felt alone, or simplify it");
  }

  // The vertex in the mesh of a corner of the primitive.
  std::size_t corner(std::size_t i) {
    const std::size_t vertex = part_.index_of_corner(i);
    if (index_[vertex] == kNowhere) {
      index_[vertex] = static_cast<std::uint32_t>(mesh_.vertices.size());
      indexed_.push_back(vertex);
      mesh_.vertices.push_back(part_.vertex_at(vertex));
    }
    return index_[vertex];
  }

  static constexpr std::uint32_t kNowhere = 0xFFFFFFFF;

  const Input& input_;
  GltfFile file_;
  Mesh mesh_;
  std::vector<MeshVertex> points_;
  GltfPrimitive part_;  // that is being read
  Left left_;
  std::vector<std::uint32_t> index_;  // of its vertices in the mesh; between primitives kNowhere
  std::vector<std::size_t> indexed_;  // those that have one
  std::size_t primitives_ = 0;        // of all instances so far
};

}  // namespace

CloudFile read_gltf(const Input& input) {
  return GltfReader(input).run();
}

}  // namespace palpate::io
