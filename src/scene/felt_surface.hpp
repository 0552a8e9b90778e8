#pragma once

#include "field/mean_surface.hpp"
#include "palpate/field/field.hpp"
#include "palpate/scene/source.hpp"

namespace palpate {

/// What a place of a source's surface feels like.
[[nodiscard]] inline Surface felt_surface(const PatchSurface& mean,
                                          const SoftMaterial& soft) noexcept {
  Surface result;
  result.source = mean.source;
  result.presence = mean.presence;
  result.velocity = mean.velocity;
  result.stiffness_factor = soft.stiffness_factor + mean.material * (1 - soft.stiffness_factor);
  result.friction_factor = soft.friction_factor + mean.material * (1 - soft.friction_factor);
  return result;
}

}  // namespace palpate
