// Follows a hand from one reading of its position to the next.
#pragma once

#include <Eigen/Core>

namespace palpate {

/// The way of a hand against the surface from reading to reading. A device that is read more rarely
/// than the servo steps holds its position for several steps: the whole way arrives in one step and
/// took all of them. Real-time.
template <class Vector>
class HandPath {
 public:
  /// Between two readings of the hand.
  struct Way {
    Vector length = Vector::Zero();  ///< m, against the surface
    double time = 0;                 ///< s
    int steps = 0;
  };

  /// `velocity`: of the hand against the surface, m/s.
  void begin(const Vector& velocity) noexcept {
    *this = {};
    velocity_ = velocity;
  }

  /// A step of `dt` (s) in which the hand moved by `moved` (m) and the surface with `drift` (m/s).
  /// `fresh`: it was read; `velocity` (m/s) is the device's.
  template <class Input>
  void step(const Input& input, const Vector& moved) noexcept {
    const Vector length = moved - input.drift * input.dt;
    open_.length += length;
    open_.time += input.dt;
    ++open_.steps;
    drifted_ += input.drift * input.dt;
    if (!input.fresh) return;
    const bool held = open_.steps > 1 && open_.time > 0;
    velocity_ = input.velocity - (held ? Vector(drifted_ / open_.time) : input.drift);
    last_ = open_;
    open_ = {};
    drifted_.setZero();
  }

  /// Between the last reading and the one before.
  [[nodiscard]] const Way& last() const noexcept { return last_; }
  /// At the last reading, of the hand against the surface, m/s.
  [[nodiscard]] const Vector& velocity() const noexcept { return velocity_; }

 private:
  Way last_;
  Way open_;                          // since the last reading
  Vector drifted_ = Vector::Zero();   // way of the surface since then, m
  Vector velocity_ = Vector::Zero();  // m/s
};

}  // namespace palpate
