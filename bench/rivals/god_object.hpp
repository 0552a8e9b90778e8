#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "rivals/half_spaces.hpp"

namespace palpate::rivals {

/// What a point met on a straight way.
template <class Part>
struct Met {
  Part part{};               ///< of the surface
  Eigen::Vector3d normal;    ///< of the plane that holds the point there, unit
  Eigen::Vector3d crossing;  ///< on the part, m
  Eigen::Vector3d stop;      ///< on the way, a little before it, m
};

/// One step of the god-object (Zilles and Salisbury 1994): it goes straight to its goal, is held by
/// the plane of what it meets, and goes to the point nearest to the hand that all its planes allow,
/// until nothing is in the way.
template <class Part>
class GodObject {
 public:
  /// `first_met(from, to, except)` gives the first part that is met on a way, but those of
  /// `except`, or nothing. Returns where it comes to rest.
  template <class FirstMet>
  Eigen::Vector3d go(const Eigen::Vector3d& from, const Eigen::Vector3d& hand,
                     const FirstMet& first_met) {
    Eigen::Vector3d place = from;
    Eigen::Vector3d goal = hand;
    for (int i = 0; i < kMostMoves; ++i) {
      const std::optional<Met<Part>> met =
          first_met(place, goal, std::span<const Part>(held_.data(), size_));
      if (!met) return goal;
      place = met->stop;
      release(goal - place);
      if (size_ == kPlanes) return place;
      held_[size_] = met->part;
      normals_[size_++] = met->normal;
      last_ = met;
      goal = place + nearest_allowed({normals_.data(), size_}, hand - place);
    }
    return place;
  }

  /// What it was held by last; none in free air.
  [[nodiscard]] const std::optional<Met<Part>>& last() const { return last_; }

 private:
  static constexpr int kMostMoves = 10;      // judgement: three planes, and what they lead to
  static constexpr std::size_t kPlanes = 3;  // derived: three planes hold a point

  // Where three planes hold it, those go from which the way leads away.
  void release(const Eigen::Vector3d& way) {
    if (size_ < kPlanes) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (normals_[i].dot(way) > 1e-9 * way.norm()) continue;
      held_[kept] = held_[i];
      normals_[kept++] = normals_[i];
    }
    size_ = kept;
  }

  std::array<Part, kPlanes> held_{};
  std::array<Eigen::Vector3d, kPlanes> normals_;
  std::size_t size_ = 0;
  std::optional<Met<Part>> last_;
};

}  // namespace palpate::rivals
