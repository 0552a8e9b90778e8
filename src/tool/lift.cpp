// How a tool follows a surface that has changed.
#include <algorithm>

#include "tool/descent.hpp"

namespace palpate {
namespace {

constexpr double kRisen = 1e-3;  // of R: less is left to the iterations
// Reaches: rises that throw a tool farther contradict each other, as between two walls; a far end
// moves more than what touches (judgement).
constexpr double kThrown = 2;

}  // namespace

void Descent::lift(const ToolSurface& surface, double reach, ToolContact& contact) noexcept {
  const double high = std::max(reach, kLongest * 2 * gaps_.radius());
  constraints_.clear();
  surface.place(pose_);
  for (const Touches::Touch& touch : touches_.span()) {
    const Tool::Point& sample = tool_->samples()[static_cast<std::size_t>(touch.sample)];
    const Eigen::Vector3d x = tool_->in_world(sample.position, sample.side, pose_);
    const Field& field = surface.group(surface.group_of(touch.sample));
    if (gaps_.sees_still(field, sample, x, touch.normal)) continue;  // looks lead there
    const double rise = gaps_.rise(field, sample, x, high * touch.normal) * high;
    if (rise < kRisen * gaps_.radius()) continue;
    Constraint constraint = constraint_on(*tool_, touch.sample, x, touch.normal, pose_, metric_);
    constraint.bound = rise;
    constraints_.add(constraint);
  }
  if (constraints_.all().empty()) return;
  const LeastMotion least = least_motion(constraints_.all(), Motion::Zero(), kSolved);
  if (least.end != LeastMotion::End::solved || !least.motion.allFinite()) return;
  if (farthest(least.motion) > kThrown * high) return;
  move_to(metric_.moved(pose_, least.motion));
  contact.notes |= ContactNote::reanchored;
}

}  // namespace palpate
