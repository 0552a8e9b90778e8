#pragma once

#include <cmath>

#include "palpate/contact/proxy.hpp"
#include "palpate/field/analytic.hpp"

namespace palpate::test {

inline const Texture kNoTexture;

/// A flat sheet z = height, solid for `thickness` under it, with a round domain: what a point-set
/// surface of a disc looks like from above.
class SheetField final : public Field {
 public:
  double height = 0;
  double thickness = 5e-3;
  double disc = 0.05;
  std::uint64_t revision = 0;
  double reach = 0;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override {
    const double z = x.z() - height;
    const double rim = std::hypot(x.x(), x.y()) - disc;
    const double cap = std::max(std::abs(z) - thickness, rim);
    Sample sample{.value = std::max(z, cap), .support = 1, .radius = 0.01};
    if (z >= cap) {
      sample.gradient = Eigen::Vector3d::UnitZ();
    } else if (rim > std::abs(z) - thickness) {
      sample.gradient = Eigen::Vector3d(x.x(), x.y(), 0).normalized();
    } else {
      sample.gradient = std::copysign(1.0, z) * Eigen::Vector3d::UnitZ();
    }
    if (cap > 0.02) sample = {.value = 0.02, .radius = 0.01};
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    const Eigen::Vector3d& x = ball.center;
    return std::max(std::abs(x.z() - height) - thickness, std::hypot(x.x(), x.y()) - disc) >
           ball.radius;
  }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override {
    return {.source = 0};
  }
  [[nodiscard]] Field::Traits traits() const noexcept override {
    return {.resolution = 0.01 / 16, .revision = revision, .reanchor_reach = reach, .step = reach};
  }
};

/// Free inside a ball, solid around it: concave everywhere.
class BowlField final : public Field {
 public:
  explicit BowlField(double radius) : radius_(radius) {}

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override {
    const double length = x.norm();
    Sample sample{.value = radius_ - length, .support = 1, .radius = 0.01};
    sample.gradient = length > 0 ? (-x / length).eval() : Eigen::Vector3d::UnitX().eval();
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return radius_ - ball.center.norm() > ball.radius;
  }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {.resolution = 2e-5}; }

 private:
  double radius_;
};

/// Nothing anywhere.
class EmptyField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Eigen::Vector3d&) const noexcept override {
    return {.value = 1};
  }
  [[nodiscard]] bool is_free(const Ball&) const noexcept override { return true; }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override {
    return {.resolution = 1e-4, .revision = 1u << 20};
  }
};

/// Solid everywhere and without a gradient: nothing can be found.
class FogField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Eigen::Vector3d&) const noexcept override {
    return {.value = -1, .support = 1, .radius = 0.01};
  }
  [[nodiscard]] bool is_free(const Ball&) const noexcept override { return false; }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {.resolution = 1e-4}; }
};

/// Solid below `floor` and free above, but never certain of it, and blind farther than 0.1 mm away.
class DoubtfulField final : public Field {
 public:
  double floor = -1;  // m

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override {
    const double height = x.z() - floor;
    if (height > 1e-4) return {.value = 1, .support = 1, .radius = 0.01};
    return {.value = height, .gradient = Eigen::Vector3d::UnitZ(), .support = 1, .radius = 0.01};
  }
  [[nodiscard]] bool is_free(const Ball&) const noexcept override { return false; }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {.resolution = 1e-5}; }
};

/// A plate with faces at z = 0 and z = -5 cm; while it is dull, no surface can be found near it.
class DullPlateField final : public Field {
 public:
  bool dull = false;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override {
    if (dull && x.z() < 0.02 && x.z() > -0.07) return {.value = -1, .support = 1, .radius = 0.01};
    const double above = x.z();
    const double below = -0.05 - x.z();
    return {.value = std::max(above, below),
            .gradient = (above > below ? 1 : -1) * Eigen::Vector3d::UnitZ(),
            .support = 1,
            .radius = 0.01};
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return sample(ball.center).value > ball.radius;
  }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {.resolution = 1e-4}; }
};

}  // namespace palpate::test
