#include "accuracy/truth_field.hpp"

namespace palpate::accuracy {
namespace {

constexpr double kRadius = 0.01;  // what steps are measured in, m

}  // namespace

Sample TruthField::sample(const Eigen::Vector3d& x) const noexcept {
  const Distance found = distance_and_normal(*scene_, x);
  return {found.value, found.gradient, 1, kRadius};
}

bool TruthField::is_free(const Ball& ball) const noexcept {
  return distance_and_normal(*scene_, ball.center).value > ball.radius;
}

Surface TruthField::surface(const Eigen::Vector3d& /*x*/) const noexcept {
  return {};
}

Field::Traits TruthField::traits() const noexcept {
  Field::Traits traits;
  traits.resolution = 0.002 * kRadius;
  return traits;
}

}  // namespace palpate::accuracy
