#pragma once

#include <Eigen/Core>

#include "contact/probe.hpp"

namespace palpate {

/// Finds, by a few evaluations a step, that a proxy is trapped by a surface that it passed through.
///
/// A position has an escape if a path leads from it to open air, 256 R away: straight, or along
/// what is in its path. A proxy that has been in open air hardly comes to a position without an
/// escape, unless a surface let it pass; that surface traps it within. The sides of points count
/// only near where a path begins. Real-time.
class EscapeSearch {
 public:
  /// What a step spends at most, evaluations.
  static constexpr int kMostLooks = 16;  // 10 lead from a hand to open air (judgement)

  /// The surface has changed, or the proxy was put elsewhere.
  void reset() noexcept { *this = {}; }

  /// A step in which the proxy is free, at `position` (m).
  void wander(Probe& probe, const Eigen::Vector3d& position) noexcept;

  /// A step in which the proxy touches, at `position` (m) with contact normal `normal`, and the
  /// hand is at `hip` (m). True: the hand is in open air, the proxy has been there and is trapped.
  [[nodiscard]] bool is_trapped(Probe& probe, const Eigen::Vector3d& position,
                                const Eigen::Vector3d& normal, const Eigen::Vector3d& hip) noexcept;

 private:
  /// A path that is walked in balls that are free for certain, where there are any.
  struct Ray {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();   // m
    Eigen::Vector3d along = Eigen::Vector3d::Zero();  // unit; zero: there is no ray
    double radius = 0;                                // R where it begins, m
    double gone = 0;                                  // m
    double before = 0;                                // gone, a stride ago, m
    double ball = 0;                                  // radius of the next, m
    int turns = 0;
    double room = 0;     // from the beginning to the first turn, m
    double highest = 0;  // the field on the path so far, m; kAir: it has been in air

    [[nodiscard]] bool any() const noexcept { return !along.isZero(0); }
    [[nodiscard]] bool passes(const Sample& here) noexcept;
    void go(double stride) noexcept;
    [[nodiscard]] bool turn(const Eigen::Vector3d& gradient) noexcept;
  };
  /// The most that a step spends on a ray.
  struct Effort {
    int looks = 0;
    int work = 0;  // Probe::work(); a sample that has begun is finished. 0: none, and what is not
                   // free for certain ends the ray
  };
  enum class End { none, open, blocked };
  /// The proxy is free; its escape is searched for, is found, or there is none.
  enum class State { free, searching, open, trapped };

  [[nodiscard]] static Ray ray(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                               double radius) noexcept;
  [[nodiscard]] End walk(Probe& probe, const Effort& effort) noexcept;
  void search(const Eigen::Vector3d& position) noexcept;
  void look_around(Probe& probe, const Eigen::Vector3d& position,
                   const Eigen::Vector3d& normal) noexcept;

  Ray ray_;
  State state_ = State::free;
  int direction_ = 0;                               // of the ray
  bool has_room_ = false;                           // is there any beside the proxy?
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();  // the proxy at the last search, m
  bool was_out_ = false;                            // since the last reset
};

}  // namespace palpate
