// Keeps the sources of a scene, and computes how wide supports have to be for surfaces to be one.
#include "palpate/scene/scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "field/formulas.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/spacing.hpp"
#include "scene/source_inside.hpp"

namespace palpate {

Source& Scene::add(std::string name, const SourceOptions& options) {
  if (sources_.size() == kMaxSources) {
    throw Error(fmt::format("cannot add '{}': a scene holds {} sources; merge some clouds first",
                            name, kMaxSources));
  }
  if (*fields_ > 0) {
    throw Error(fmt::format(
        "cannot add '{}': the scene is already in use; add sources before creating fields", name));
  }
  const bool taken =
      std::ranges::any_of(sources_, [&](const Source& source) { return source.name() == name; });
  if (taken)
    throw Error(
        fmt::format("the scene already has a source named '{}'; choose another name", name));
  if (!seams_) seams_ = std::make_shared<Seams>();
  Source& source = sources_.emplace_back(std::move(name), options);
  source.inside_->slot = {seams_, sources_.size() - 1};
  return source;
}

Source& Scene::add(std::string name, const PointCloud& cloud, const SourceOptions& options) {
  Source& source = add(std::move(name), options);
  try {
    source.set(cloud);
  } catch (...) {
    sources_.pop_back();
    throw;
  }
  return source;
}

Source::State Scene::state(std::size_t i) const {
  Source::State state = source(i).state();
  const auto own = source(i).points();
  for (std::size_t k = 0; own && k < size(); ++k) {
    const auto other = k == i ? nullptr : source(k).points();
    if (!other) continue;
    const std::optional<double> found = disagreement(*own, *other);
    if (found) state.disagreement = std::max(*found, state.disagreement.value_or(0));
  }
  return state;
}

namespace {

constexpr std::size_t kTried = 1000;  // points to compare, about (judgement)
constexpr std::size_t kEnough = 30;   // distances; fewer give no median (judgement)
constexpr float kReach = 3;           // radii
constexpr float kAlike = 0.7071f;     // cosine between normals: 45 degrees

const Eigen::Vector3f& end_of(const SurfacePoints& points, std::size_t i) {
  return points.end_positions.empty() ? points.grid.points()[i] : points.end_positions[i];
}

const Eigen::Vector3f& normal_of(const SurfacePoints& points, std::size_t i) {
  return newest(points.normals, points.end_normals)[i];
}

bool counts(const SurfacePoints& points, std::size_t i) {
  return newest(points.density_weights, points.end_density_weights)[i] > 0 &&
         points.confidences[i] > 0;
}

}  // namespace

std::optional<double> disagreement(const SurfacePoints& a, const SurfacePoints& b) {
  if (a.normals.empty() || b.normals.empty()) return std::nullopt;
  const Eigen::Vector3f shift = (a.origin - b.origin).cast<float>();
  const std::size_t step = std::max<std::size_t>(1, a.size() / kTried);
  std::vector<CellGrid::Neighbor> near;
  std::vector<float> distances;
  for (std::size_t i = 0; i < a.size(); i += step) {
    if (!counts(a, i)) continue;
    const Eigen::Vector3f position = end_of(a, i) + shift;
    b.grid.nearest(position, 1, near);
    if (near.empty()) continue;
    const std::size_t k = near.front().index;
    const Eigen::Vector3f& normal = normal_of(b, k);
    const Eigen::Vector3f offset = position - end_of(b, k);
    const bool same = counts(b, k) && offset.norm() <= kReach * b.radii[k] &&
                      normal.dot(normal_of(a, i)) > kAlike;
    if (same) distances.push_back(std::abs(normal.dot(offset)));
  }
  if (distances.size() < kEnough) return std::nullopt;
  return median(distances);
}

namespace {

constexpr double kWidth = 2.5;     // R, in distances between two surfaces
constexpr double kFarthest = 1.5;  // distance of what may be one surface, in R
constexpr double kNoise = 0.1;     // of R; what is measured varies from frame to frame

/// The R, m, that makes one surface of two; 0: they are one, or lie too far apart. `before`: what
/// it was.
double common_radius(const Source& one, const Source& other, double before) {
  const std::shared_ptr<const SurfacePoints> a = one.points();
  const std::shared_ptr<const SurfacePoints> b = other.points();
  if (!a || !b) return 0;
  const double own = std::min(a->radius, b->radius);
  const double radius = kWidth * disagreement(*a, *b).value_or(0);
  const double most = (before > 0 ? 1 + kNoise : 1) * kWidth * kFarthest * own;
  if (radius <= own || radius > most) return 0;
  return std::abs(radius - before) <= kNoise * before ? before : radius;
}

}  // namespace

void Seams::compare(std::size_t index, const Source& source) {
  const std::lock_guard lock(mutex_);
  sources_[index] = &source;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    if (k == index || sources_[k] == nullptr) continue;
    const auto [first, second] = std::minmax(k, index);  // one order: noise is the same in both
    common_[k][index] = common_[index][k] =
        common_radius(*sources_[first], *sources_[second], common_[k][index]);
  }
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    least_radii_[k].store(*std::ranges::max_element(common_[k]));
  }
}

}  // namespace palpate
