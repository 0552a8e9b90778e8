#pragma once

namespace palpate::depth {

/// A change of inverse depth beyond this is another surface, not one that moves: 30 mm, what a
/// hand's 1 m/s covers in a frame.
[[nodiscard]] inline float another_surface(float rho) {
  return 0.03F * rho * rho;
}

}  // namespace palpate::depth
