// Finds ways for a hand that a page leads.
#include "session/led_hand.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "device/free_way.hpp"

namespace palpate::session {
namespace {

using Eigen::Vector3d;

constexpr double kRoom = 1.25;    // R that are free around a way, as of a hand that explores
constexpr double kOpening = 0.5;  // more room for a way's distance from its end, m/m (judgement)
// Share of what is free around the goal that suffices for the way there (judgement)
constexpr double kShare = 0.6;
constexpr double kPatience = 0.2;     // s until a way is looked for again (judgement)
constexpr double kMostPieces = 4000;  // of an arc that is looked at
// Searches of an index for its nearest point that one plan makes at most, over all sources; of one
// source 1209 plans on ten scenes made 70 (median), 371 (p90) and 549 (most).
constexpr int kMostSearches = 2000;
constexpr double kTravelTime = 1;     // s that a long way takes (judgement)
constexpr double kTouchSpeed = 0.1;   // m/s: 0.1 kg on 500 N/m make 0.7 N of it at most
constexpr double kLeastSpeed = 0.25;  // m/s of the hand, as of one that explores ...
constexpr double kMostSpeed = 1;      // ... and at most (judgement)
constexpr double kWayForce = 4;       // N; that takes 3.6 of the usual hand and device
// N that a hand pulls with at most where nothing shows a free way, or none for all of its tool.
// Against a wall it reaches 0.13 m/s with it (3.5 N s/m), which 0.1 kg and 500 N/m turn into 0.9 N.
constexpr double kGropingForce = 0.5;

// What is nearest to a position.
struct Nearest {
  Vector3d offset = Vector3d::Constant(std::numeric_limits<double>::infinity());  // from it, m
  double radius = 1;                                                              // its R, m
  double free = 0;  // of room beyond what was asked for, m

  // R.
  [[nodiscard]] double height() const { return offset.norm() / radius; }
};

// All points of a scene. A plan that has made all of its searches finds points everywhere.
class Obstacles {
 public:
  explicit Obstacles(const Scene& scene) {
    for (std::size_t i = 0; i < scene.size(); ++i) {
      std::shared_ptr<const SurfacePoints> points = scene.source(i).points();
      if (!points || points->size() == 0) continue;
      radius_ = std::min<double>(radius_, points->radius);
      sources_.push_back(std::move(points));
    }
  }

  [[nodiscard]] bool empty() const { return sources_.empty(); }

  /// The smallest R, m; infinite: there is nothing.
  [[nodiscard]] double radius() const { return radius_; }

  /// The point with the least room to `x` beyond `room` R and `more`, m, but at most kRoom R.
  [[nodiscard]] Nearest nearest(const Vector3d& x, double room, double more = 0) {
    Nearest least;
    least.free = std::numeric_limits<double>::infinity();
    for (const auto& source : sources_) {
      if (searches_ == kMostSearches) return {Vector3d::Zero(), 1, -1};
      ++searches_;
      source->grid.nearest((x - source->origin).cast<float>(), 1, found_);
      const std::uint32_t index = found_.front().index;
      const Vector3d offset = x - source->origin - source->grid.points()[index].cast<double>();
      const double radius = source->radii[index];
      const double free = offset.norm() - std::min(kRoom * radius, room * radius + more);
      if (free < least.free) least = {offset, radius, free};
    }
    return least;
  }

 private:
  std::vector<std::shared_ptr<const SurfacePoints>> sources_;
  std::vector<CellGrid::Neighbor> found_;
  double radius_ = std::numeric_limits<double>::infinity();
  int searches_ = 0;
};

// Finds ways between two places off the surface.
class Finder {
 public:
  Finder(Obstacles& obstacles, const Vector3d& goal, const Vector3d& eye)
      : obstacles_(obstacles),
        goal_(goal),
        eye_(eye),
        beside_goal_(obstacles.nearest(goal, kRoom)),
        height_(std::min(beside_goal_.height(), 2 * kRoom)),
        room_(std::min(kShare * height_, kRoom)) {}

  /// That is free around the goal, m.
  [[nodiscard]] double room() const { return room_ * beside_goal_.radius; }

  /// Where a hand that touches or nearly does is lifted to, on its own side of the surface; and is
  /// it free on the way there?
  [[nodiscard]] std::pair<Vector3d, bool> lifted(const ServoState& state) const {
    const Contact& contact = state.contact;
    const Vector3d foot = contact.touching ? contact.proxy : state.hip;
    const Nearest nearest = obstacles_.nearest(foot, kRoom);
    const double height = height_ * nearest.radius;
    if (contact.touching) return raised(foot, height * contact.normal);
    const double distance = nearest.offset.norm();
    if (distance >= height || distance <= 0) return {state.hip, true};
    return raised(state.hip - nearest.offset, height / distance * nearest.offset);
  }

  /// The first that is clear of: straight, arcs off both surfaces or towards the eye, and along
  /// what the eye saw.
  [[nodiscard]] FreeWay from(const Vector3d& start) {
    start_ = start;
    if (!(room_ > 0)) return {{start, goal_}, false};
    FreeWay way = piece(start, goal_, Vector3d::Zero());
    const double length = (goal_ - start).norm();
    const Vector3d off = (off_surface(start) + off_surface(goal_)).normalized();
    const Vector3d towards = (eye_ - 0.5 * (start + goal_)).normalized();
    for (const double lift : {0.25, 0.5, 1.0, 2.0}) {
      for (const Vector3d& up : {off, towards}) {
        if (!way.clear) way = piece(start, goal_, lift * std::max(length, 4 * room()) * up);
      }
    }
    for (const double share : {0.1, 0.2, 0.4, 0.7, 1.0}) {
      if (!way.clear) way = seen(start, share);
    }
    return way;
  }

 private:
  // Off the surface at `foot`: no other is nearer on the way up.
  [[nodiscard]] std::pair<Vector3d, bool> raised(const Vector3d& foot, const Vector3d& way) const {
    bool free = true;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const Vector3d up = share * way;
      free = free && obstacles_.nearest(foot + up, 0).offset.norm() > kShare * up.norm();
    }
    return {foot + way, free};
  }

  [[nodiscard]] FreeWay piece(const Vector3d& a, const Vector3d& b, const Vector3d& rise) const {
    const double length = room_ * obstacles_.radius();
    return arc({a, b}, rise, length, kMostPieces, [&](const Vector3d& x) {
      const double away = std::min((x - start_).norm(), (x - goal_).norm());
      // The room that is asked for grows on the way, too.
      return length + obstacles_.nearest(x, room_, kOpening * away).free / (1 + kOpening);
    });
  }

  [[nodiscard]] Vector3d off_surface(const Vector3d& x) const {
    return obstacles_.nearest(x, 0).offset.normalized();
  }

  // Some share of the way to the eye and back.
  [[nodiscard]] FreeWay seen(const Vector3d& start, double share) const {
    const Vector3d from = start + share * (eye_ - start);
    const Vector3d to = goal_ + share * (eye_ - goal_);
    FreeWay way{{from, to, goal_}, true};
    for (const auto& [a, b] : {std::pair(start, from), std::pair(from, to), std::pair(to, goal_)}) {
      way.clear = way.clear && piece(a, b, Vector3d::Zero()).clear;
    }
    return way;
  }

  Obstacles& obstacles_;
  Vector3d start_ = Vector3d::Zero();
  Vector3d goal_;
  Vector3d eye_;
  Nearest beside_goal_;
  double height_;  // of a lifted hand above the surface, R
  double room_;    // that is free around a way, R
};

// So many of them, and the last.
void thin(std::vector<Vector3d>& positions, std::size_t most) {
  const std::size_t count = std::min(most, positions.size());
  for (std::size_t i = 1; i < count; ++i) {
    positions[i - 1] = positions[i * (positions.size() - 1) / (count - 1)];
  }
  if (count > 1) positions.resize(count - 1);
}

}  // namespace

void LedHand::move(const TargetSource::Target& wish, const std::optional<Vector3d>& eye,
                   const Servo& servo, double stamp) {
  TargetSource::Target target = wish;
  target.position = workspace_.position_to_device(wish.position);
  target.orientation = workspace_.orientation_to_device(wish.orientation);
  target.opening /= workspace_.scale;
  if (!eye) {
    goal_.reset();
    remote_.move(target, stamp);
    return;
  }
  const bool touches = std::isfinite(wish.maximum_force);
  const bool same = goal_ && touches == touches_ && (*goal_ - wish.position).norm() <= near_;
  // A way on which a hand touches is not free.
  const bool caught = !touches && servo.state().contact.touching;
  const bool begins = !same || ((caught || !clear_) && stamp - planned_ > kPatience);
  if (begins) plan(wish.position, *eye, touches, servo.state());
  if (begins) planned_ = stamp;
  // With so little force a hand does not stay behind.
  if (servo.options().tool) way_.speed = kTouchSpeed;
  touches_ = touches;
  way_.corners[way_.size - 1] = target.position;
  const bool gropes = !clear_ || caught || servo.options().tool;  // they are looked at for a point
  target.maximum_force = std::min(target.maximum_force, gropes ? kGropingForce : kWayForce);
  remote_.fly(target, way_, begins, stamp);
}

void LedHand::release() {
  goal_.reset();
  remote_.release();
}

void LedHand::plan(const Vector3d& goal, const Vector3d& eye, bool touches,
                   const ServoState& state) {
  goal_ = goal;
  Obstacles obstacles(scene_);
  std::vector<Vector3d> corners = {goal};
  // Before, and in a fault, nobody knows where the hand is.
  const bool begun = state.step > 0 && state.hip.allFinite() && state.contact.proxy.allFinite();
  if (obstacles.empty() || touches || !begun) {
    near_ = touches ? std::numeric_limits<double>::infinity() : 0;
    clear_ = begun;
  } else {
    Finder finder(obstacles, goal, eye);
    near_ = finder.room();
    const auto [start, free] = finder.lifted(state);
    FreeWay way = finder.from(start);
    clear_ = free && way.clear;
    if (clear_) corners = std::move(way.positions);
    thin(corners, Way::kMost - 1);
    corners.insert(corners.begin(), start);
  }
  double length = 0;
  way_.size = 0;
  for (const Vector3d& corner : corners) {
    way_.corners[way_.size++] = workspace_.position_to_device(corner);
    if (way_.size > 1) length += (corner - corners[way_.size - 2]).norm() / workspace_.scale;
  }
  way_.speed = touches  ? kTouchSpeed
               : clear_ ? std::clamp(length / kTravelTime, kLeastSpeed, kMostSpeed)
                        : kLeastSpeed;
}

}  // namespace palpate::session
