#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "viewer/outbox.hpp"

namespace palpate::viewer {

/// The cloud of a source for those who draw `budget` points in all.
struct PaintedCloud {
  std::size_t source = 0;
  std::size_t budget = 0;
  SharedBytes bytes;
};

/// Encodes each source's newest cloud once for each budget that clients have. One thread uses it.
class CloudPainter {
 public:
  CloudPainter(const Scene& scene, const Eigen::Vector3d& origin)
      : scene_(scene), origin_(origin), sources_(scene.size()) {}

  /// All that is to be seen at `now` (s, on the snapshots' clock); what did not change has the
  /// bytes that it had.
  [[nodiscard]] std::vector<PaintedCloud> paint(const std::set<std::size_t>& budgets, double now);

 private:
  struct Known {
    std::weak_ptr<const SurfacePoints> points;
    std::uint64_t frames = 0;
    bool faded = false;
    std::map<std::size_t, SharedBytes> painted;  // by share
  };

  [[nodiscard]] SharedBytes paint(std::size_t source, const SurfacePoints* points,
                                  std::size_t share) const;

  const Scene& scene_;
  Eigen::Vector3d origin_;
  std::vector<Known> sources_;
};

}  // namespace palpate::viewer
