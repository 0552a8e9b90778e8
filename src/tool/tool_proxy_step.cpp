// A step of a tool's proxy: where it goes, where it ends for each group of samples, and what the
// hand feels.
#include <algorithm>
#include <cmath>

#include "contact/limit.hpp"
#include "tool/tool_proxy_inside.hpp"

namespace palpate {
namespace {

// Clamps a share that a field gives: rounding or a wrong field may leave 0 to 1.
double share_of_one(double value) {
  return value >= 0 ? std::min(value, 1.0) : 0.0;
}

}  // namespace

// One ball around the whole path of each tree: its center moves on a curve that bends away from
// the chord by an eighth of its greatest acceleration.
bool ToolProxy::Inside::path_is_free(const Field& field, const Pose& hand) noexcept {
  const double angle = turn_between(pose().orientation, hand.orientation).norm();
  const double opened = std::abs(hand.opening - pose().opening);
  for (const std::int32_t root : tool_->roots()) {
    const Tool::Node& node = tool_->nodes()[static_cast<std::size_t>(root)];
    const Eigen::Vector3d from = tool_->in_world(node.center, node.side, pose());
    const Eigen::Vector3d to = tool_->in_world(node.center, node.side, hand);
    const double lever = std::max((from - pose().position).norm(), (to - hand.position).norm());
    const double bow = angle * (angle * lever + opened) / 8;
    const Ball ball{0.5 * (from + to), node.radius + 0.5 * (to - from).norm() + bow};
    if (!descent_.gaps().is_free(field, ball)) return false;
  }
  return true;
}

bool ToolProxy::Inside::move(const ToolSurface& surface, const Pose& hand, const FrictionLaw& law,
                             ToolContact& contact) noexcept {
  const Field& field = surface.whole();
  descent_.gaps().begin(surface, options_.texture, pose());
  if (state_ == State::put) surface.forget_sides();
  if (path_is_free(field, hand)) {
    // Where nobody knows R there is no surface yet: one may come around the tool.
    if (descent_.gaps().radius() > 0) state_ = State::begun;
    descent_.put(hand, true);
    return true;
  }
  if (changed_) descent_.lift(surface, field.traits().reanchor_reach, contact);
  const double moved = descent_.farthest(descent_.metric().between(hand_, hand));
  const bool outside = descent_.follow(surface, hand, moved, law, contact);
  if (state_ == State::put) begin(surface, hand, outside, contact);
  return outside;
}

// A tool that was put inside of what is solid comes out if one step leads it out. Else nothing
// holds it until it has been outside: on a cloud it would be held by both sides of a surface.
void ToolProxy::Inside::begin(const ToolSurface& surface, const Pose& hand, bool outside,
                              ToolContact& contact) noexcept {
  surface.place(pose());
  const double valleys = 2 * options_.texture.amplitude;  // they are below the planes of points
  if (outside && !surface.is_across(Descent::kOutside * descent_.gaps().radius() + valleys)) {
    state_ = State::begun;
    return;
  }
  descent_.put(hand, false);
  contact.notes |= ContactNote::inside;
}

// Lets go of a hand that is held hard in free air for long, as a point does, or whose tool is
// squeezed: something thin has come between the samples, or a surface came back around the tool.
// One that is held hard by a tool inside of something is let go wherever it is. The spring fades
// before.
void ToolProxy::Inside::free_hand(const Field& field, const Pose& hand, bool outside, double dt,
                                  ToolContact& contact) noexcept {
  const double stretch = descent_.metric().between(hand, pose()).norm();
  const bool hard = stretch > Limit::kFar * descent_.gaps().radius() &&
                    options_.stiffness * stretch > Limit::kHardest;
  const bool squeezed = has(contact.notes, ContactNote::not_converged);
  const bool wedged = hard && squeezed && !outside;
  const bool away = spring_.touching() && (hard || squeezed) &&
                    (wedged || descent_.gaps().is_free_at(field, hand));
  if (!spring_.hold_away(away, dt)) return;
  contact.notes |= ContactNote::freed;
  if (spring_.stiffness() > Limit::kGone * options_.stiffness) return;
  descent_.put(hand, false);
  state_ = State::put;
}

// Ends the step of each group of samples, then that of the whole surface where the tool is.
void ToolProxy::Inside::end(const ToolSurface& surface) noexcept {
  for (int group = 0; group < ToolSurface::kMostGroups; ++group) end_group(surface, group);
  if (&surface.group(0) != &surface.whole()) surface.whole().end_step(pose().position, {0, 0, 0});
}

// A group's step ends where it presses most; if it does not, where it is nearest.
void ToolProxy::Inside::end_group(const ToolSurface& surface, int group) noexcept {
  const GapSearch::Nearest& nearest = descent_.gaps().nearest()[static_cast<std::size_t>(group)];
  const bool alone = &surface.group(group) == &surface.whole();
  if (alone && group > 0) return;
  if (!alone && nearest.normal.isZero(0)) return;  // it was not looked at
  Eigen::Vector3d x = nearest.normal.isZero(0) ? pose().position : nearest.position;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double most = -1;  // m, below any multiplier
  for (const Touches::Touch& touch : descent_.touches().span()) {
    if (touch.multiplier <= most || surface.group_of(touch.sample) != group) continue;
    most = touch.multiplier;
    const Tool::Point& sample = tool_->samples()[static_cast<std::size_t>(touch.sample)];
    x = tool_->in_world(sample.position, sample.side, pose());
    normal = touch.normal;
  }
  surface.group(group).end_step(x, normal);
}

// `step`: how far a surface that has changed may have stepped, m; null: it has not changed.
void ToolProxy::Inside::pull(const Pose& before, const Pose& hand, double dt, const double* step,
                             ToolContact& contact) noexcept {
  const Metric& metric = descent_.metric();
  const bool held = spring_.touching();
  const bool at_hand = metric.between(hand, pose()).isZero(0);
  // A tool that lagged behind catches up; where the surface is another one, that is a jump.
  const double hand_moved = metric.between(step ? last_hand_ : hand_, hand).norm();
  const double open = Limit::kLeastFall * descent_.gaps().radius();
  const double jump = metric.between(before, pose()).norm() - 2 * hand_moved;
  const bool far = held && jump > open;
  const bool lifted = has(contact.notes, ContactNote::reanchored);
  const double stretched = metric.between(hand_, before).norm();  // the spring in the last step
  // The closest pose to a hand moves away from it no farther than the hand does, unless the surface
  // moves, or is found to be another one from here.
  const double grown = metric.between(hand, pose()).norm() - stretched - hand_moved;
  const bool jumped = step ? jump > std::max(*step, Limit::kFastest * dt) : grown > open;
  if (far && !lifted && jump > Limit::kFall * stretched) {
    contact.notes |= ContactNote::fell;
  }
  spring_.pull({.hand = hand,
                .before = before,
                .now = pose(),
                .full = factors_.stiffness * options_.stiffness,
                .moved = hand_moved + open,
                .dissipated = descent_.touches().dissipated,
                .dt = dt,
                // A tool that lags behind a hand which has let go is still held: else what it meets
                // next would begin as soft as the spring is stretched.
                .touching = descent_.touches().count > 0 || (held && !at_hand),
                .jumped = far && jumped},
               metric, contact);
  for (ToolContact::Touch& touch : contact.touches) {
    touch.force *= spring_.stiffness();
    touch.friction *= spring_.stiffness();
  }
}

// Reads what the surface is where it is touched, before the field's step ends: its budget counts
// that, too. A touch's force is still its multiplier.
void ToolProxy::Inside::report(const ToolSurface& surface, ToolContact& contact) noexcept {
  contact.proxy = pose();
  contact.evaluations = descent_.gaps().evaluations() + descent_.touches().count;
  double sum = 0;
  double weighted = 0;
  double rubbed = 0;
  double most = 0;
  for (const Touches::Touch& touch : descent_.touches().span()) {
    const Tool::Point& sample = tool_->samples()[static_cast<std::size_t>(touch.sample)];
    const Eigen::Vector3d x = tool_->in_world(sample.position, sample.side, pose());
    const Surface here = surface.group(surface.group_of(touch.sample)).surface(x);
    sum += touch.multiplier;
    weighted +=
        touch.multiplier * share_of_one(here.stiffness_factor) * share_of_one(here.presence);
    rubbed += touch.multiplier * share_of_one(here.friction_factor);
    if (touch.multiplier > most) contact.source = here.source;
    most = std::max(most, touch.multiplier);
    contact.touches[static_cast<std::size_t>(contact.touch_count++)] = {
        x, touch.normal, touch.multiplier, touch.held, touch.sample};
  }
  contact.sliding = descent_.touches().slides;
  if (!(sum > 0)) return;
  factors_ = {weighted / sum, rubbed / sum};
}

}  // namespace palpate
