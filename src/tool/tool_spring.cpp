// Stiffness that changes without giving energy, as of the proxy of three degrees of freedom, with
// the length of a motion in the metric in the place of a distance.
#include "tool/tool_spring.hpp"

#include <algorithm>
#include <cmath>

#include "contact/limit.hpp"

namespace palpate {
namespace {

double energy(double stiffness, const Motion& stretch) {
  return 0.5 * stiffness * stretch.squaredNorm();
}

void add(const Motion& stretch, double stiffness, const Metric& metric, ToolContact& contact) {
  contact.wrench.force += stiffness * stretch.head<3>();
  contact.wrench.torque += stiffness * metric.gyration * stretch.segment<3>(3);
  contact.wrench.grip += stiffness * stretch[6];
  contact.stiffness += stiffness;
}

}  // namespace

void ToolSpring::pull(const Step& step, const Metric& metric, ToolContact& contact) noexcept {
  const Motion stretch = metric.between(step.hand, step.now);
  const double length = stretch.norm();
  if (step.jumped) leave(step, metric);
  const double wanted = std::max(0.0, away_.left() * step.full - fading_);
  const double share = length > step.moved ? step.moved / length : 1;
  if (step.jumped) {  // it holds no more energy than the hand's motion would give to one at rest
    tank_.take_over(share * share * wanted);
  } else if (step.touching && !touching_) {
    tank_.restart(share * wanted);
  }
  touching_ = contact.touching = step.touching;
  if (touching_) {
    add(stretch, tank_.follow(wanted, length, step.dissipated, step.dt), metric, contact);
    if (tank_.stiffness() < Limit::kMuchSofter * wanted) contact.notes |= ContactNote::softer;
  }
  if (fading_ > 0) add_fading(step, metric, contact);
}

// The spring of the last step stays where it was. Two pull like one between them, and what they
// hold beyond it fills the tank.
void ToolSpring::leave(const Step& step, const Metric& metric) noexcept {
  const double both = fading_ + stiffness();
  if (both > 0) {
    const double apart = energy(fading_, metric.between(step.hand, anchor_)) +
                         energy(stiffness(), metric.between(step.hand, step.before));
    anchor_ = metric.moved(anchor_, stiffness() / both * metric.between(anchor_, step.before));
    tank_.fill(std::max(0.0, apart - energy(both, metric.between(step.hand, anchor_))));
  }
  fading_ = both;
  gone_ = Limit::kGone * both;
}

void ToolSpring::add_fading(const Step& step, const Metric& metric, ToolContact& contact) noexcept {
  const Motion stretch = metric.between(step.hand, anchor_);
  const double left = fading_ * std::exp(-step.dt / EnergyTank::kTime);
  tank_.fill(0.5 * (fading_ - left) * stretch.squaredNorm());
  fading_ = left > gone_ ? left : 0;
  add(stretch, fading_, metric, contact);
}

}  // namespace palpate
