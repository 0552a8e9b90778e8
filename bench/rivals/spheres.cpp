// A god-object among balls around the points: what point objects of haptics libraries are.
#include <algorithm>
#include <cmath>

#include "rivals/god_object.hpp"
#include "rivals/make.hpp"
#include "rivals/near_points.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1;       // s; derived: on a square grid no hole is left
constexpr double kLongestWay = 20;  // s, of one look for balls; judgement: some 400 points
constexpr double kSkin = 1e-6;      // m; judgement: 0.0005 N, far above rounding

class Spheres final : public Rival {
 public:
  explicit Spheres(double scale) : scale_(scale) {}

  void show(const Shown& shown) override {
    points_ = NearPoints(*shown.cloud);
    radius_ = kRadius * scale_ * shown.spacing;
    longest_ = kLongestWay * shown.spacing;
  }

  void reset(const Vector3d& hip) override { place_ = hip; }

  Step step(const Vector3d& hip) override {
    const Vector3d way = hip - place_;
    const bool near = way.norm() <= longest_;
    const Vector3d goal = near ? hip : Vector3d(place_ + longest_ * way.normalized());
    place_ = GodObject<std::uint32_t>().go(
        place_, goal,
        [this](const Vector3d& from, const Vector3d& to, std::span<const std::uint32_t> except) {
          return first_met(from, to, except);
        });
    return spring(place_, hip);
  }

 private:
  using Ball = Met<std::uint32_t>;

  [[nodiscard]] std::optional<Ball> first_met(const Vector3d& from, const Vector3d& to,
                                              std::span<const std::uint32_t> except) const {
    const Vector3d way = to - from;
    const double square = way.squaredNorm();
    std::optional<Ball> first;
    if (square == 0) return first;
    double share = 1;
    const double reach = radius_ + kSkin;
    for (const std::uint32_t i : points_.within(from + 0.5 * way, 0.5 * way.norm() + reach)) {
      const Vector3d away = from - points_.at(i);
      const double inward = -away.dot(way);
      if (inward <= 0 || std::ranges::count(except, i) > 0) continue;
      // |away + t way| = reach; one that is inside already is met at once.
      const double root = inward * inward - square * (away.squaredNorm() - reach * reach);
      if (root < 0) continue;
      const double at = std::max(0.0, (inward - std::sqrt(root)) / square);
      if (at >= share) continue;
      share = at;
      const Vector3d stop = from + at * way;
      first = Ball{i, (stop - points_.at(i)).normalized(), stop, stop};
    }
    return first;
  }

  double scale_;
  double radius_ = 0;
  double longest_ = 0;
  NearPoints points_;
  Vector3d place_ = Vector3d::Zero();
};

}  // namespace

std::unique_ptr<Rival> make_spheres(double scale) {
  return std::make_unique<Spheres>(scale);
}

}  // namespace palpate::rivals
