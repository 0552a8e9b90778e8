// Reads the vertices and corners of a part of a glTF mesh.
#include "io/mesh/gltf_primitive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate::io {

using Eigen::Vector3d;
using nlohmann::json;

namespace {

// Shapes that bend a vertex at a time; faces have 52. A small file can repeat one without end
// (judgement)
constexpr std::size_t kMostMorphs = 64;

// 0 ... 255 of a share of light, as pictures have it (sRGB).
double shade(double light) {
  const double v = std::clamp(light, 0.0, 1.0);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

}  // namespace

bool GltfPrimitive::take(const json& primitive, const GltfPlace& place) {
  place_ = &place;
  const json* attributes = find_member(primitive, "attributes");
  const auto position = attributes == nullptr ? std::nullopt : file_.whole(*attributes, "POSITION");
  if (!position) return false;
  positions_ = file_.numbers(*position);
  if (positions_.width != 3) file_.wrong("positions are not three numbers each");
  take_colors(primitive, *attributes);
  take_skin(*attributes);
  take_morphs(primitive);
  corners_.reset();
  if (const auto index = file_.whole(primitive, "indices")) {
    corners_ = file_.numbers(*index);
    if (corners_->width != 1 || is_floating(corners_->type)) file_.wrong("indices are no counts");
  }
  return true;
}

void GltfPrimitive::take_colors(const json& primitive, const json& attributes) {
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
    if (surface != nullptr) file_.fill(*surface, "baseColorFactor", factor_);
  }
}

void GltfPrimitive::take_skin(const json& attributes) {
  skin_.reset();
  const auto joints = file_.whole(attributes, "JOINTS_0");
  const auto weights = file_.whole(attributes, "WEIGHTS_0");
  if (place_->joints == nullptr || !joints || !weights) return;
  skin_.emplace(file_.numbers(*joints), file_.numbers(*weights));
  for (const GltfNumbers& each : {skin_->first, skin_->second}) {
    if (each.width != 4 || each.count < positions_.count) {
      file_.wrong("joints and weights are not four numbers a vertex");
    }
  }
}

void GltfPrimitive::take_morphs(const json& primitive) {
  morphs_.clear();
  const json* targets = find_member(primitive, "targets");
  if (targets == nullptr || !targets->is_array()) return;
  const std::size_t count = std::min(targets->size(), place_->weights.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double weight = place_->weights[i];
    const auto index = file_.whole((*targets)[i], "POSITION");
    if (weight == 0 || !index) continue;
    morphs_.emplace_back(weight, file_.numbers(*index));
    const GltfNumbers& shifts = morphs_.back().second;
    if (shifts.width != 3 || shifts.count < positions_.count || morphs_.size() > kMostMorphs) {
      file_.wrong(
          fmt::format("morph targets are not three numbers a vertex, or more than {} are at work",
                      kMostMorphs));
    }
  }
}

std::size_t GltfPrimitive::index_of_corner(std::size_t i) const {
  const double number = corners_ ? corners_->at(i, 0) : static_cast<double>(i);
  if (!(number >= 0 && number < static_cast<double>(positions_.count))) {
    file_.wrong(fmt::format("an index is {}, but there are {} vertices", number, positions_.count));
  }
  return static_cast<std::size_t>(number);
}

// Each of four joints takes its share of the vertex along.
Vector3d GltfPrimitive::led_by_joints(std::size_t i, const Vector3d& local) const {
  const auto& [joints, shares] = *skin_;
  Vector3d sum = Vector3d::Zero();
  double whole = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double share = shares.at(i, k);
    if (share == 0) continue;
    const double joint = joints.at(i, k);
    if (!(joint >= 0 && joint < static_cast<double>(place_->joints->size()))) {
      file_.wrong(fmt::format("a vertex names joint {} of {}", joint, place_->joints->size()));
    }
    sum += share * ((*place_->joints)[static_cast<std::size_t>(joint)] * local);
    whole += share;
  }
  return whole > 0 ? Vector3d(sum / whole) : place_->transform * local;
}

Vector3d GltfPrimitive::position(std::size_t i) const {
  Vector3d local(positions_.at(i, 0), positions_.at(i, 1), positions_.at(i, 2));
  for (const auto& [weight, shifts] : morphs_) {
    local += weight * Vector3d(shifts.at(i, 0), shifts.at(i, 1), shifts.at(i, 2));
  }
  return skin_ ? led_by_joints(i, local) : place_->transform * local;
}

MeshVertex GltfPrimitive::vertex_at(std::size_t i) const {
  MeshVertex vertex = MeshVertex::Zero();
  vertex.head<3>() = position(i);
  for (std::size_t k = 0; k < 3; ++k) {
    vertex[static_cast<Eigen::Index>(3 + k)] =
        shade(factor_[k] * (colors_ ? colors_->at(i, k) : 1));
  }
  return vertex;
}

}  // namespace palpate::io
