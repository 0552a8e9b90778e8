// The path along the surface to the position nearest the hand (docs/method.md 3.3), and how a
// surface that moved is found again (3.4).
#include "contact/slide.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/probe.hpp"

namespace palpate {
namespace {

constexpr double kStep = 0.25;           // of R, the longest sub-step: the surface is smooth over R
constexpr double kReach = 0.5;           // of R, twice a sub-step: farther is another surface
constexpr double kArmijo = 1e-3;         // share of the expected decrease (Armijo 1966)
constexpr double kNormalGate = 0.3;      // cosine of 72 degrees: the surface may not turn over
constexpr double kLift = 2e-3;           // of R, above the surface where a release begins
constexpr double kStay = 1e-3;           // of R, a release that ends sooner is none
constexpr double kFirstTolerance = 0.1;  // of the tangent tolerance: worth one cheap try
constexpr double kFrictionTolerance = 1e-5;  // of R
constexpr double kMostPace = 4;              // a bulge of radius r felt 3/4 r deep: r / (r - depth)
constexpr double kLeastPace = 0.05;          // a hollow of radius r felt 19 r deep: r / (r + depth)
constexpr int kReleases = 3;                 // a corner has three faces
constexpr int kHalvings = 6;                 // R / 256 is shorter than any feature that R keeps
constexpr int kWorkPerIteration = 20 * kEvaluationWork;  // docs/method.md 3.6

enum class Turn { stop, go_on };

class Slider {
 public:
  Slider(Probe& probe, const SurfacePoint& start, const Eigen::Vector3d& hip, bool sliding,
         const SlideOptions& options) noexcept
      : probe_(probe), hip_(hip), options_(options) {
    result_.at = start;
    result_.sliding = sliding;
  }

  [[nodiscard]] Slide run() noexcept {
    const int limit =
        options_.method == ProxyOptions::Method::single_step ? 1 : options_.max_iterations;
    int releases = 0;
    while (result_.iterations < limit) {
      if (exhausted()) return unfinished();
      const Eigen::Vector3d to_hand = hip_ - result_.at.position;
      const double above = to_hand.dot(result_.at.normal);
      Turn turn = Turn::stop;
      if (above >= 0) {
        turn = ++releases > kReleases ? Turn::stop : try_release();
      } else {
        turn = advance(to_hand - above * result_.at.normal, -above);
        ++result_.iterations;
      }
      if (turn == Turn::stop) return result_;
    }
    return options_.method == ProxyOptions::Method::single_step ? result_ : unfinished();
  }

 private:
  [[nodiscard]] bool exhausted() const noexcept {
    return probe_.work() - probe_.swept >= kWorkPerIteration * options_.max_iterations;
  }

  [[nodiscard]] Slide unfinished() noexcept {
    result_.end = Slide::End::unfinished;
    return result_;
  }

  // The hand is above the tangent plane: free to go, unless something else is in its path.
  [[nodiscard]] Turn try_release() noexcept {
    const double radius = result_.at.radius;
    const Eigen::Vector3d from = result_.at.position + kLift * radius * result_.at.normal;
    const int swept = probe_.swept;
    const Sweep path = first_contact(probe_, from, hip_);
    if (path.end != Sweep::End::hit) return leave(path, swept);
    if ((path.position - from).norm() < kStay * radius) return Turn::stop;
    const std::optional<SurfacePoint> next = land(probe_, path);
    if (!next) return Turn::stop;
    result_.at = *next;
    return Turn::go_on;
  }

  // A sweep that only had what others left of the budget proves nothing when it is truncated: the
  // proxy stays, so that the force does not drop for one step, and the next step looks again. One
  // that had most of the budget goes on from where it ended. `swept`: what was spent before it.
  [[nodiscard]] Turn leave(const Sweep& path, int swept) noexcept {
    const bool clear = path.end == Sweep::End::clear;
    // A fold of what moves is no rim.
    const bool behind = options_.moved && probe_.sample(clear ? hip_ : path.position).behind;
    if (behind || (!clear && swept >= kSweepWork / 2)) {
      result_.end = Slide::End::postponed;
      return Turn::stop;
    }
    result_.end = clear ? Slide::End::released : Slide::End::interrupted;
    result_.at.position = clear ? hip_ : path.position;
    result_.standing = path.standing;
    return Turn::stop;
  }

  // One sub-step along the surface. `tangent` and `depth`: the displacement to the hand along and
  // into it.
  [[nodiscard]] Turn advance(const Eigen::Vector3d& tangent, double depth) noexcept {
    const double length = tangent.norm();
    if (sticks(options_.friction, result_.sliding, depth, length)) {
      if (result_.iterations == 0) result_.sliding = false;
      return Turn::stop;
    }
    const double held = held_stretch(options_.friction, depth, length, moved_);
    const double wanted = length - held;
    if (!(wanted > tolerance())) return Turn::stop;
    const double longest = kStep * result_.at.radius;
    const double limit =
        options_.longest_step > 0 ? std::min(longest, options_.longest_step) : longest;
    const double step = std::min(pace(tangent) * wanted, limit);
    last_position_ = result_.at.position;
    last_tangent_ = tangent;
    result_.sliding = true;
    const Eigen::Vector3d direction = tangent / length;
    const double done = move(direction, step, length);
    moved_ += done;
    result_.dissipated += options_.friction.stiffness * held * done;
    return done > 0 ? Turn::go_on : leap(step * direction);
  }

  // How much of the tangent to try first: all of it on a plane, less where the surface is hollow
  // and more where it bulges, by the secant of the last sub-step (Barzilai and Borwein, Two-point
  // step size gradient methods, 1988). Never beyond where friction holds.
  [[nodiscard]] double pace(const Eigen::Vector3d& tangent) const noexcept {
    if (result_.iterations == 0) return 1;
    const double most = options_.friction.any() ? 1 : kMostPace;
    const Eigen::Vector3d moved = result_.at.position - last_position_;
    const double fallen = moved.dot(last_tangent_ - tangent);
    if (!(most * fallen > moved.squaredNorm())) return most;
    return std::max(kLeastPace, moved.squaredNorm() / fallen);
  }

  // Leaves the surface where no step along it was accepted. At the foot of a wall the tangent plane
  // runs into the wall, and that is the end; but at a sharp edge it runs into free space, from
  // where the hand may be free, or nearer to another face.
  [[nodiscard]] Turn leap(const Eigen::Vector3d& step) noexcept {
    const SurfacePoint& at = result_.at;
    if (options_.method == ProxyOptions::Method::single_step) return Turn::stop;
    if (step.norm() < kStay * at.radius || exhausted()) return Turn::stop;
    const Eigen::Vector3d from = at.position + kLift * at.radius * at.normal;
    const Eigen::Vector3d over = from + step;
    if (probe_.inside(over)) return Turn::stop;
    if (first_contact(probe_, from, over).end != Sweep::End::clear) return Turn::stop;
    const int swept = probe_.swept;
    const Sweep path = first_contact(probe_, over, hip_);
    if (path.end != Sweep::End::hit) return leave(path, swept);
    const std::optional<SurfacePoint> next = land(probe_, path);
    if (!next || (hip_ - next->position).squaredNorm() >
                     (hip_ - at.position).squaredNorm() - kArmijo * step.squaredNorm()) {
      return Turn::stop;
    }
    result_.at = *next;
    result_.leapt = true;
    return Turn::go_on;
  }

  // The first sub-step is worth taking well before the others: it costs little, and without it a
  // hand that creeps would feel the surface hold it (a dead zone of atan(1e-3 R / depth)).
  [[nodiscard]] double tolerance() const noexcept {
    if (options_.friction.any()) return kFrictionTolerance * result_.at.radius;
    const double scale = result_.iterations == 0 ? kFirstTolerance : 1.0;
    return scale * options_.tangent_tolerance * result_.at.radius;
  }

  // Tries a step along `direction`, halved until it is accepted. Returns its length; 0: none was.
  [[nodiscard]] double move(const Eigen::Vector3d& direction, double step, double length) noexcept {
    const bool tiny = step < options_.tangent_tolerance * result_.at.radius;
    const int halvings =
        tiny || options_.method == ProxyOptions::Method::single_step ? 0 : kHalvings;
    double trial = step;
    for (int i = 0; i <= halvings && !exhausted(); ++i, trial *= 0.5) {
      const std::optional<SurfacePoint> next =
          project(probe_, result_.at.position + trial * direction);
      if (next && acceptable(*next, trial * length)) {
        result_.at = *next;
        return trial;
      }
    }
    return 0;
  }

  // `gain` is |t| L: what the squared distance to the hand should fall in proportion to.
  [[nodiscard]] bool acceptable(const SurfacePoint& next, double gain) const noexcept {
    if (options_.method == ProxyOptions::Method::single_step) return true;
    const SurfacePoint& at = result_.at;
    return (hip_ - next.position).squaredNorm() <=
               (hip_ - at.position).squaredNorm() - kArmijo * gain &&
           next.normal.dot(at.normal) > kNormalGate &&
           (next.position - at.position).norm() <= kReach * at.radius;
  }

  Probe& probe_;
  Eigen::Vector3d hip_;
  const SlideOptions& options_;
  Slide result_;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();  // before the last sub-step
  Eigen::Vector3d last_tangent_ = Eigen::Vector3d::Zero();   // of the displacement to the hand, m
  double moved_ = 0;                                         // in this step, m
};

}  // namespace

Slide slide(Probe& probe, const SurfacePoint& start, const Eigen::Vector3d& hip, bool sliding,
            const SlideOptions& options) noexcept {
  return Slider{probe, start, hip, sliding, options}.run();
}

namespace {

constexpr double kLeastNormal = 0.5;    // a unit normal is there; zero means that none is
constexpr double kSameSide = 0.5;       // cosine between the old and the new normal: 60 degrees
constexpr double kLifted = 0.02;        // of R: the surface left the proxy
constexpr double kSunk = 1e-3;          // of R: beyond Newton's rounding, the surface rose over it
constexpr double kLeastReach = 0.5;     // of R
constexpr int kRecoverySteps = 8;       // up to 2 R: beyond it the points weigh nothing
constexpr double kRecoveryStep = 0.25;  // of R

}  // namespace

bool surface_moved(const Probe& probe, const Sample& here, const Eigen::Vector3d& normal,
                   bool changed) noexcept {
  if (normal.norm() < kLeastNormal) return false;
  const std::optional<double> distance = first_order_distance(here);
  if (!distance) return true;
  const double radius = probe.radius();
  if (*distance < -kSunk * radius || *distance > kLifted * radius) return true;
  return changed && *distance > kSunk * radius;
}

bool is_turned(const SurfacePoint& found, const Eigen::Vector3d& side) noexcept {
  return side.norm() > kLeastNormal && !(found.normal.dot(side) > kSameSide);
}

bool is_same_contact(const SurfacePoint& found, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& normal) noexcept {
  return found.normal.dot(normal) > kSameSide &&
         (found.position - position).norm() <= kStep * found.radius;
}

std::optional<SurfacePoint> reanchor(Probe& probe, const Eigen::Vector3d& position,
                                     const Eigen::Vector3d& normal, double radius,
                                     bool& cut) noexcept {
  const double reach = std::max(probe.traits().reanchor_reach, kLeastReach * radius);
  const Eigen::Vector3d top = position + reach * normal;
  const Sample above = probe.sample(top);
  if (!(above.value > 0) || above.behind) return std::nullopt;
  const Sweep path = first_contact(probe, top, position);
  cut = path.end == Sweep::End::truncated;
  if (path.end != Sweep::End::hit) return std::nullopt;
  const std::optional<SurfacePoint> found = land(probe, path);
  return found && found->normal.dot(normal) > kSameSide ? found : std::nullopt;
}

std::optional<SurfacePoint> recover(Probe& probe, const Eigen::Vector3d& position,
                                    const Eigen::Vector3d& normal, int& looked) noexcept {
  const int first = std::exchange(looked, 0);
  if (normal.norm() < kLeastNormal) return std::nullopt;
  const double radius = probe.radius();
  for (int k = first + 1; k <= kRecoverySteps; ++k) {
    if (k > first + 1 && probe.swept >= kSweepWork) {
      looked = k - 1;
      return std::nullopt;
    }
    const Eigen::Vector3d trial = position + k * kRecoveryStep * radius * normal;
    const int before = probe.work();
    const Sample here = probe.sample(trial);
    probe.swept += probe.work() - before;
    if (here.value > 0 && !here.behind) return project(probe, trial, here);
  }
  return std::nullopt;
}

}  // namespace palpate
