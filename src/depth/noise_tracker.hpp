#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// A depth image that somebody else owns. Depths along the optical axis, m, row by row; whatever
/// is not within nearest ... farthest (0, NaN, infinity too) counts as not measured.
struct DepthView {
  std::span<const float> depth;
  int width = 0;      ///< pixels
  int height = 0;     ///< pixels
  double focal = 0;   ///< pixels
  float nearest = 0;  ///< m
  float farthest = 0;

  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)];
  }
  [[nodiscard]] bool valid(float z) const { return z >= nearest && z <= farthest; }
};

/// Follows a sensor's sigma(z) and c (docs/method.md 6.2) from frame to frame: the first frame
/// gives a start by what quadratic surfaces leave of its windows, differences of frames replace it
/// where the scene stands still, and from then on every frame adds a bounded share. What they do
/// not tell (too few pixels, all of one value) is taken from the prior. The model that is handed
/// out changes only when the evidence has moved by a tenth, so that the fits of a still scene stay
/// the same. One thread uses it; it allocates only when the size of the frames changes.
class NoiseTracker {
 public:
  explicit NoiseTracker(const NoiseModel& prior);
  ~NoiseTracker();
  NoiseTracker(NoiseTracker&&) noexcept;
  NoiseTracker& operator=(NoiseTracker&&) noexcept;

  /// Looks at the next frame and says what to take for it. A frame that repeats the one before
  /// changes nothing.
  const NoiseModel& update(const DepthView& frame);

  [[nodiscard]] const NoiseModel& model() const;

  /// Back to the prior.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::depth
