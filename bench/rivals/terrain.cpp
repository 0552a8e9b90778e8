// The god-object on the triangles of a depth image, with and without force shading.
#include <Eigen/Geometry>
#include <algorithm>

#include "rivals/frame_mesh.hpp"
#include "rivals/make.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;
using Triangle = FrameMesh::Triangle;

constexpr double kJump = 5;  // pixel footprints; judgement: 79 degrees of slope

class Terrain final : public Rival {
  // The triangles, with their own normals or with those between the vertices'.
  [[nodiscard]] auto on(bool turned) const {
    return
        [this, turned](const Vector3d& from, const Vector3d& to, std::span<const Triangle> except) {
          auto met = mesh_.first_met(from, to, except);
          if (met && turned) met->normal = mesh_.smooth_normal(met->part, met->crossing);
          return met;
        };
  }

 public:
  Terrain(bool shaded, double scale) : shaded_(shaded), jump_(kJump * scale) {}

  void show(const Shown& shown) override {
    const bool was_seen = mesh_.vertices() > 0 && !mesh_.before(T_world_sensor_.inverse() * place_);
    mesh_ = FrameMesh(*shown.frame, jump_);
    T_world_sensor_ = *shown.frame->T_world_sensor;
    // What has come over the point takes it along its pixel's ray.
    const auto met = mesh_.before(T_world_sensor_.inverse() * place_);
    if (was_seen && met) place_ = T_world_sensor_ * met->stop;
  }

  void reset(const Vector3d& hip) override { place_ = hip; }

  Step step(const Vector3d& hip) override {
    const Eigen::Isometry3d T_sensor_world = T_world_sensor_.inverse();
    const Vector3d from = T_sensor_world * place_;
    const Vector3d hand = T_sensor_world * hip;
    const Vector3d goal = shaded_ ? shaded_goal(from, hand) : hand;
    const Vector3d to = GodObject<Triangle>().go(from, goal, on(false));
    place_ = to == hand ? hip : T_world_sensor_ * to;
    return spring(place_, hip);
  }

 private:
  // Where turned planes would have it (Ruspini et al. 1997); from above the true plane it goes back
  // to that.
  [[nodiscard]] Vector3d shaded_goal(const Vector3d& from, const Vector3d& hand) const {
    GodObject<Triangle> turned;
    const Vector3d goal = turned.go(from, hand, on(true));
    if (!turned.last()) return goal;
    const Vector3d n = mesh_.normal(turned.last()->part);
    return goal - n * std::max(0.0, n.dot(goal - turned.last()->stop));
  }

  bool shaded_;
  double jump_;
  FrameMesh mesh_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
  Vector3d place_ = Vector3d::Zero();
};

}  // namespace

std::unique_ptr<Rival> make_terrain(double scale) {
  return std::make_unique<Terrain>(false, scale);
}
std::unique_ptr<Rival> make_shaded(double scale) {
  return std::make_unique<Terrain>(true, scale);
}

}  // namespace palpate::rivals
