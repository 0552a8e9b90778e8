// Recognises columns by name and collects rows into a PointCloud.
#include "io/cloud_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate::io {
namespace {

struct Triple {
  Role first;
  std::array<std::string_view, 3> names;
};

constexpr Triple kTriples[] = {
    {Role::x, {"x", "y", "z"}},
    {Role::normal_x, {"nx", "ny", "nz"}},
    {Role::normal_x, {"normal_x", "normal_y", "normal_z"}},
    {Role::normal_x, {"normalx", "normaly", "normalz"}},
    {Role::red, {"red", "green", "blue"}},
    {Role::red, {"r", "g", "b"}},
    {Role::red, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
    {Role::intensity, {"intensity", "scalar_intensity", "i"}},
    {Role::intensity, {"reflectance", "reflectivity", "quality"}},
    {Role::intensity, {"scalar", {}, {}}},
};

// Names of x, y and z that count where no columns are called so.
constexpr Triple kFallbackTriples[] = {
    {Role::x, {"points:0", "points:1", "points:2"}},
    {Role::x, {"points_0", "points_1", "points_2"}},
    {Role::x, {"easting", "northing", "height"}},
    {Role::x, {"east", "north", "up"}},
    {Role::x, {"e", "n", "h"}},
    {Role::x, {"longitude", "latitude", "elevation"}},
    {Role::x, {"lon", "lat", "altitude"}},
    {Role::x, {"lng", "lat", "alt"}},
};

std::optional<Role> role_in(std::span<const Triple> triples, std::string_view name) {
  const std::string lower = lower_case(name);
  for (const Triple& triple : triples) {
    const auto* found = std::ranges::find(triple.names, lower);
    if (name.empty() || found == triple.names.end()) continue;
    const std::size_t more = triple.first == Role::intensity ? 0 : found - triple.names.begin();
    return static_cast<Role>(index_of(triple.first) + more);
  }
  return {};
}

}  // namespace

std::optional<Role> role_of(std::string_view name) {
  return role_in(kTriples, name);
}

std::optional<Role> fallback_role_of(std::string_view name) {
  const std::optional<Role> role = role_in(kFallbackTriples, name);
  return role ? role : role_of(name);
}

void Roles::add(std::optional<Role> role) {
  if (role && std::exchange(has_[index_of(*role)], true)) role.reset();
  roles_.push_back(role);
}

bool Roles::has(Role first, std::size_t count) const {
  return std::ranges::all_of(std::span(has_).subspan(index_of(first), count), std::identity());
}

Columns Roles::columns() const {
  return {.normals = has(Role::normal_x, 3),
          .colors = has(Role::red, 3),
          .intensities = has(Role::intensity, 1)};
}

namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Eigen::Vector3d choose_origin(std::size_t count,
                              const std::function<Eigen::Vector3d(std::size_t)>& point_at) {
  constexpr std::size_t kSample = 1000;
  constexpr double kFarAway = 16;     // times the spread: costs four bits (judgement)
  constexpr double kTiniest = 1e-12;  // m; nothing is measured in less (judgement)
  std::vector<Eigen::Vector3d> sample;
  for (std::size_t i = 0; i < count; i += count / kSample + 1) {
    const Eigen::Vector3d point = point_at(i);
    if (is_usable(point)) sample.push_back(point);
  }
  if (sample.empty()) return Eigen::Vector3d::Zero();

  Eigen::Vector3d center;
  double spread = 0;
  std::vector<double> values(sample.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(sample.begin(), sample.end(), values.begin(),
                   [&](const Eigen::Vector3d& p) { return p[axis]; });
    center[axis] = median(values);
    for (double& v : values) v = std::abs(v - center[axis]);
    spread = std::max(spread, median(values));
  }
  const double distance = center.cwiseAbs().maxCoeff();
  if (distance <= std::max(kFarAway * spread, kTiniest)) return Eigen::Vector3d::Zero();
  // A single point, or copies of it, has no spread.
  const double size = std::max(spread, 1e-9 * distance);
  const double step = std::pow(10.0, std::ceil(std::log10(size)));
  return ((center / step).array().round() * step).matrix();
}

namespace {

float finite_float(double v) {
  const auto narrow = static_cast<float>(v);
  return std::isfinite(narrow) ? narrow : 0.0F;
}

Eigen::Vector3d three(const Row& row, Role first) {
  const auto i = index_of(first);
  return {row[i], row[i + 1], row[i + 2]};
}

float color_factor(const std::vector<std::array<float, 3>>& colors, ColorScale scale) {
  if (scale == ColorScale::byte) return 1;
  float largest = 0;
  for (const auto& c : colors) largest = std::max({largest, c[0], c[1], c[2]});
  if (largest <= 1 && scale == ColorScale::guess) return 255;
  return largest <= 255 ? 1.0F : 1.0F / 257.0F;
}

}  // namespace

Eigen::Vector3f unit_normal(const Eigen::Vector3d& normal) {
  constexpr double kRounding = 4e-6;
  const double length = normal.norm();
  if (!(length > 1e-30) || !std::isfinite(length)) return Eigen::Vector3f::Zero();
  if (std::abs(length - 1) <= kRounding) return normal.cast<float>();
  return (normal / length).cast<float>();
}

std::vector<std::array<std::uint8_t, 3>> byte_colors(
    const std::vector<std::array<float, 3>>& colors, ColorScale scale) {
  const float factor = color_factor(colors, scale);
  std::vector<std::array<std::uint8_t, 3>> result(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float v = std::clamp(colors[i][k] * factor + 0.5F, 0.0F, 255.0F);
      result[i][k] = static_cast<std::uint8_t>(v);
    }
  }
  return result;
}

void check_options(const Input& input) {
  const double scale = input.options.scale.value_or(1);
  const double height = input.options.height_scale.value_or(1);
  const double length = input.options.length.value_or(1);
  const double spacing = input.options.mesh_spacing;
  if (!(std::isfinite(scale) && scale > 0)) {
    fail(input, fmt::format("cannot multiply coordinates by a scale of {}", scale),
         "Give a scale above zero, e.g. 0.001 for millimetres or 0.3048 for feet");
  }
  if (!(std::isfinite(height) && height > 0) ||
      (input.options.height_scale && !input.options.scale)) {
    fail(input, fmt::format("cannot multiply heights alone by a scale of {}", height),
         "Give a scale of x and y above zero, and one of z");
  }
  if (!(std::isfinite(length) && length > 0)) {
    fail(input, fmt::format("no cloud can be {} m long", length), "Give a length above zero");
  }
  if (!(std::isfinite(spacing) && spacing >= 0)) {
    fail(input, fmt::format("cannot sample faces at a spacing of {} m", spacing),
         "Give a spacing above zero, or zero to have one chosen");
  }
  if (spacing > 0 && input.options.length) {
    fail(input, "a spacing in metres needs the file's unit, which a length does not tell",
         "Give a scale in place of the length");
  }
}

void check_not_empty(const Input& input, std::size_t kept, std::size_t dropped) {
  if (kept > 0) return;
  if (dropped > 0) {
    fail(input, fmt::format("none of the {} points is finite and valid", dropped),
         "Check how the file was generated, and its units and scale");
  }
  fail(input, "the file holds no points", "Export it again with its points (vertices)");
}

CloudBuilder::CloudBuilder(const Input& input, const Columns& columns, ColorScale color_scale,
                           std::size_t expected)
    : input_(input), columns_(columns), color_scale_(color_scale) {
  points_.reserve(expected);
  if (columns.normals) cloud_.normals.reserve(expected);
  if (columns.colors) colors_.reserve(expected);
  if (columns.intensities) cloud_.intensities.reserve(expected);
}

void CloudBuilder::organise(std::size_t width, std::size_t height) {
  if (width * height > std::numeric_limits<std::uint32_t>::max()) return;
  cloud_.width = width;
  cloud_.height = height;
  cloud_.pixels.reserve(points_.capacity());
}

void CloudBuilder::add(const Row& row) {
  const auto pixel = static_cast<std::uint32_t>(points_.size() + dropped_);
  const Eigen::Vector3d point = input_.scale().cwiseProduct(three(row, Role::x));
  if (!is_usable(point)) {
    ++dropped_;
    return;
  }
  points_.push_back(point);
  if (cloud_.width > 0) cloud_.pixels.push_back(pixel);
  if (columns_.normals) cloud_.normals.push_back(normal_of(row));
  if (columns_.colors) {
    const Eigen::Vector3d c = three(row, Role::red);
    colors_.push_back({finite_float(c[0]), finite_float(c[1]), finite_float(c[2])});
  }
  if (columns_.intensities) {
    cloud_.intensities.push_back(finite_float(row[index_of(Role::intensity)]));
  }
}

// A normal of a surface whose heights have another unit than x and y turns as they are stretched.
Eigen::Vector3f CloudBuilder::normal_of(const Row& row) const {
  const Eigen::Vector3d normal = three(row, Role::normal_x);
  if (input_.unit.plan == input_.unit.height) return unit_normal(normal);
  return unit_normal(normal.cwiseQuotient(input_.scale() / input_.unit.plan));
}

CloudFile CloudBuilder::finish(std::string format) {
  check_not_empty(input_, points_.size(), dropped_);
  CloudFile file;
  file.format = std::move(format);
  file.unit = input_.unit;
  file.declared = points_.size() + dropped_;
  file.dropped = dropped_;
  split_positions(cloud_);
  convert_colors(cloud_);
  file.cloud = std::move(cloud_);
  return file;
}

void CloudBuilder::split_positions(PointCloud& cloud) {
  cloud.origin = choose_origin(points_.size(), [&](std::size_t i) { return points_[i]; });
  cloud.positions.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    cloud.positions[i] = (points_[i] - cloud.origin).cast<float>();
  }
  points_ = {};
}

void CloudBuilder::convert_colors(PointCloud& cloud) const {
  if (columns_.colors) cloud.colors = byte_colors(colors_, color_scale_);
}

void rescale(PointCloud& cloud, double factor) {
  for (Eigen::Vector3f& p : cloud.positions) p *= static_cast<float>(factor);
  cloud.origin *= factor;
  if (cloud.viewpoint) *cloud.viewpoint *= factor;
}

void rescale(CloudFile& file, double factor) {
  rescale(file.cloud, factor);
  file.unit.plan *= factor;
  file.unit.height *= factor;
  if (file.splats) file.splats->spacing *= factor;
  if (file.mesh) file.mesh->spacing *= factor;
}

}  // namespace palpate::io
