// The constraints on a tool's motion that a look at the surface finds.
#pragma once

#include <array>
#include <span>

#include "palpate/tool/tool.hpp"
#include "tool/active_set.hpp"

namespace palpate {

/// A list of constraints of fixed capacity.
class ConstraintList {
 public:
  void clear() noexcept { count_ = kept_ = 0; }
  /// What is in it stays until it is cleared.
  void keep() noexcept { kept_ = count_; }
  [[nodiscard]] bool full() const noexcept { return count_ == kCapacity; }
  /// Does nothing when it is full.
  void add(const Constraint& constraint) noexcept {
    if (!full()) all_[count_++] = constraint;
  }
  /// Drops the half with the smaller bounds, but for what is kept. Returns the largest bound that
  /// was dropped.
  double drop_half() noexcept;

  [[nodiscard]] std::span<Constraint> all() noexcept { return {all_.data(), count_}; }

 private:
  static constexpr std::size_t kCapacity = 512;  // samples within a margin; 37 kB (judgement)

  std::array<Constraint, kCapacity> all_;
  std::size_t count_ = 0;
  std::size_t kept_ = 0;  // the first ones
};

/// The constraint that keeps a sample of the tool, in the world at x, on the side of a surface's
/// normal; its bound is still 0.
[[nodiscard]] Constraint constraint_on(const Tool& tool, int sample, const Eigen::Vector3d& x,
                                       const Eigen::Vector3d& normal, const Pose& pose,
                                       const Metric& metric) noexcept;

}  // namespace palpate
