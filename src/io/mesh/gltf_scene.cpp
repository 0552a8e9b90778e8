// Finds where the nodes of a glTF file place its meshes, and how joints lead their vertices.
#include "io/mesh/gltf_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/input.hpp"

namespace palpate::io {

using Eigen::Affine3d;
using Eigen::Vector3d;
using nlohmann::json;

namespace {

// A small file can repeat a mesh without end; these take half a GB (judgement).
constexpr std::size_t kMostInstances = 3'000'000;

Affine3d composed(const std::array<double, 3>& t, const std::array<double, 4>& q,
                  const std::array<double, 3>& s) {
  Affine3d transform = Affine3d::Identity();
  transform.translate(Vector3d(t.data()));
  transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  transform.scale(Vector3d(s.data()));
  return transform;
}

// Lengths are metres and y is up; here z is.
Affine3d upright() {
  Affine3d transform = Affine3d::Identity();
  transform.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return transform;
}

Affine3d transform_of(const GltfFile& file, const json& node) {
  std::array<double, 16> m{};
  if (file.fill(node, "matrix", m)) {
    Affine3d transform;
    transform.matrix() = Eigen::Matrix4d(m.data());  // column by column, as Eigen has them
    return transform;
  }
  std::array<double, 3> t{0, 0, 0};
  std::array<double, 4> q{0, 0, 0, 1};
  std::array<double, 3> s{1, 1, 1};
  file.fill(node, "translation", t);
  file.fill(node, "rotation", q);
  file.fill(node, "scale", s);
  return composed(t, q, s);
}

// A row of an attribute of instances, where they have it.
template <std::size_t N>
void fill_row(const std::optional<GltfNumbers>& numbers, std::size_t row,
              std::array<double, N>& values) {
  if (!numbers || numbers->width != N || row >= numbers->count) return;
  for (std::size_t k = 0; k < N; ++k) values[k] = numbers->at(row, k);
}

// Where the instances of a node's mesh are: rows of its translations, rotations and scales.
struct Repeated {
  std::array<std::optional<GltfNumbers>, 3> rows;
  std::size_t count = 0;

  [[nodiscard]] Affine3d transform(std::size_t row) const {
    std::array<double, 3> t{0, 0, 0};
    std::array<double, 4> q{0, 0, 0, 1};
    std::array<double, 3> s{1, 1, 1};
    fill_row(rows[0], row, t);
    fill_row(rows[1], row, q);
    fill_row(rows[2], row, s);
    return composed(t, q, s);
  }
};

// Nothing: the mesh is there once.
std::optional<Repeated> repeated(GltfFile& file, const json& node) {
  const json* extensions = find_member(node, "extensions");
  const json* instancing =
      extensions == nullptr ? nullptr : find_member(*extensions, "EXT_mesh_gpu_instancing");
  const json* attributes = instancing == nullptr ? nullptr : find_member(*instancing, "attributes");
  if (attributes == nullptr) return {};
  Repeated repeated;
  constexpr std::array<const char*, 3> kNames{"TRANSLATION", "ROTATION", "SCALE"};
  for (std::size_t i = 0; i < repeated.rows.size(); ++i) {
    const auto index = file.whole(*attributes, kNames[i]);
    if (!index) continue;
    repeated.rows[i] = file.numbers(*index);
    repeated.count = std::max(repeated.count, repeated.rows[i]->count);
  }
  return repeated;
}

}  // namespace

// Every node once: first those of the scene, then those beside it, which may be joints.
GltfScene::GltfScene(GltfFile& file, const ReadOptions& options)
    : file_(file), places_(file.list("nodes").size(), Affine3d::Identity()), seen_(places_.size()) {
  walk(roots(), true, options);
  if (file_.list("skins").empty()) return;
  std::vector<std::size_t> others = nobodys_children();
  std::erase_if(others, [this](std::size_t node) { return seen_[node]; });
  walk(others, false, options);
}

void GltfScene::walk(const std::vector<std::size_t>& from, bool in_scene,
                     const ReadOptions& options) {
  std::vector<std::pair<std::size_t, Affine3d>> open;
  const auto enter = [&](std::size_t node, const Affine3d& transform) {
    (void)file_.element("nodes", node);  // is it there?
    if (seen_[node] && !in_scene) return;
    if (seen_[node]) file_.wrong(fmt::format("node {} has two parents", node));
    seen_[node] = true;
    open.emplace_back(node, transform);
  };
  for (const std::size_t root : from) enter(root, upright());
  Progress progress(options, seen_.size());
  for (std::size_t done = 0; !open.empty(); ++done) {
    const auto [node, parent] = open.back();
    open.pop_back();
    const Affine3d transform = parent * transform_of(file_, file_.element("nodes", node));
    places_[node] = transform;
    if (in_scene) place(node);
    for (const std::size_t child : file_.indices(file_.element("nodes", node), "children")) {
      enter(child, transform);
    }
    progress.at(done);
  }
}

// The transform of a skinned mesh's own node has no effect, by the format.
void GltfScene::place(std::size_t index) {
  const json& node = file_.element("nodes", index);
  const auto mesh = file_.whole(node, "mesh");
  if (!mesh) return;
  const auto skin = file_.whole(node, "skin");
  const Affine3d own = skin ? upright() : places_[index];
  const auto copies = repeated(file_, node);
  if (!copies) {
    instances_.push_back({*mesh, &node, own, skin});
    return;
  }
  if (copies->count > kMostInstances - std::min(kMostInstances, instances_.size())) {
    file_.wrong(
        fmt::format("its scene has more than {} million instances", kMostInstances / 1'000'000));
  }
  for (std::size_t row = 0; row < copies->count; ++row) {
    instances_.push_back({*mesh, &node, own * copies->transform(row), skin});
  }
}

// Nodes of the scene; without one, those that are nobody's children.
std::vector<std::size_t> GltfScene::roots() const {
  const std::size_t scene = file_.whole(file_.root(), "scene").value_or(0);
  if (!file_.list("scenes").empty()) {
    return file_.indices(file_.element("scenes", scene), "nodes");
  }
  return nobodys_children();
}

std::vector<std::size_t> GltfScene::nobodys_children() const {
  std::vector<bool> is_child(places_.size());
  for (const json& node : file_.list("nodes")) {
    for (const std::size_t child : file_.indices(node, "children")) {
      if (child < is_child.size()) is_child[child] = true;
    }
  }
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) found.push_back(i);
  }
  return found;
}

const std::vector<Affine3d>& GltfScene::joints(std::size_t skin) {
  const auto [found, is_new] = joints_.try_emplace(skin);
  if (!is_new) return found->second;
  const json& object = file_.element("skins", skin);
  std::optional<GltfNumbers> bound;
  if (const auto index = file_.whole(object, "inverseBindMatrices")) {
    bound = file_.numbers(*index);
  }
  for (const std::size_t joint : file_.indices(object, "joints")) {
    (void)file_.element("nodes", joint);  // is it there?
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    fill_row(bound, found->second.size(), m);
    Affine3d from_bound;
    from_bound.matrix() = Eigen::Matrix4d(m.data());
    found->second.push_back(places_[joint] * from_bound);
  }
  return found->second;
}

}  // namespace palpate::io
