// A plane through 5 x 5 raw pixels on each ray gives how far what is seen lies beyond a ball.
#include "sight/sight.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "depth/input.hpp"
#include "sight/pixel_plane.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kGate = 3;     // deviations: noise feigns more once in 700 frames, and by little
constexpr double kNoPlane = 2;  // sigma of residual: two surfaces are in the window (judgement)
constexpr int kStride = 2;  // pixels between windows that look at a ball: what is as wide is seen
constexpr int kRings = 16;  // windows from a ball's middle to its rim at most: 800 in all
constexpr double kSpan = 0.1;  // s between frames that give a speed: noise over less is too large

constexpr double kOtherClock = 0.5;  // s; a stamp further ahead is of another clock (docs/ros2.md)

/// Where the ball's far side is along a unit ray from the camera, m.
double reach_along(const Vector3d& ray, const Vector3d& center, double radius) {
  const double along = ray.dot(center);
  const double aside = center.squaredNorm() - along * along;
  return along + std::sqrt(std::max(radius * radius - aside, 0.0));
}

/// Where the camera sees x, in its frame; nothing: outside of its image.
std::optional<Eigen::Vector2d> seen_at(const CameraModel& camera, const Vector3d& x) {
  if (!(x.z() > 0)) return std::nullopt;
  const Eigen::Vector2d ray = x.head<2>() / x.z();
  if (!depth::is_in_lens(camera.distortion, ray.x(), ray.y())) return std::nullopt;
  const auto [a, b] = depth::distort(camera.distortion, ray.x(), ray.y());
  const Pinhole& p = camera.pinhole;
  const Eigen::Vector2d at(p.cx + p.fx * a, p.cy + p.fy * b);
  const bool inside =
      at.minCoeff() > -0.5 && at.x() < camera.width - 0.5 && at.y() < camera.height - 0.5;
  return inside ? std::optional(at) : std::nullopt;
}

/// How far a surface lies beyond something, along a ray.
struct Gap {
  double metres = 0;
  double deviation = 0;  // m
  bool whole = true;     // one surface fills the window: it can be compared with another frame's

  [[nodiscard]] bool free() const { return metres >= -kGate * deviation; }
};

/// How far the surface at a point of the image lies beyond `reach` m. `stretch`: of the ray there,
/// its length for one metre of depth.
std::optional<Gap> gap_at(const PosedFrame& view, const Eigen::Vector2d& at, double stretch,
                          double reach, int half) {
  PixelWindow window = window_of(view.frame, at.x(), at.y(), half);
  const auto sigma_of = [&](const PixelPlane& plane) {  // 1/m
    return view.noise.sigma(1 / plane.inverse) * plane.inverse * plane.inverse;
  };
  PixelPlane plane = plane_of(window.span());
  if (!plane.valid()) return std::nullopt;
  const bool whole = plane.residual <= kNoPlane * sigma_of(plane);
  if (!whole) plane = plane_of(own_surface(window.span()));
  if (!plane.valid()) return std::nullopt;
  // A window within one patch of pixels that err together errs as one of them.
  const double share = std::min(view.noise.correlation * std::sqrt(plane.leverage), 1.0);
  const double error = whole ? sigma_of(plane) : std::max(sigma_of(plane), plane.residual);
  const double deviation = share * error / (plane.inverse * plane.inverse);
  return Gap{stretch / plane.inverse - reach, stretch * deviation, whole};
}

/// The surface that a frame shows on one ray through a ball.
struct Look {
  bool outside = false;  // the ray misses the image
  std::optional<Gap> gap;
};

/// `x`: a point on the ray, world. `half`: of its window, pixels.
Look look(const PosedFrame& view, const Ball& ball, const Vector3d& x, int half) {
  const Vector3d& eye = view.T_world_sensor.translation();
  const Matrix3d to_sensor = view.T_world_sensor.linear().transpose();
  const Vector3d seen = to_sensor * (x - eye);
  const auto at = seen_at(view.frame.camera, seen);
  if (!at) return {.outside = true, .gap = {}};
  const double reach = reach_along(seen.normalized(), to_sensor * (ball.center - eye), ball.radius);
  const double stretch = seen.norm() / seen.z();
  return {.outside = false, .gap = gap_at(view, *at, stretch, reach, half)};
}

/// Points on a disc through a ball's middle that faces `eye`, some `pitch` apart; the middle first.
std::vector<Vector3d> points_on(const Ball& ball, const Vector3d& eye, double pitch) {
  std::vector<Vector3d> points{ball.center};
  const Vector3d ray = (ball.center - eye).normalized();
  const Vector3d side = ray.unitOrthogonal();
  const Vector3d other = ray.cross(side);
  const int rings = std::min(static_cast<int>(std::ceil(ball.radius / pitch)), kRings);
  for (int i = -rings; i <= rings; ++i) {
    for (int j = -rings; j <= rings; ++j) {
      const double across = ball.radius * i / rings;
      const double down = ball.radius * j / rings;
      if ((i != 0 || j != 0) && std::hypot(across, down) <= ball.radius)
        points.emplace_back(ball.center + across * side + down * other);
    }
  }
  return points;
}

/// Adds what a ray shows to what was seen of the ball: where the surface is and, if it goes on as
/// it came since an earlier frame, where it will be. Three deviations of either may be noise.
void add(const Gap& gap, const std::optional<Gap>& before, double span, Seen& seen) {
  double behind = 0;
  double lift = 0;  // is steady where it begins, and soon the whole depth
  const auto measured = [&](double depth, double noise) {
    if (!(depth > noise)) return;
    behind = std::max(behind, depth - noise);
    lift = std::max(lift, depth - noise * noise / depth);
  };
  measured(-gap.metres, kGate * gap.deviation);
  seen.measured = std::max(seen.measured, lift);
  const bool compares = before && before->whole && gap.whole;
  if (compares) {
    const double ahead = std::max(seen.age, 0.0) / span;
    const double error = std::hypot((1 + ahead) * gap.deviation, ahead * before->deviation);
    const double foreseen = ahead * (before->metres - gap.metres) - gap.metres;
    measured(foreseen, kGate * error);
  }
  seen.lift = std::max(seen.lift, lift);
  if (behind <= seen.behind) return;
  seen.verdict = Seen::Verdict::solid;
  seen.behind = behind;
  seen.came = compares && before->free();
}

/// A ray through a ball, to a point on its disc.
struct Probe {
  const Ball* ball;
  Vector3d point;
};

/// Leaves of many balls' rays the one through each pixel that reaches farthest: their windows show
/// the same surface.
void keep_farthest(const PosedFrame& view, std::vector<Probe>& probes) {
  constexpr long kOutside = -1;  // no pixel
  struct Place {
    long pixel = kOutside;
    double reach = 0;
    Probe probe;
  };
  const Eigen::Isometry3d to_sensor = view.T_world_sensor.inverse();
  std::vector<Place> places;
  for (const Probe& probe : probes) {
    const Vector3d seen = to_sensor * probe.point;
    Place& place = places.emplace_back(Place{.probe = probe});
    const auto at = seen_at(view.frame.camera, seen);
    if (!at) continue;
    place.pixel = std::lround(at->y()) * view.frame.camera.width + std::lround(at->x());
    place.reach =
        reach_along(seen.normalized(), to_sensor * probe.ball->center, probe.ball->radius);
  }
  std::ranges::stable_sort(places, [](const Place& a, const Place& b) {
    return std::tuple(a.pixel, b.reach) < std::tuple(b.pixel, a.reach);
  });
  probes.clear();
  long pixel = kOutside - 1;
  for (const Place& place : places) {
    if (std::exchange(pixel, place.pixel) != place.pixel) probes.push_back(place.probe);
  }
}

/// Rays that look at all of the balls.
std::vector<Probe> probes_of(const PosedFrame& view, std::span<const Ball> balls) {
  const Vector3d eye = view.T_world_sensor.translation();
  const Pinhole& p = view.frame.camera.pinhole;
  std::vector<Probe> probes;
  for (const Ball& ball : balls) {
    const double pitch = kStride * (eye - ball.center).norm() / std::max(p.fx, p.fy);
    for (const Vector3d& point : points_on(ball, eye, pitch)) probes.push_back({&ball, point});
  }
  if (balls.size() > 1) keep_farthest(view, probes);
  return probes;
}

Vector3d middle_of(std::span<const Ball> balls) {
  Vector3d sum = Vector3d::Zero();
  for (const Ball& ball : balls) sum += ball.center;
  return sum / static_cast<double>(balls.size());
}

/// `before`: an earlier frame that gives how fast things come; null: there is none. `half`: of the
/// windows, pixels.
Seen judge(const PosedFrame& newest, const PosedFrame* before, std::span<const Ball> balls,
           double now, int half) {
  Seen seen;
  seen.age = now - newest.frame.stamp;
  if (balls.empty()) return seen;
  seen.towards = (newest.T_world_sensor.translation() - middle_of(balls)).normalized();
  const double span = before != nullptr ? newest.frame.stamp - before->frame.stamp : 0;
  seen.verdict = Seen::Verdict::free;
  for (const auto& [ball, point] : probes_of(newest, balls)) {
    const Look shown = look(newest, *ball, point, half);
    if (shown.gap) {
      add(*shown.gap, span > 0 ? look(*before, *ball, point, half).gap : std::nullopt, span, seen);
    } else if (seen.rest == Seen::Verdict::free) {
      seen.rest = shown.outside ? Seen::Verdict::outside : Seen::Verdict::nothing;
    }
  }
  if (seen.verdict == Seen::Verdict::free) seen.verdict = seen.rest;
  return seen;
}

}  // namespace

// One frame from before the newest is late: it shows a past of which a newer one has shown more.
// After two in a row the camera's clock was set back: nothing before them can be compared.
void Sight::see(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor,
                const NoiseModel& noise) {
  const bool back = frames_ > 0 && frame.stamp < newest_.frame.stamp;
  late_ = back && !late_;
  if (late_) return;
  spare_.frame.camera = frame.camera;
  spare_.frame.stamp = frame.stamp;
  spare_.frame.depth = frame.depth;
  spare_.T_world_sensor = T_world_sensor;
  spare_.noise = noise;
  const std::lock_guard lock(mutex_);
  if (back) {
    frames_ = 0;
    lifetime_ = {};
  }
  if (frames_ < 3 || newest_.frame.stamp - base_.frame.stamp >= kSpan) std::swap(base_, before_);
  std::swap(before_, newest_);
  std::swap(newest_, spare_);
  frames_ = std::min(frames_ + 1, 3);
  read_before_ = std::exchange(read_, false);
}

void Sight::forget() {
  const std::lock_guard lock(mutex_);
  frames_ = 0;
}

/// If the newest frame came after the last question, the one before is replaced now, unless nobody
/// read that either. A question for a time of another clock does not count.
void Sight::note_question(double now) {
  if (now < newest_.frame.stamp - kOtherClock) return;
  const bool replaces = !std::exchange(read_, true) && read_before_ && frames_ > 1;
  const double gap = newest_.frame.stamp - before_.frame.stamp;
  if (replaces && gap > 0) lifetime_.add(gap, now - newest_.frame.stamp);
}

/// The age up to which a frame counts, s.
double Sight::lasts(const FrameLimits& limits) const {
  if (std::isinf(limits.later)) return limits.later;
  const std::optional<double> usual = lifetime_.longest();
  return usual ? std::min(*usual, limits.later) : limits.at_first;
}

/// May the frame before the newest one count where that one measured nothing? Only if no frame is
/// missing between them. Until that is certain, it counts as long as if it were the newest.
bool Sight::before_counts(double now, double lasts) const {
  if (frames_ < 2) return false;
  const std::optional<double> interval = lifetime_.interval();
  if (!interval || std::isinf(lasts)) return now - before_.frame.stamp <= lasts;
  return newest_.frame.stamp - before_.frame.stamp <= FrameLifetime::kLost * *interval;
}

std::optional<Seen> Sight::at(std::span<const Ball> balls, double now, const FrameLimits& limits) {
  const std::lock_guard lock(mutex_);
  if (frames_ == 0) return std::nullopt;
  note_question(now);
  const double lasts = this->lasts(limits);
  const auto is_base = [&](const PosedFrame& base, const PosedFrame& frame) {
    return !std::isinf(lasts) && frame.frame.stamp - base.frame.stamp >= kSpan / 2;
  };
  const PosedFrame* base = nullptr;
  if (frames_ > 1 && is_base(before_, newest_)) base = &before_;
  if (frames_ > 2 && base == nullptr && is_base(base_, newest_)) base = &base_;
  Seen seen = judge(newest_, base, balls, now, kHalfWindow);
  const double late = std::max(seen.age - lifetime_.usual().value_or(seen.age), 0.0);
  if (!std::isinf(lasts)) seen.late = late;
  if (seen.verdict == Seen::Verdict::outside) return seen;
  if (seen.age > lasts) {
    seen.verdict = Seen::Verdict::old;
    return seen;
  }
  if (seen.verdict != Seen::Verdict::nothing || !before_counts(now, lasts)) return seen;
  // Around the point the newest frame shows what came since the one before.
  if (judge(newest_, base, balls, now, kWideWindow).verdict != Seen::Verdict::free) return seen;
  const PosedFrame* earlier = frames_ > 2 && is_base(base_, before_) ? &base_ : nullptr;
  Seen earlier_seen = judge(before_, earlier, balls, now, kHalfWindow);
  earlier_seen.late = seen.late;
  return earlier_seen;
}

}  // namespace palpate
