#pragma once

#include "accuracy/truth_scene.hpp"
#include "palpate/field/field.hpp"

namespace palpate::accuracy {

/// The exact signed distance as a Field: what is left of the errors with it is the proxy's and the
/// bench's own.
class TruthField final : public Field {
 public:
  explicit TruthField(const TruthScene& scene) : scene_(&scene) {}

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override;
  [[nodiscard]] Surface surface(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] Field::Traits traits() const noexcept override;

 private:
  const TruthScene* scene_;
};

}  // namespace palpate::accuracy
