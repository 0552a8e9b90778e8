// Friction's law, the relief, Newton's projection onto the surface and the sweep through free
// space.
#include "contact/probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate {

FrictionLaw friction_law(const Friction& friction, double factor, double stiffness,
                         double dt) noexcept {
  return {.static_coefficient = factor * friction.static_coefficient,
          .dynamic_coefficient = factor * friction.dynamic_coefficient,
          .viscous_rate = factor * friction.viscous / dt,
          .stiffness = stiffness};
}

bool sticks(const FrictionLaw& law, bool sliding, double normal, double tangential) noexcept {
  return tangential <= (sliding ? law.dynamic_coefficient : law.static_coefficient) * normal;
}

double held_stretch(const FrictionLaw& law, double normal, double tangential,
                    double moved) noexcept {
  const double dry = law.dynamic_coefficient * normal;
  if (!(law.viscous_rate > 0)) return std::min(dry, tangential);
  const double held = (dry * law.stiffness + law.viscous_rate * (moved + tangential)) /
                      (law.stiffness + law.viscous_rate);
  return std::min(held, tangential);
}

namespace {

// Orthogonal, and oblique to the axes: on the axis-aligned planes that people build, all three
// sinusoids vary.
constexpr std::array<std::array<double, 3>, 3> kDirections{
    {{2. / 3, -1. / 3, 2. / 3}, {2. / 3, 2. / 3, -1. / 3}, {-1. / 3, 2. / 3, 2. / 3}}};

}  // namespace

Relief relief_at(const Texture& texture, const Eigen::Vector3d& x) noexcept {
  const double wave_number = 2 * std::numbers::pi / texture.wavelength;
  const double share = texture.amplitude / 3;
  Relief relief{.height = -texture.amplitude};
  for (const auto& components : kDirections) {
    const Eigen::Vector3d direction(components[0], components[1], components[2]);
    const double phase = wave_number * direction.dot(x);
    relief.height += share * std::sin(phase);
    relief.gradient += share * wave_number * std::cos(phase) * direction;
  }
  return relief;
}

void carve(const Texture& texture, const Eigen::Vector3d& x, Sample& sample) noexcept {
  if (!(texture.amplitude > 0)) return;
  const Relief relief = relief_at(texture, x);
  sample.value -= relief.height;
  sample.gradient -= relief.gradient;
}

Probe::Probe(const Field& field, const Texture& texture, double radius) noexcept
    : field_(field),
      texture_(texture),
      traits_(field.traits()),
      radius_(radius > 0 ? radius : 16 * traits_.resolution) {
  field_.begin_step();
}

Sample Probe::sample(const Eigen::Vector3d& x) noexcept {
  ++evaluations_;
  Sample sample = field_.sample(x);
  if (sample.radius > 0) radius_ = sample.radius;
  if (is_nothing(sample.value, sample.support)) sample.value = radius_;  // no points here
  carve(texture_, x, sample);
  return sample;
}

bool Probe::is_free(const Ball& ball) noexcept {
  ++evaluations_;
  return field_.is_free(ball);
}

namespace {

constexpr int kSteps = 10;      // of Newton: near the surface each doubles the digits (judgement)
constexpr double kClamp = 0.3;  // of R; f is nearly linear that far (judgement)
constexpr double kTolerance = 1e-6;  // of R: nanometres, far below what a device resolves
constexpr double kLastStep = 2e-4;  // of R: a step so short leaves its square, which needs no proof
constexpr double kAccept = 1e-4;    // of R, when the steps have run out
constexpr double kLeastGradient = 1e-8;  // of a unit slope: rounding decides below it
constexpr double kLeastSupport = 1e-6;   // of weight: hardly a point reaches so far

}  // namespace

std::optional<double> first_order_distance(const Sample& sample) noexcept {
  const double slope = sample.gradient.norm();
  if (!(slope >= kLeastGradient) || !(sample.support >= kLeastSupport)) return std::nullopt;
  return sample.value / slope;
}

std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x) noexcept {
  return project(probe, x, probe.sample(x));
}

std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x,
                                    const Sample& first) noexcept {
  Eigen::Vector3d position = x;
  Sample here = first;
  for (int step = 0;; ++step) {
    const std::optional<double> distance = first_order_distance(here);
    if (!distance) return std::nullopt;
    const double radius = probe.radius();
    const Eigen::Vector3d normal = here.gradient.normalized();
    const double tolerance = (step < kSteps ? kTolerance : kAccept) * radius;
    const bool arrived = std::abs(*distance) < tolerance;
    if (arrived && !here.averted) return SurfacePoint{position, normal, radius};
    if (arrived || step == kSteps) return std::nullopt;
    if (!here.averted && std::abs(*distance) < kLastStep * radius) {
      return SurfacePoint{position - *distance * normal, normal, radius};
    }
    position -= std::clamp(*distance, -kClamp * radius, kClamp * radius) * normal;
    here = probe.sample(position);
  }
}

namespace {

constexpr int kBisections = 10;    // a leaf of R / 16 becomes shorter than kBracket with six
constexpr double kBracket = 1e-3;  // of R: short enough for Newton to do the rest

struct Interval {
  double begin = 0;
  double end = 1;
  [[nodiscard]] double middle() const noexcept { return 0.5 * (begin + end); }
};

// Depth-first, near half first: each level leaves one interval behind.
class Pending {
 public:
  static constexpr int kDepth = 60;  // halvings: more than a double's 53 bits resolve

  explicit Pending(const Interval& whole) noexcept { items_[0] = whole; }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] bool full() const noexcept { return count_ + 2 > kDepth; }
  [[nodiscard]] Interval pop() noexcept { return items_[static_cast<std::size_t>(--count_)]; }
  void push_halves(const Interval& interval) noexcept {
    push({interval.middle(), interval.end});
    push({interval.begin, interval.middle()});
  }

 private:
  void push(const Interval& interval) noexcept {
    items_[static_cast<std::size_t>(count_++)] = interval;
  }
  std::array<Interval, kDepth> items_{};
  int count_ = 1;
};

class Sweeper {
 public:
  Sweeper(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
          Standing standing) noexcept
      : probe_(probe),
        from_(from),
        path_(to - from),
        length_(path_.norm()),
        leaf_(probe.traits().resolution > 0 ? probe.traits().resolution
                                            : kBracket * probe.radius()),
        spent_before_(probe.work()),
        standing_(standing) {}

  [[nodiscard]] Sweep run() noexcept {
    Sweep result = search();
    result.standing = standing_;
    probe_.swept += probe_.work() - spent_before_;
    return result;
  }

 private:
  [[nodiscard]] Eigen::Vector3d at(double t) const noexcept { return from_ + t * path_; }
  [[nodiscard]] double half_length(const Interval& i) const noexcept {
    return 0.5 * (i.end - i.begin) * length_;
  }
  [[nodiscard]] bool spent() const noexcept {
    return probe_.swept + probe_.work() - spent_before_ >= kSweepWork;
  }

  // The first interval is the whole path, whose ball is not free, as the caller has found.
  [[nodiscard]] Sweep search() noexcept {
    Pending pending{{0, 1}};
    bool busy = true;
    double free_until = 0;
    while (!pending.empty()) {
      if (spent()) return {Sweep::End::truncated, at(free_until)};
      const Interval interval = pending.pop();
      const bool certain = !busy && ball_is_free(interval);
      if (certain) standing_ = Standing::front;
      busy = false;
      if (!certain && half_length(interval) >= leaf_ && !pending.full()) {
        pending.push_halves(interval);
        continue;
      }
      const double solid = certain ? -1 : solid_end(interval);
      if (solid >= 0) return hit(free_until, solid);
      free_until = interval.end;
    }
    return {Sweep::End::clear, at(1)};
  }

  [[nodiscard]] bool ball_is_free(const Interval& interval) noexcept {
    return probe_.is_free({at(interval.middle()), half_length(interval)});
  }

  // Where in the leaf it is solid; -1 where it is free.
  [[nodiscard]] double solid_end(const Interval& leaf) noexcept {
    if (stops(at(leaf.middle()))) return leaf.middle();
    if (stops(at(leaf.end))) return leaf.end;
    return -1;
  }

  [[nodiscard]] bool stops(const Eigen::Vector3d& position) noexcept {
    const Sample here = probe_.sample(position);
    if (here.value > 0) {
      standing_ = here.behind ? Standing::behind : Standing::front;
      return false;
    }
    if (standing_ == Standing::behind && here.gradient.dot(path_) > 0) standing_ = Standing::within;
    return standing_ != Standing::within;
  }

  [[nodiscard]] Sweep hit(double free, double solid) noexcept {
    for (int i = 0; i < kBisections; ++i) {
      if ((solid - free) * length_ <= kBracket * probe_.radius()) break;
      const double middle = 0.5 * (free + solid);
      (probe_.inside(at(middle)) ? solid : free) = middle;
    }
    return {Sweep::End::hit, at(free), at(solid)};
  }

  Probe& probe_;
  Eigen::Vector3d from_;
  Eigen::Vector3d path_;
  double length_;
  double leaf_;
  int spent_before_;
  Standing standing_;  // of the last position
};

}  // namespace

std::optional<SurfacePoint> land(Probe& probe, const Sweep& hit) noexcept {
  const std::optional<SurfacePoint> found = project(probe, hit.position);
  return found ? found : project(probe, hit.solid);
}

bool path_is_free(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
  const int before = probe.work();
  const bool free = probe.is_free({0.5 * (from + to), 0.5 * (to - from).norm()});
  probe.swept += probe.work() - before;
  return free;
}

Sweep sweep(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            Standing standing) noexcept {
  return Sweeper{probe, from, to, standing}.run();
}

Sweep first_contact(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
  if (path_is_free(probe, from, to)) return {Sweep::End::clear, to};
  return sweep(probe, from, to);
}

}  // namespace palpate
