// Reads the triangles of glTF and GLB scenes, or the points of those that have no triangles.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh/gltf_data.hpp"
#include "io/mesh/mesh.hpp"

namespace palpate::io {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
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

// A list of numbers, or `otherwise` where the object has none.
template <std::size_t N>
std::array<double, N> numbers_of(const GltfFile& file, const json& object, const char* name,
                                 const std::array<double, N>& otherwise) {
  const json* found = find_member(object, name);
  if (found == nullptr) return otherwise;
  std::array<double, N> result{};
  bool good = found->is_array() && found->size() == N;
  for (std::size_t i = 0; good && i < N; ++i) {
    good = (*found)[i].is_number();
    if (good) result[i] = (*found)[i].get<double>();
  }
  if (!good) file.wrong(fmt::format("\"{}\" is not {} numbers", name, N));
  return result;
}

Affine3d transform_of(const GltfFile& file, const json& node) {
  Affine3d transform = Affine3d::Identity();
  if (find_member(node, "matrix") != nullptr) {
    const auto m = numbers_of<16>(file, node, "matrix", {});
    transform.matrix() = Eigen::Matrix4d(m.data());  // column by column, as Eigen has them
    return transform;
  }
  const auto t = numbers_of<3>(file, node, "translation", {0, 0, 0});
  const auto q = numbers_of<4>(file, node, "rotation", {0, 0, 0, 1});
  const auto s = numbers_of<3>(file, node, "scale", {1, 1, 1});
  transform.translate(Vector3d(t.data()));
  transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  transform.scale(Vector3d(s.data()));
  return transform;
}

// 0 ... 255 of a share of light, as pictures have it (sRGB).
double shade(double light) {
  const double v = std::clamp(light, 0.0, 1.0);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

class GltfReader {
 public:
  explicit GltfReader(const Input& input) : input_(input), file_(input) {}

  CloudFile run() {
    walk();
    const char* format = input_.text().starts_with("glTF") ? "glTF, binary" : "glTF";
    if (!mesh_.ends.empty()) return sample_faces(input_, mesh_, format);
    if (!points_.empty()) return cloud_of_points(format);
    fail(input_, "the scene of this glTF file has neither triangles nor points",
         "Export it again with its meshes");
  }

 private:
  struct Placed {
    std::size_t node;
    Affine3d transform;
  };

  // Nodes of the scene; without one, those that are nobody's children.
  std::vector<std::size_t> roots() const {
    const std::size_t scene = file_.whole(file_.root(), "scene").value_or(0);
    if (!file_.list("scenes").empty()) return indices(file_.element("scenes", scene), "nodes");
    std::vector<bool> is_child(file_.list("nodes").size());
    for (const json& node : file_.list("nodes")) {
      for (const std::size_t child : indices(node, "children")) {
        if (child < is_child.size()) is_child[child] = true;
      }
    }
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) found.push_back(i);
    }
    return found;
  }

  std::vector<std::size_t> indices(const json& object, const char* name) const {
    std::vector<std::size_t> result;
    const json* found = find_member(object, name);
    if (found == nullptr || !found->is_array()) return result;
    for (const json& each : *found) {
      if (!each.is_number_unsigned()) file_.wrong(fmt::format("\"{}\" are not all counts", name));
      result.push_back(each.get<std::size_t>());
    }
    return result;
  }

  // Every node once. Lengths are metres and y is up; here z is.
  void walk() {
    Affine3d upright = Affine3d::Identity();
    upright.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    std::vector<bool> seen(file_.list("nodes").size());
    std::vector<Placed> open;
    const auto enter = [&](std::size_t node, const Affine3d& transform) {
      (void)file_.element("nodes", node);  // is it there?
      if (seen[node]) file_.wrong(fmt::format("node {} has two parents", node));
      seen[node] = true;
      open.push_back({node, transform});
    };
    for (const std::size_t root : roots()) enter(root, upright);
    Progress progress(input_.options, seen.size());
    for (std::size_t done = 0; !open.empty(); ++done) {
      const Placed at = open.back();
      open.pop_back();
      const json& node = file_.element("nodes", at.node);
      const Affine3d transform = at.transform * transform_of(file_, node);
      if (const auto mesh = file_.whole(node, "mesh")) {
        add_mesh(file_.element("meshes", *mesh), transform);
      }
      for (const std::size_t child : indices(node, "children")) enter(child, transform);
      progress.at(done);
    }
  }

  void add_mesh(const json& mesh, const Affine3d& transform) {
    const json* primitives = find_member(mesh, "primitives");
    if (primitives == nullptr || !primitives->is_array()) return;
    for (const json& each : *primitives) {
      if (++primitives_ > kMostPrimitives) {
        fail_too_large(fmt::format("{} million parts of meshes", kMostPrimitives / 1'000'000));
      }
      const std::size_t mode = file_.whole(each, "mode").value_or(kTriangles);
      const bool faces = mode >= kTriangles && mode <= kFan;
      if (!(faces || mode == kPoints) || !take(each)) continue;
      transform_ = transform;
      faces ? add_faces(mode) : add_points();
    }
  }

  // Makes this the primitive that is being read. False: it has no vertices.
  bool take(const json& primitive) {
    const json* attributes = find_member(primitive, "attributes");
    const auto position =
        attributes == nullptr ? std::nullopt : file_.whole(*attributes, "POSITION");
    if (!position) return false;
    positions_ = file_.numbers(*position);
    if (positions_.width != 3) file_.wrong("positions are not three numbers each");
    take_colors(primitive, *attributes);
    corners_.reset();
    if (const auto index = file_.whole(primitive, "indices")) {
      corners_ = file_.numbers(*index);
      if (corners_->width != 1 || is_floating(corners_->type)) file_.wrong("indices are no counts");
    }
    return true;
  }

  std::size_t corner_count() const { return corners_ ? corners_->count : positions_.count; }

  void add_points() {
    for (std::size_t i = 0; i < corner_count(); ++i) {
      points_.push_back(vertex_at(index_of_corner(i)));
      if (points_.size() > kMostCorners) {
        fail_too_large(fmt::format("{} million points", kMostCorners / 1'000'000));
      }
    }
  }

  CloudFile cloud_of_points(const char* format) {
    CloudBuilder builder(input_, mesh_.columns, ColorScale::byte, points_.size());
    Row row{};
    for (const MeshVertex& vertex : points_) {
      std::copy_n(vertex.data(), 3, row.begin());
      std::copy_n(vertex.data() + 3, 3, row.begin() + index_of(Role::red));
      builder.add(row);
    }
    return builder.finish(format);
  }

  void add_faces(std::size_t mode) {
    const std::size_t count = corner_count();
    if (count < 3) return;
    if (index_.size() < positions_.count) index_.resize(positions_.count, kNowhere);
    const bool mirrored = transform_.linear().determinant() < 0;
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

  void take_colors(const json& primitive, const json& attributes) {
    factor_ = {1, 1, 1, 1};
    colors_.reset();
    if (const auto color = file_.whole(attributes, "COLOR_0")) {
      colors_ = file_.numbers(*color);
      if (colors_->width < 3 || colors_->count < positions_.count) {
        file_.wrong("colours are not three numbers a vertex");
      }
    }
    if (const auto material = file_.whole(primitive, "material")) {
      const json* surface =
          find_member(file_.element("materials", *material), "pbrMetallicRoughness");
      if (surface != nullptr) factor_ = numbers_of<4>(file_, *surface, "baseColorFactor", factor_);
    }
    mesh_.columns.colors |= colors_.has_value() || factor_ != std::array<double, 4>{1, 1, 1, 1};
  }

  // The vertex of the primitive that its corner names.
  std::size_t index_of_corner(std::size_t i) const {
    const double number = corners_ ? corners_->at(i, 0) : static_cast<double>(i);
    if (!(number >= 0 && number < static_cast<double>(positions_.count))) {
      file_.wrong(
          fmt::format("an index is {}, but there are {} vertices", number, positions_.count));
    }
    return static_cast<std::size_t>(number);
  }

  // The vertex in the mesh of a corner of the primitive.
  std::size_t corner(std::size_t i) {
    const std::size_t vertex = index_of_corner(i);
    if (index_[vertex] == kNowhere) {
      index_[vertex] = static_cast<std::uint32_t>(mesh_.vertices.size());
      indexed_.push_back(vertex);
      mesh_.vertices.push_back(vertex_at(vertex));
    }
    return index_[vertex];
  }

  MeshVertex vertex_at(std::size_t i) const {
    const Vector3d local(positions_.at(i, 0), positions_.at(i, 1), positions_.at(i, 2));
    MeshVertex vertex = MeshVertex::Zero();
    vertex.head<3>() = transform_ * local;
    for (std::size_t k = 0; k < 3; ++k) {
      vertex[static_cast<Eigen::Index>(3 + k)] =
          shade(factor_[k] * (colors_ ? colors_->at(i, k) : 1));
    }
    return vertex;
  }

  static constexpr std::uint32_t kNowhere = 0xFFFFFFFF;

  const Input& input_;
  GltfFile file_;
  Mesh mesh_;
  std::vector<MeshVertex> points_;
  // The primitive that is being read:
  GltfNumbers positions_;
  std::optional<GltfNumbers> corners_;
  std::optional<GltfNumbers> colors_;
  std::array<double, 4> factor_{};
  Affine3d transform_;
  std::vector<std::uint32_t> index_;  // of its vertices in the mesh; between primitives kNowhere
  std::vector<std::size_t> indexed_;  // those that have one
  std::size_t primitives_ = 0;        // of all instances so far
};

}  // namespace

CloudFile read_gltf(const Input& input) {
  return GltfReader(input).run();
}

}  // namespace palpate::io
