// Touches a made scene of splats and compares with its true surface.
#pragma once

#include <algorithm>
#include <cmath>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/rates.hpp"
#include "support/splat_scenes.hpp"

namespace palpate::test {

/// The findings of some strokes.
struct SplatTrial {
  double normal_rms = 0;   ///< of contact normals, degrees
  double height = 0;       ///< of the proxy above the true surface, mean, spacings
  int touching = 0;        ///< ticks that these are of
  int lost = 0;            ///< ticks 1.5 mm deep with less than a fifth of the ideal force
  int deep = 0;            ///< ticks 1.5 mm deep
  int air = 0;             ///< ticks 15 mm and more from the surface
  double most_in_air = 0;  ///< the largest force there, N
  double step = 0;         ///< the largest change of force in a tick beyond stiffness x motion, N
};

inline constexpr double kTrialDepth = 3e-3;     ///< m
inline constexpr double kTrialSpeed = 0.05;     ///< m/s
inline constexpr double kTrialStart = 0.03;     ///< m above the surface
inline constexpr double kTrialStiffness = 500;  ///< N/m

class SplatTouch {
 public:
  SplatTouch(const SplatShell& shell, const SplatShape& shape)
      : shape_(shape), spacing_(shell.spacing), proxy_({.stiffness = kTrialStiffness}) {
    scene_.add("splats", shell.cloud);
    field_.emplace(scene_);
  }

  /// Comes down at `place`, goes 25 mm along the surface and leaves.
  void stroke(const SurfacePlace& place, Random& random) {
    const Eigen::Vector3d along = place.normal.cross(random_direction(random)).normalized();
    const Eigen::Vector3d far = place.position + kTrialStart * place.normal;
    hand_ = far;
    force_.setZero();
    proxy_.reset(far);
    move_to(place.position - kTrialDepth * place.normal);
    constexpr int kPieces = 25;
    for (int i = 1; i <= kPieces; ++i) {
      move_to(at_depth(place.position + 1e-3 * i * along));
    }
    move_to(at_depth(hand_) + (kTrialDepth + kTrialStart) * normal_at(hand_));
  }

  [[nodiscard]] SplatTrial result() const {
    SplatTrial result = trial_;
    const double n = std::max(1, trial_.touching);
    result.normal_rms = std::sqrt(trial_.normal_rms / n) / kDegree;
    result.height = trial_.height / n;
    return result;
  }

 private:
  [[nodiscard]] Eigen::Vector3d normal_at(const Eigen::Vector3d& p) const {
    constexpr double kStep = 1e-6;  // m
    Eigen::Vector3d gradient;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      gradient[k] = shape_.distance(p + step) - shape_.distance(p - step);
    }
    return gradient.normalized();
  }

  [[nodiscard]] Eigen::Vector3d at_depth(const Eigen::Vector3d& p) const {
    return p - (shape_.distance(p) + kTrialDepth) * normal_at(p);
  }

  void move_to(const Eigen::Vector3d& target) {
    const Eigen::Vector3d from = hand_;
    const int steps = static_cast<int>(std::ceil((target - from).norm() / (kTrialSpeed * kTick)));
    for (int i = 1; i <= steps; ++i) tick(from + (target - from) * (double(i) / steps));
  }

  void tick(const Eigen::Vector3d& hand) {
    field_->update(0, hand, proxy_);
    const Contact contact = proxy_.step(*field_, hand, kTick);
    const double motion = kTrialStiffness * (hand - hand_).norm();
    trial_.step = std::max(trial_.step, (contact.force - force_).norm() - motion);
    const double distance = shape_.distance(hand);
    if (distance >= 0.015) {
      ++trial_.air;
      trial_.most_in_air = std::max(trial_.most_in_air, contact.force.norm());
    }
    if (distance < -1.5e-3) {
      ++trial_.deep;
      trial_.lost += contact.force.norm() < 0.2 * kTrialStiffness * -distance ? 1 : 0;
    }
    if (contact.touching) {
      ++trial_.touching;
      const double cosine = contact.normal.dot(normal_at(contact.proxy));
      trial_.normal_rms += std::pow(std::acos(std::clamp(cosine, -1.0, 1.0)), 2);
      trial_.height += shape_.distance(contact.proxy) / spacing_;
    }
    hand_ = hand;
    force_ = contact.force;
  }

  SplatShape shape_;
  double spacing_;
  Scene scene_;
  std::optional<SceneField> field_;
  Proxy proxy_;
  Eigen::Vector3d hand_;
  Eigen::Vector3d force_;
  SplatTrial trial_;
};

/// Strokes at places that `draw` gives.
inline SplatTrial touch_splats(const SplatShell& shell, const SplatShape& shape,
                               const std::function<SurfacePlace(Random&)>& draw, int strokes,
                               std::uint64_t seed) {
  SplatTouch touch(shell, shape);
  Random random(seed);
  for (int i = 0; i < strokes; ++i) touch.stroke(draw(random), random);
  return touch.result();
}

}  // namespace palpate::test
