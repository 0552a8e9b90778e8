#include "contact/sweep.hpp"

#include <array>

namespace palpate {
namespace {

constexpr int kBisections = 10;
constexpr double kBracket = 1e-3;  // of R: short enough for Newton to do the rest

struct Interval {
  double begin = 0;
  double end = 1;
  [[nodiscard]] double middle() const noexcept { return 0.5 * (begin + end); }
};

// Depth-first, near half first: each level leaves one interval behind.
class Pending {
 public:
  static constexpr int kDepth = 60;

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
  Sweeper(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept
      : probe_(probe),
        from_(from),
        way_(to - from),
        length_(way_.norm()),
        leaf_(probe.traits().resolution > 0 ? probe.traits().resolution
                                            : kBracket * probe.step_length()),
        spent_before_(probe.work()) {}

  [[nodiscard]] Sweep run() noexcept {
    const Sweep result = search();
    probe_.swept += probe_.work() - spent_before_;
    return result;
  }

 private:
  [[nodiscard]] Eigen::Vector3d at(double t) const noexcept { return from_ + t * way_; }
  [[nodiscard]] double half_length(const Interval& i) const noexcept {
    return 0.5 * (i.end - i.begin) * length_;
  }
  [[nodiscard]] bool spent() const noexcept {
    return probe_.swept + probe_.work() - spent_before_ >= kSweepWork;
  }

  // The first interval is the whole way, of which the caller knows that its ball is not free.
  [[nodiscard]] Sweep search() noexcept {
    Pending pending{{0, 1}};
    bool known_busy = true;
    double free_until = 0;
    while (!pending.empty()) {
      if (spent()) return {Sweep::End::truncated, at(free_until)};
      const Interval interval = pending.pop();
      const bool certain = !known_busy && ball_is_free(interval);
      known_busy = false;
      if (!certain && half_length(interval) >= leaf_ && !pending.full()) {
        pending.push_halves(interval);
        continue;
      }
      const double solid = certain ? -1 : solid_end(interval);
      if (solid >= 0) return {Sweep::End::hit, at(last_free(free_until, solid))};
      free_until = interval.end;
    }
    return {Sweep::End::clear, at(1)};
  }

  [[nodiscard]] bool ball_is_free(const Interval& interval) noexcept {
    return probe_.is_free({at(interval.middle()), half_length(interval)});
  }

  // Where in the leaf it is solid; -1 where it is free.
  [[nodiscard]] double solid_end(const Interval& leaf) noexcept {
    if (probe_.inside(at(leaf.middle()))) return leaf.middle();
    if (probe_.inside(at(leaf.end))) return leaf.end;
    return -1;
  }

  [[nodiscard]] double last_free(double free, double solid) noexcept {
    for (int i = 0; i < kBisections; ++i) {
      if ((solid - free) * length_ <= kBracket * probe_.step_length()) break;
      const double middle = 0.5 * (free + solid);
      (probe_.inside(at(middle)) ? solid : free) = middle;
    }
    return free;
  }

  Probe& probe_;
  Eigen::Vector3d from_;
  Eigen::Vector3d way_;
  double length_;
  double leaf_;
  int spent_before_;
};

}  // namespace

bool way_is_free(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
  const int before = probe.work();
  const bool free = probe.is_free({0.5 * (from + to), 0.5 * (to - from).norm()});
  probe.swept += probe.work() - before;
  return free;
}

Sweep sweep(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
  return Sweeper{probe, from, to}.run();
}

Sweep first_contact(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
  if (way_is_free(probe, from, to)) return {Sweep::End::clear, to};
  return sweep(probe, from, to);
}

}  // namespace palpate
