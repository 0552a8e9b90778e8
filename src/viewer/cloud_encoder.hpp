#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/scene/scene.hpp"
#include "viewer/messages.hpp"
#include "viewer/session.hpp"

namespace palpate::viewer {

/// At most `budget` of `count` points, rising: one of each of `budget` equal stretches of their
/// order. Along a CellGrid's Morton order, stretches are places: what is left covers all as the
/// points did, and the same points stay from one call to the next.
[[nodiscard]] std::vector<std::uint32_t> thinned(std::size_t count, std::size_t budget);

/// How many points each of several clouds may show so that all show no more than `budget`: in
/// proportion to their sizes.
[[nodiscard]] std::vector<std::size_t> shares(const std::vector<std::size_t>& sizes,
                                              std::size_t budget);

/// The points that can be felt, where they are going to be, thinned to `budget`, relative to
/// `origin` (m, world). Source and stamp are left to the caller.
[[nodiscard]] CloudMessage cloud_of(const SurfacePoints& points, const Eigen::Vector3d& origin,
                                    std::size_t budget);

/// The cloud of a source for those who draw `budget` points in all.
struct EncodedCloud {
  std::size_t source = 0;
  std::size_t budget = 0;
  SharedBytes bytes;
};

/// Encodes each source's newest cloud once for each budget that clients have. One thread uses it.
class CloudEncoder {
 public:
  CloudEncoder(const Scene& scene, const Eigen::Vector3d& origin)
      : scene_(scene), origin_(origin), sources_(scene.size()) {}

  /// All that is to be seen at `now` (s, on the snapshots' clock); what did not change has the
  /// bytes that it had.
  [[nodiscard]] std::vector<EncodedCloud> encode(const std::set<std::size_t>& budgets, double now);

 private:
  struct Known {
    std::weak_ptr<const SurfacePoints> points;
    std::uint64_t frames = 0;
    bool faded = false;
    std::map<std::size_t, SharedBytes> encoded;  // by share
  };

  [[nodiscard]] SharedBytes encode(std::size_t source, const SurfacePoints* points,
                                   std::size_t share) const;

  const Scene& scene_;
  Eigen::Vector3d origin_;
  std::vector<Known> sources_;
};

}  // namespace palpate::viewer
