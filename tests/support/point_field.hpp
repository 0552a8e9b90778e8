#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/known_edges.hpp"
#include "support/make_points.hpp"

namespace palpate::test {

/// A scene of points and the field over it, without any preparation in between.
class PointField {
 public:
  explicit PointField(const std::vector<TestPoint>& points, const FieldOptions& options = {},
                      bool sharp_edges = false, std::optional<Eigen::Vector3d> eye = {}) {
    SurfacePoints made = make_points(points, options.kernel);
    if (sharp_edges) tell_edges(made);
    if (eye) made.eye.emplace(SurfaceEye{*eye, {}});
    points_ = std::make_shared<SurfacePoints>(std::move(made));
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->layers.push_back({points_});
    scene_.add("points").publish(std::move(snapshot));
    field_ = std::make_unique<SceneField>(scene_, options);
  }

  /// The field, ready for a step of `proxy` towards `hip`.
  [[nodiscard]] const Field& at(const Eigen::Vector3d& hip, const Proxy& proxy) {
    field_->update(0, hip, proxy);
    return *field_;
  }
  /// The field as it is seen from `place`.
  [[nodiscard]] const Field& at(const Eigen::Vector3d& hip, const Eigen::Vector3d& place) {
    field_->update_from(0, hip, place);
    return *field_;
  }
  [[nodiscard]] const SurfacePoints& points() const { return *points_; }

 private:
  std::shared_ptr<const SurfacePoints> points_;
  Scene scene_;
  std::unique_ptr<SceneField> field_;
};

}  // namespace palpate::test
