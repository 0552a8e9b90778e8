// A ball that rolls over the points (Sreeni and Chaudhuri 2012; its radius by density, Kumari
// 2020).
#include <algorithm>
#include <cmath>

#include "rivals/make.hpp"
#include "rivals/near_points.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 3;  // s; judgement: no gap between points lets it through
constexpr double kLocal = 2;   // mean distances to neighbours; derived: the abstract
constexpr std::size_t kNeighbors = 8;
constexpr double kMove = 0.05;   // of the radius; judgement
constexpr int kMostMoves = 50;   // a step; judgement: two and a half radii
constexpr double kFelt = 1.05;   // of the radius; judgement: what lies on the ball counts as in it
constexpr int kMostPushes = 10;  // judgement: each brings the next points to the ball
constexpr double kRest = 1e-7;   // m; judgement: a shorter move is rest

class RollingBall final : public Rival {
 public:
  RollingBall(bool local, double scale) : local_(local), scale_(scale) {}

  void show(const Shown& shown) override {
    points_ = NearPoints(*shown.cloud);
    radius_ = kRadius * scale_ * shown.spacing;
  }

  void reset(const Vector3d& hip) override { place_ = hip; }

  Step step(const Vector3d& hip) override {
    for (int i = 0; i < kMostMoves; ++i) {
      if (local_) radius_ = local_radius();
      const Vector3d before = place_;
      move(hip);
      push_out();
      const bool nearer = (hip - place_).norm() < (hip - before).norm() - kRest;
      if (!nearer) break;
    }
    return spring(place_, hip);
  }

 private:
  [[nodiscard]] double local_radius() const {
    double sum = 0;
    const std::uint32_t closest = points_.nearest(place_);
    const auto near = points_.nearest(points_.at(closest), kNeighbors + 1);
    for (const CellGrid::Neighbor& n : near)
      sum += std::sqrt(static_cast<double>(n.squared_distance));
    return kLocal * scale_ * sum / static_cast<double>(near.size() - 1);
  }

  // Mean direction from the points in the ball; zero without any.
  [[nodiscard]] Vector3d normal() const {
    Vector3d sum = Vector3d::Zero();
    for (const std::uint32_t i : points_.within(place_, kFelt * radius_))
      sum += place_ - points_.at(i);
    return sum.norm() > 0 ? Vector3d(sum.normalized()) : Vector3d::Zero();
  }

  // A short move to the hand, in contact along the surface.
  void move(const Vector3d& hip) {
    const Vector3d n = normal();
    Vector3d way = hip - place_;
    if (way.dot(n) < 0) way -= n * n.dot(way);
    const double length = way.norm();
    if (length > 0) place_ += way * std::min(1.0, kMove * radius_ / length);
  }

  // Along the mean direction until no point is in the ball.
  void push_out() {
    for (int i = 0; i < kMostPushes; ++i) {
      const Vector3d n = normal();
      double far = 0;
      for (const std::uint32_t k : points_.within(place_, radius_)) {
        const Vector3d way = place_ - points_.at(k);
        const double along = way.dot(n);
        const double free = along * along + radius_ * radius_ - way.squaredNorm();
        far = std::max(far, std::sqrt(std::max(free, 0.0)) - along);
      }
      if (far < kRest || n.isZero()) return;
      place_ += far * n;
    }
  }

  bool local_;
  double scale_;
  double radius_ = 0;
  NearPoints points_;
  Vector3d place_ = Vector3d::Zero();
};

}  // namespace

std::unique_ptr<Rival> make_ball(double scale) {
  return std::make_unique<RollingBall>(false, scale);
}
std::unique_ptr<Rival> make_local_ball(double scale) {
  return std::make_unique<RollingBall>(true, scale);
}

}  // namespace palpate::rivals
