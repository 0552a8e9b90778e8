// Points grown to cubes, among which the proxy hops from point to point (El-Far et al. 2008).
#include <algorithm>
#include <cmath>
#include <optional>

#include "rivals/make.hpp"
#include "rivals/near_points.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr double kHalfEdge = 1;  // s; derived: cubes of neighbours overlap by half
constexpr double kReach = 3;     // s; judgement: neighbours that it may hop to
constexpr double kSample = 0.5;  // of half an edge; judgement: no cube is stepped over
constexpr int kMostHops = 100;   // a step; judgement: 3 spacings each

class Hexahedra final : public Rival {
 public:
  explicit Hexahedra(double scale) : scale_(scale) {}

  void show(const Shown& shown) override {
    points_ = NearPoints(*shown.cloud);
    half_ = kHalfEdge * scale_ * shown.spacing;
    reach_ = kReach * shown.spacing;
    if (touching_) point_ = points_.nearest(place_);
  }

  void reset(const Vector3d& hip) override {
    last_hip_ = hip;
    touching_ = false;
  }

  Step step(const Vector3d& hip) override {
    if (!touching_) enter(hip);
    last_hip_ = hip;
    if (touching_) {
      hop(hip);
      touching_ = cube_at(hip) || !is_out(hip);
    }
    if (!touching_) return spring(hip, hip);
    place_ = points_.at(point_);
    // A point lies in the middle of its cube: a hand in the outer half is pushed by nothing yet.
    return spring((place_ - hip).dot(out_) > 0 ? place_ : hip, hip);
  }

 private:
  // The nearest point whose cube holds x.
  [[nodiscard]] std::optional<std::uint32_t> cube_at(const Vector3d& x) const {
    std::optional<std::uint32_t> best;
    double nearest = 0;
    for (const std::uint32_t i : points_.within(x, std::sqrt(3.0) * half_)) {
      const Vector3d way = points_.at(i) - x;
      if (way.cwiseAbs().maxCoeff() > half_) continue;
      if (best && way.squaredNorm() >= nearest) continue;
      best = i;
      nearest = way.squaredNorm();
    }
    return best;
  }

  void enter(const Vector3d& hip) {
    const Vector3d way = hip - last_hip_;
    const int samples = 1 + static_cast<int>(way.norm() / (kSample * half_));
    for (int i = 1; i <= samples && !touching_; ++i) {
      const std::optional<std::uint32_t> cube = cube_at(last_hip_ + way * i / samples);
      if (!cube) continue;
      touching_ = true;
      point_ = *cube;
      out_ = way.norm() > 0 ? Vector3d(-way.normalized()) : points_.outside(*cube);
    }
  }

  void hop(const Vector3d& hip) {
    for (int k = 0; k < kMostHops; ++k) {
      const std::uint32_t before = point_;
      double nearest = (points_.at(before) - hip).squaredNorm();
      for (const std::uint32_t i : points_.within(points_.at(before), reach_)) {
        const double way = (points_.at(i) - hip).squaredNorm();
        if (way >= nearest) continue;
        nearest = way;
        point_ = i;
      }
      if (point_ == before) return;
    }
  }

  // Is the way back free along which it came in?
  [[nodiscard]] bool is_out(const Vector3d& hip) const {
    const double length = (points_.at(point_) - hip).norm() + reach_;
    for (double at = 0; at < length; at += kSample * half_) {
      if (cube_at(hip + at * out_)) return false;
    }
    return true;
  }

  double scale_;
  double half_ = 0;
  double reach_ = 0;
  NearPoints points_;
  Vector3d last_hip_ = Vector3d::Zero();
  Vector3d place_ = Vector3d::Zero();
  Vector3d out_ = Vector3d::Zero();
  std::uint32_t point_ = 0;
  bool touching_ = false;
};

}  // namespace

std::unique_ptr<Rival> make_hexahedra(double scale) {
  return std::make_unique<Hexahedra>(scale);
}

}  // namespace palpate::rivals
