// Passes a force through watchdog, damper, soft start, slew limit, brake and clamp.
#include "palpate/servo/guard.hpp"

#include "servo/guard_chain.hpp"

namespace palpate {

// A force of three axes, which a device renders up to a length.
struct ForceAxes {
  using Input = Guard::Input;

  double maximum_force;  // N

  [[nodiscard]] Eigen::Vector3d shortened(const Eigen::Vector3d& force) const noexcept {
    const double length = force.norm();
    if (length <= maximum_force) return force;
    return maximum_force / length * force;
  }
};

class Guard::Inside : public GuardChain<ForceAxes> {
 public:
  explicit Inside(const GuardOptions& options)
      : GuardChain(options, ForceAxes{options.maximum_force}) {}
};

Guard::Guard(const GuardOptions& options) : inside_(std::make_unique<Inside>(options)) {}
Guard::~Guard() = default;
Guard::Guard(Guard&&) noexcept = default;
Guard& Guard::operator=(Guard&&) noexcept = default;

Eigen::Vector3d Guard::pass(const Guard::Input& input) noexcept {
  return inside_->pass(input);
}

void Guard::reset() noexcept {
  inside_->reset();
}

const Guard::State& Guard::state() const noexcept {
  return inside_->state();
}

const GuardOptions& Guard::options() const noexcept {
  return inside_->options();
}

}  // namespace palpate
