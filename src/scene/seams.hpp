#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>

#include "palpate/field/surface_points.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate {

/// How far apart two surfaces are where both are there: the median distance, along the normal of
/// `b`, from points of `a` to the nearest point of `b`, m, where they are going. Points count that
/// have a neighbour within three radii whose normal points the same way within 45 degrees; nothing
/// when fewer than 30 of about a thousand that are tried do.
[[nodiscard]] std::optional<double> disagreement(const SurfacePoints& a, const SurfacePoints& b);

/// How wide supports have to be for the surfaces of sources that disagree to be one.
///
/// Heights of sources unite where the supports of both reach (united_height.hpp). Further apart
/// than that there is a gap between two sheets, into which a proxy slips where one of them ends. So
/// where two surfaces of a scene lie up to 1.5 R apart, no R of either is below 2.5 times that
/// distance. What lies further apart stays two.
class Seams {
 public:
  /// Compares the newest points of the source at `place` with those of the others that have come
  /// by. It stays where it is. Takes milliseconds, and memory; any thread but a servo's.
  void compare(std::size_t place, const Source& source);

  /// No support radius of that source is to be below this, m. Changes; may be read by any thread.
  [[nodiscard]] const std::atomic<double>& least_radius(std::size_t place) const noexcept {
    return least_radii_[place];
  }

 private:
  std::mutex mutex_;
  std::array<const Source*, Scene::kMaxSources> sources_{};
  std::array<std::array<double, Scene::kMaxSources>, Scene::kMaxSources> common_{};  // R, m
  std::array<std::atomic<double>, Scene::kMaxSources> least_radii_{};
};

}  // namespace palpate
