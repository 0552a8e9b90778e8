// The iterations of a tool's step.
#include "tool/descent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

// A share of a motion that may be left open where normals are opposed: ten times the least that the
// solver tells them apart by, as long levers make them longer than 1.
constexpr double kOpposed = 1e-5;
constexpr int kRestores = 4;  // of the looks: the last ones only lead out of the surface
// Motions that a step may shorten: then it settles, and what is left waits for the next. That is
// 3.8 m/s where R is 5 mm; with six of them the slowest in a thousand steps took twice as long.
constexpr int kShortened = 3;
constexpr double kWidest = 0.375;  // of R: margin within which a surface is nearly flat (judgement)
constexpr double kNarrowest = 0.06;  // of R: the margin of a hand that rests (judgement)
constexpr int kRounds = 3;       // that find the contacts on which friction tips a tool (judgement)
constexpr double kWithin = 1.5;  // margins are so much wider than the motion that they are for
constexpr double kSlowest = 0.05;   // of a pull, as for a point
constexpr double kArrived = 2e-7;   // of R: nothing is left to be done (nanometres)
constexpr double kRestored = 2e-3;  // of R: the same, while only leading out of the surface
constexpr double kUnproved = 0.02;  // of R: a motion so short needs no look at where it led
constexpr double kDeep = 5e-3;      // of R: a sample deeper than this keeps a step from ending

// The share of a pull that ends on the closest pose, by the secant of the last motion, which was a
// share of the pull before: less than 1 where the tool swings.
double pace_of(const Motion& pull, const Motion& pull_before, const Motion& motion) {
  const double turned_back = motion.dot(pull_before - pull);
  const double length = motion.squaredNorm();
  return turned_back > length ? std::max(kSlowest, length / turned_back) : 1;
}

// How far from the hand (m) a step may end whose first look is at a pose that is outside: no
// farther than it began, but by twice what that look asks for, which leaves open the square of a
// motion.
double farthest_end(const Motion& wanted, const Motion& pull) {
  const double length = wanted.norm();
  return length + 2 * std::max(0.0, (wanted - pull).norm() - length);
}

// Is the tool inside of what contradicts itself, or of what the solver did not come through? It may
// stay there only where the surface has moved.
bool is_squeezed(const LeastMotion& least, const Look& look, double radius) {
  return least.end != LeastMotion::End::solved && look.deepest < -kDeep * radius;
}

// The motion with friction, which takes its part of what is `wanted`.
template <class Solve>
LeastMotion rub(ToolFriction& friction, const ToolFriction::Look& look, LeastMotion pull,
                Motion& wanted, Solve solve) {
  wanted = friction.hold(look, pull);
  pull = solve(wanted);
  for (int round = 0; round < kRounds && friction.add(look, pull); ++round) {
    wanted = friction.hold_again(look);
    pull = solve(wanted);
  }
  return pull;
}

}  // namespace

Descent::Descent(std::shared_ptr<const Tool> tool, const Metric& metric, int iterations)
    : tool_(std::move(tool)), metric_(metric), iterations_(iterations), gaps_(tool_) {}

double Descent::farthest(const Motion& motion) const noexcept {
  const double extent = tool_->extent() + 0.5 * std::abs(pose_.opening);
  return motion.head<3>().norm() + extent * metric_.rotation(motion).norm() +
         0.5 * std::abs(motion[6]);
}

int Descent::most_evaluations(const Tool& tool) noexcept {
  const std::size_t look = tool.samples().size() + tool.nodes().size();
  // R, the free path, lifted touches, looks, the hand's air, and what is touched or lies behind.
  return static_cast<int>(1 + tool.roots().size() + tool.nodes().size() +
                          ToolContact::kMostTouches * (GapSearch::kMostRises + 2) +
                          kMostLooks * look + tool.samples().size());
}

void Descent::move_to(const Pose& pose) noexcept {
  gaps_.move(farthest(metric_.between(pose_, pose)));
  pose_ = pose;
}

void Descent::shift(double moved) noexcept {
  moves_ = std::isfinite(moved);
  if (moves_) {
    gaps_.move(moved);
  } else {
    gaps_.forget();
  }
  outside_.reset();
}

void Descent::put(const Pose& pose, bool free) noexcept {
  move_to(pose);
  touches_ = {};
  friction_.forget();
  outside_.reset();
  if (free) outside_ = {pose};
}

bool Descent::follow(const ToolSurface& surface, const Pose& hand, double moved,
                     const FrictionLaw& law, ToolContact& contact) noexcept {
  friction_.begin(law, pose_);
  const double radius = gaps_.radius();
  Progress step{.margin = std::clamp(kWithin * moved, kNarrowest * radius, kWidest * radius),
                .moves = std::exchange(moves_, false)};
  plane_count_ = 0;
  // What is older would be felt as a blow.
  if (outside_ && std::exchange(outside_->is_old, true)) outside_.reset();
  bool goes_on = true;
  for (int look = 0; goes_on && look < kMostLooks; ++look) {
    ++contact.iterations;
    const bool restores =
        step.settles || look + kRestores >= kMostLooks || step.shortened >= kShortened;
    if (restores && !step.settles && !step.whole) contact.notes |= ContactNote::sweep_truncated;
    goes_on = iterate(surface, hand, restores, step, contact) && step.finite;
    if (look > 0 || !outside_ || outside_->is_old) continue;
    const Motion wanted = metric_.between(outside_->pose, hand);
    step.first = {outside_->pose, touches_, farthest_end(wanted, step.pull)};
  }
  if (!step.finite) contact.notes |= ContactNote::fault;
  // What friction took on the way of a motion that was shortened is not known.
  const bool rubbed = friction_.any() && step.shortened == 0;
  if (rubbed) touches_.dissipated = friction_.dissipated(metric_, pose_);
  if (goes_on) contact.notes |= ContactNote::not_converged;
  const bool ends = step.finite && !has(contact.notes, ContactNote::sweep_truncated);
  if (ends && metric_.between(pose_, hand).norm() > step.first.farthest) {
    move_to(step.first.pose);
    touches_ = step.first.touches;
    outside_ = {pose_};
  } else if (goes_on && !step.proved && outside_) {
    move_to(outside_->pose);
  }
  return outside_.has_value();
}

// One look and one motion. False: the step is done.
bool Descent::iterate(const ToolSurface& surface, const Pose& hand, bool restores, Progress& step,
                      ToolContact& contact) noexcept {
  constraints_.clear();
  if (tool_->opens()) {  // fingers do not pass through each other
    constraints_.add({.normal = Motion::Unit(6), .bound = -pose_.opening});
    constraints_.keep();
  }
  const Look look = gaps_.look(surface, pose_, metric_, step.margin, constraints_);
  if (look.unknown) {  // what is not known is solid: back to where it was not
    contact.notes |= ContactNote::sweep_truncated;
    if (outside_) move_to(outside_->pose);
    return false;
  }
  const std::size_t seen = constraints_.all().size();
  if (look.deepest > -kOutside * gaps_.radius()) {
    outside_ = {pose_};
  } else {
    step.creased = step.creased || step.held > 0;
  }
  if (restores) return restore(look, step);
  if (step.creased) add_planes();
  Motion wanted = metric_.between(pose_, hand);
  LeastMotion pull = solve(wanted);
  if (pull.count == 0) friction_.forget();
  const bool rubs = friction_.any() && pull.count > 0 && pull.end == LeastMotion::End::solved;
  if (rubs) {
    const ToolFriction::Look look_of{*tool_, metric_, pose_, constraints_.all(), wanted};
    pull = rub(friction_, look_of, pull, wanted, [this](const Motion& m) { return solve(m); });
  }
  remember_touches(pull, rubs);
  const bool held = step.held > 0 && pull.count > 0;
  const double pace = held ? pace_of(pull.motion, step.pull, step.motion) : 1;
  const LeastMotion least = pace < 1 ? solve(pace * wanted) : pull;
  step.pull = pull.motion;
  const double far = move(least, seen, look, step);
  const bool free = pull.end == LeastMotion::End::solved && pull.count == 0;
  if (pace == 1 && step.whole && free && step.finite) pose_ = hand;
  return goes_on(pull, far, look, step);
}

// A motion back onto the constraints, and onto the planes that were active in this step. False: it
// is as good as none.
bool Descent::restore(const Look& look, Progress& step) noexcept {
  const std::size_t seen = constraints_.all().size();
  add_planes();
  const LeastMotion back = solve(Motion::Zero());
  const bool squeezed = is_squeezed(back, look, gaps_.radius());
  const double far = move(back, seen, look, step);
  step.proved = step.proved && !squeezed;
  return squeezed || far >= kRestored * gaps_.radius();
}

// A crease shows one of its faces at a time, so those that were met go on holding.
void Descent::add_planes() noexcept {
  for (std::size_t i = 0; i < plane_count_; ++i) constraints_.add(planes_[i]);
}

// Moves as far as the look is right. Returns how far a sample would have gone at most, m.
double Descent::move(const LeastMotion& least, std::size_t seen, const Look& look,
                     Progress& step) noexcept {
  const double radius = gaps_.radius();
  const double far = farthest(least.motion);
  const double longest =
      std::max(std::min(kLongest * radius, look.margin / kWithin), look.clearance);
  step.finite = std::isfinite(far);
  if (!step.finite) return far;
  step.whole = far <= longest;
  step.shortened += step.whole ? 0 : 1;
  step.proved = far < kUnproved * radius;
  // What is left to be moved is the rest or, of a whole motion, no longer than that was.
  const double left = step.whole ? far : far - longest;
  step.margin = std::clamp(kWithin * left, kNarrowest * radius, kWidest * radius);
  step.motion = step.whole ? least.motion : (longest / far * least.motion).eval();
  remember_planes(least, seen, step.motion);
  pose_ = metric_.moved(pose_, step.motion);
  gaps_.move(std::min(far, longest));
  return far;
}

// What squeezes the tool cannot all be followed: then it is held where it is. Normals that are
// nearly opposed contradict each other even there, unless that much of the motion is left open.
LeastMotion Descent::solve(const Motion& wanted) noexcept {
  LeastMotion least = least_motion(constraints_.all(), wanted, kSolved);
  if (least.end != LeastMotion::End::infeasible) return least;
  for (Constraint& each : constraints_.all()) each.bound = std::min(0.0, each.bound);
  least = least_motion(constraints_.all(), wanted, kSolved + kOpposed * wanted.norm());
  if (least.end == LeastMotion::End::infeasible) least = {};  // no motion at all
  least.end = LeastMotion::End::infeasible;
  return least;
}

bool Descent::goes_on(const LeastMotion& pull, double far, const Look& look,
                      Progress& step) noexcept {
  const double radius = gaps_.radius();
  const bool still = step.whole && far < kArrived * radius;
  if (is_squeezed(pull, look, radius) || (still && look.deepest < -kDeep * radius)) {
    step.settles = true;
    return true;
  }
  if (still) return false;
  // The first order leaves open the square of so short a motion, and the next step looks again at a
  // surface that moves on.
  const bool small = step.moves && step.whole && far < kRestored * radius;
  if (small && pull.count > 0 && look.deepest > -kDeep * radius) return false;
  if (step.whole && pull.count == 0) return !step.proved && !constraints_.all().empty();
  if (pull.count > 0) ++step.held;
  if (!step.whole || step.held < iterations_) return true;
  if (step.proved && look.deepest > -kDeep * radius) return false;
  step.settles = true;
  return true;
}

// `seen`: constraints before the planes that are known already.
void Descent::remember_planes(const LeastMotion& least, std::size_t seen,
                              const Motion& motion) noexcept {
  for (int k = 0; k < least.count; ++k) {
    const auto index = static_cast<std::size_t>(least.active[static_cast<std::size_t>(k)].index);
    if (index < seen && plane_count_ < planes_.size()) {
      planes_[plane_count_++] = constraints_.all()[index];
    }
  }
  for (std::size_t i = 0; i < plane_count_; ++i) {
    planes_[i].bound -= planes_[i].normal.dot(motion);
  }
}

// Friction knows the forces of contacts that rub: they are shared out otherwise than in `least`.
void Descent::remember_touches(const LeastMotion& least, bool rubs) noexcept {
  touches_.count = 0;
  touches_.dissipated = 0;
  touches_.slides = rubs && friction_.slides();
  if (rubs) {
    for (const ToolFriction::Contact& contact : friction_.contacts()) {
      if (contact.sample < 0 || !(contact.pressed > 0)) continue;
      touches_.all[static_cast<std::size_t>(touches_.count++)] = {
          contact.sample, contact.normal.head<3>(), contact.pressed, contact.axes * contact.held};
    }
    return;
  }
  for (int k = 0; k < least.count; ++k) {
    const ActiveConstraint& active = least.active[static_cast<std::size_t>(k)];
    const Constraint& held = constraints_.all()[static_cast<std::size_t>(active.index)];
    if (held.sample < 0) continue;
    touches_.all[static_cast<std::size_t>(touches_.count++)] = {
        held.sample, held.normal.head<3>(), active.multiplier, Eigen::Vector3d::Zero()};
  }
}

}  // namespace palpate
