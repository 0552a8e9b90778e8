// Distances to exact shapes (plane, sphere, box, torus) and their union.

#include "palpate/field/analytic.hpp"

#include <cmath>
#include <limits>

#include "base/requirement.hpp"

namespace palpate {
namespace {

constexpr Requirement kRequire{"analytic field"};  // the name that errors begin with

void require_positive(const char* name, double value) {
  kRequire.positive(name, value, "give a length above 0, in metres");
}

void require_length(const char* name, double value) {
  kRequire.not_negative(name, value, "give 0 or a length above it, in metres");
}

}  // namespace

AnalyticField::AnalyticField(const AnalyticField::Options& options)
    : options_(options), T_shape_world_(options.T_world_shape.inverse()) {
  require_positive("step_length", options.step_length);
  require_positive("resolution", options.resolution);
  require_length("tool_radius", options.tool_radius);
  require_length("reanchor_reach", options.reanchor_reach);
  if (!options.T_world_shape.matrix().allFinite()) {
    throw Error("analytic field: the pose is not finite; give a finite rotation and translation");
  }
}

Sample AnalyticField::sample(const Eigen::Vector3d& x) const noexcept {
  const Distance d = distance(T_shape_world_ * x);
  return {.value = d.value - options_.tool_radius,
          .gradient = options_.T_world_shape.linear() * d.gradient,
          .support = 1,
          .radius = options_.step_length};
}

bool AnalyticField::is_free(const Ball& ball) const noexcept {
  return distance(T_shape_world_ * ball.center).value - options_.tool_radius > ball.radius;
}

Surface AnalyticField::surface(const Eigen::Vector3d&) const noexcept {
  return options_.surface;
}

Field::Traits AnalyticField::traits() const noexcept {
  return {.resolution = options_.resolution,
          .revision = revision_,
          .reanchor_reach = options_.reanchor_reach,
          .step = options_.reanchor_reach};
}

void AnalyticField::set_pose(const Eigen::Isometry3d& T_world_shape) noexcept {
  options_.T_world_shape = T_world_shape;
  T_shape_world_ = T_world_shape.inverse();
  ++revision_;
}

PlaneField::PlaneField(const AnalyticField::Options& options) : AnalyticField(options) {}

AnalyticField::Distance PlaneField::distance(const Eigen::Vector3d& x) const noexcept {
  return {x.z(), Eigen::Vector3d::UnitZ()};
}

SphereField::SphereField(double radius, const AnalyticField::Options& options)
    : AnalyticField(options), radius_(radius) {
  require_positive("radius", radius);
}

AnalyticField::Distance SphereField::distance(const Eigen::Vector3d& x) const noexcept {
  const double length = x.norm();
  if (length <= 0) return {-radius_, Eigen::Vector3d::UnitZ()};
  return {length - radius_, x / length};
}

BoxField::BoxField(const Eigen::Vector3d& size, const AnalyticField::Options& options)
    : AnalyticField(options), half_(0.5 * size) {
  for (int axis = 0; axis < 3; ++axis) require_positive("edge length", size[axis]);
}

AnalyticField::Distance BoxField::distance(const Eigen::Vector3d& x) const noexcept {
  const Eigen::Vector3d beyond = x.cwiseAbs() - half_;
  const Eigen::Vector3d outside = beyond.cwiseMax(0);
  const Eigen::Vector3d sign = x.unaryExpr([](double v) { return std::copysign(1.0, v); });
  const double length = outside.norm();
  if (length > 0) return {length, outside.cwiseProduct(sign) / length};
  Eigen::Index axis = 0;
  const double nearest = beyond.maxCoeff(&axis);
  return {nearest, sign[axis] * Eigen::Vector3d::Unit(axis)};
}

TorusField::TorusField(double ring, double tube, const AnalyticField::Options& options)
    : AnalyticField(options), ring_(ring), tube_(tube) {
  require_positive("tube radius", tube);
  kRequire(std::isfinite(ring) && ring > tube, "ring radius", ring, "give more than the tube's");
}

AnalyticField::Distance TorusField::distance(const Eigen::Vector3d& x) const noexcept {
  const double rho = std::hypot(x.x(), x.y());
  const double across = rho - ring_;
  const double length = std::hypot(across, x.z());
  if (length <= 0) return {-tube_, Eigen::Vector3d::UnitZ()};
  const Eigen::Vector3d outward =
      rho > 0 ? Eigen::Vector3d(x.x() / rho, x.y() / rho, 0) : Eigen::Vector3d::UnitX();
  return {length - tube_, (across * outward + x.z() * Eigen::Vector3d::UnitZ()) / length};
}

UnionField::UnionField(std::vector<const Field*> parts) : parts_(std::move(parts)) {
  if (parts_.empty()) throw Error("union of fields: it has no parts; give at least one");
  for (const Field* part : parts_) {
    if (part == nullptr) throw Error("union of fields: a part is null; give fields that exist");
  }
}

std::size_t UnionField::nearest(const Eigen::Vector3d& x, Sample& sample) const noexcept {
  std::size_t best = 0;
  sample = parts_[0]->sample(x);
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    const Sample other = parts_[i]->sample(x);
    if (other.value < sample.value) {
      best = i;
      sample = other;
    }
  }
  return best;
}

Sample UnionField::sample(const Eigen::Vector3d& x) const noexcept {
  Sample sample;
  (void)nearest(x, sample);
  return sample;
}

bool UnionField::is_free(const Ball& ball) const noexcept {
  for (const Field* part : parts_) {
    if (!part->is_free(ball)) return false;
  }
  return true;
}

Surface UnionField::surface(const Eigen::Vector3d& x) const noexcept {
  Sample sample;
  const std::size_t part = nearest(x, sample);
  Surface surface = parts_[part]->surface(x);
  surface.source = static_cast<int>(part);
  return surface;
}

Field::Traits UnionField::traits() const noexcept {
  Field::Traits all{.resolution = std::numeric_limits<double>::infinity()};
  for (const Field* part : parts_) {
    const Field::Traits traits = part->traits();
    all.resolution = std::min(all.resolution, traits.resolution);
    all.reanchor_reach = std::max(all.reanchor_reach, traits.reanchor_reach);
    all.step = std::max(all.step, traits.step);
    all.revision += traits.revision;
  }
  return all;
}

void UnionField::begin_step() const noexcept {
  for (const Field* part : parts_) part->begin_step();
}

int UnionField::points_summed() const noexcept {
  int sum = 0;
  for (const Field* part : parts_) sum += part->points_summed();
  return sum;
}

void UnionField::end_step(const Eigen::Vector3d& proxy,
                          const Eigen::Vector3d& normal) const noexcept {
  for (const Field* part : parts_) part->end_step(proxy, normal);
}

}  // namespace palpate
