// A thing that was scanned twice, the second time displaced, so that the scans cross each other.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/clouds.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"
#include "support/point_shapes.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kBall = 0.04;       // m
constexpr double kScanned = 1.6e-3;  // spacing, m
constexpr double kPressed = 3e-3;    // m

/// Two scans of a ball, without normals, and a hand.
class CrossedScans {
 public:
  CrossedScans(unsigned seed, double shift)
      : random_(seed), along_(random_.direction()), second_(shift * kScanned * along_) {
    PointCloud cloud;
    for (const bool again : {false, true}) {
      const Sampling sampling{.spacing = kScanned, .jitter = 0.1, .seed = 2 * seed + again};
      const Eigen::AngleAxisd turn(random_.uniform(0, std::numbers::pi), random_.direction());
      for (const TestPoint& p : ball(sampling, kBall)) {
        const Vector3d place = turn * (kBall * p.position.normalized());
        cloud.positions.push_back((again ? Vector3d(place + second_) : place).cast<float>());
      }
    }
    scene_.add("ball", cloud);
    field_.emplace(scene_);
  }

  /// Does a hand that presses at 3 cm/s, near where the scans cross, end without contact?
  bool poke_passes() {
    Vector3d way = random_.direction();
    while (std::abs(way.dot(along_)) > 0.5) way = random_.direction();
    constexpr int kSteps = 500;
    constexpr double kFrom = 12e-3;
    Proxy proxy;
    proxy.reset(outer(way, kFrom));
    Contact contact;
    for (int k = 0; k <= kSteps; ++k) {
      contact = step(proxy, outer(way, kFrom - (kFrom + kPressed) * k / kSteps));
    }
    return !contact.touching;
  }

  /// Is a hand without contact in any step in which it presses and strokes across where the scans
  /// cross?
  bool slide_is_lost() {
    constexpr int kSteps = 2000;
    const Vector3d side = along_.cross(random_.direction()).normalized();
    Proxy proxy;
    proxy.reset(outer(side, 2 * kBall));
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = -0.5 + std::max(0.0, 1.25 * k / kSteps - 0.25);
      const Vector3d way = std::cos(angle) * side + std::sin(angle) * along_;
      const Contact contact = step(proxy, outer(way, std::max(-2e-3, 12e-3 - 70e-3 * k / kSteps)));
      if (5 * k > kSteps && !contact.touching) return true;
    }
    return false;
  }

 private:
  /// So high above the outer one of the scans.
  [[nodiscard]] Vector3d outer(const Vector3d& way, double height) const {
    const Vector3d middle = 0.5 * second_;
    const double off = std::abs(middle.dot(way));
    const double reach = off + std::sqrt(off * off - middle.squaredNorm() + kBall * kBall);
    return middle + (reach + height) * way;
  }

  Contact step(Proxy& proxy, const Vector3d& hand) {
    field_->update(now_ += kTick, hand, proxy);
    return proxy.step(*field_, hand, kTick);
  }

  Clouds random_;
  Vector3d along_;
  Vector3d second_;
  Scene scene_;
  std::optional<SceneField> field_;
  double now_ = 0;
};

// Seeds 101 to 200: 13 of 1200 strokes are lost, 5 of them at 2 spacings and 8 at 3, for up to
// 0.95 s; of 12,000 pokes none.
TEST(CrossedScans, LetNoPokeThroughAndFewStrokes) {
  int passed = 0;
  int lost = 0;
  int strokes = 0;
  for (const double shift : {1.5, 2., 3.}) {
    for (unsigned seed = 1; seed <= static_cast<unsigned>(effort(2)); ++seed) {
      CrossedScans scans(seed, shift);
      for (int k = 0; k < 40; ++k) passed += scans.poke_passes() ? 1 : 0;
      for (int k = 0; k < 4; ++k, ++strokes) lost += scans.slide_is_lost() ? 1 : 0;
    }
  }
  EXPECT_EQ(passed, 0);
  EXPECT_LE(lost, 1 + strokes / 25) << "of " << strokes;
}

}  // namespace
}  // namespace palpate::test
