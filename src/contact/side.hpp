#pragma once

#include <Eigen/Core>
#include <limits>

#include "palpate/field/field.hpp"

namespace palpate {

/// Which side of the points around a proxy is on, told by where points are and by the way that it
/// came, never by normals or by what is decided of sheets (docs/method.md 3.1). A place that it
/// would reach by passing between points is beyond them, however free a field says it is.
/// Real-time.
class Side {
 public:
  void forget() noexcept { *this = {}; }

  /// The proxy comes to a free place. False where that is beyond points that it did not touch; it
  /// is remembered otherwise. Where few points are, there is no side to remember.
  [[nodiscard]] bool pass(const Field& field, const Eigen::Vector3d& place,
                          const Sample& sample) noexcept;

  /// The proxy touches, with this unit normal.
  void touch(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) noexcept;

  /// What a field says is wrong here: until the proxy is away from points, they are felt as they
  /// lie, as a metaball. `radius`: R here, m.
  void doubt(double radius) noexcept { radius_ = radius; }
  [[nodiscard]] bool doubts() const noexcept { return radius_ > 0; }

  /// The sample as it is felt in doubt: solid is what field or metaball says.
  [[nodiscard]] Sample felt(const Sample& sample) const noexcept;

  [[nodiscard]] bool known() const noexcept { return !up_.isZero(0); }
  /// Away from the points, unit; zero while no side is known.
  [[nodiscard]] const Eigen::Vector3d& up() const noexcept { return up_; }
  /// The last place that was surely on this side, m.
  [[nodiscard]] const Eigen::Vector3d& place() const noexcept { return place_; }

 private:
  inline static const Eigen::Vector3d kNowhere =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());

  [[nodiscard]] bool is_beyond(const Eigen::Vector3d& place, const Nearby& nearby) const noexcept;

  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();  // the last one surely on this side, m
  Eigen::Vector3d up_ = Eigen::Vector3d::Zero();     // away from the points, unit; zero: not known
  Eigen::Vector3d looked_ = kNowhere;                // where it looked last since it touched, m
  // Away from these points, or by a contact with others, the side means nothing until few points
  // are around: seen from within, it would be the wrong one.
  bool lost_ = false;
  double radius_ = 0;  // R in doubt, m; 0: none
};

}  // namespace palpate
