// Compares forces that were measured with those that are rendered.
#include "apps/palpate/run/measured_forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace palpate::app {
namespace {

double share(double part, std::size_t whole) {
  return whole == 0 ? 0 : part / static_cast<double>(whole);
}

}  // namespace

MeasuredForces::MeasuredForces(std::string file, const Trajectory& trajectory)
    : file_(std::move(file)), trajectory_(&trajectory) {
  errors_.reserve(trajectory.size());
}

void MeasuredForces::add(const ServoState& step) {
  if (steps_ == trajectory_->size()) return;
  const Eigen::Vector3d measured = (*trajectory_)[steps_++].force.value();
  const bool was_felt = measured.norm() >= kFelt;
  const bool is_felt = step.force.norm() >= kFelt;
  if (was_felt) errors_.push_back((step.force - measured).norm());
  if (was_felt && !is_felt) ++only_measured_;
  if (is_felt && !was_felt) ++only_rendered_;
  if (!was_felt || !is_felt) return;
  const double angle = std::atan2(measured.cross(step.force).norm(), measured.dot(step.force));
  angle_squares_ += angle * angle;
  ++angles_;
}

MeasuredForces::Difference MeasuredForces::difference() const {
  Difference d;
  d.steps = errors_.size();
  const double squares = std::inner_product(errors_.begin(), errors_.end(), errors_.begin(), 0.0);
  d.rms = std::sqrt(share(squares, d.steps));
  std::vector<double> sorted = errors_;
  std::ranges::sort(sorted);
  if (!sorted.empty()) d.median = sorted[sorted.size() / 2];
  d.direction = std::sqrt(share(angle_squares_, angles_)) * 180 / std::numbers::pi;
  d.only_measured = share(static_cast<double>(only_measured_), steps_);
  d.only_rendered = share(static_cast<double>(only_rendered_), steps_);
  return d;
}

}  // namespace palpate::app
