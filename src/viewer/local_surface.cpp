#include "viewer/local_surface.hpp"

#include <cmath>

#include "viewer/lattice.hpp"
#include "viewer/surface_net.hpp"

namespace palpate::viewer {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// A block is the smallest cube that is looked at as one: a field gathers points for it once.
constexpr int kBlock = 2;  // cells

// A value further from 0 than this says that there is none in reach, whatever the field's slope.
constexpr double kSteepest = 1.3;

/// Fills a lattice where the surface may be.
class Sampler {
 public:
  Sampler(const Field& field, const LocalRegion& region, Lattice& lattice)
      : field_(field), region_(region), lattice_(lattice) {}

  /// A cube of `edge` cells, from the corner `first` on.
  void look(const Vector3i& first, int edge) {
    const double half = 0.5 * edge * lattice_.cell();
    const Vector3d center = region_.center + lattice_.place(first) + Vector3d::Constant(half);
    if (field_.is_free({center, std::sqrt(3.0) * half})) return;
    if (edge == kBlock) {
      look_at_block(first, center, std::sqrt(3.0) * half);
      return;
    }
    for (int part = 0; part < 8; ++part) {
      look(first + edge / 2 * Vector3i(part & 1, part >> 1 & 1, part >> 2 & 1), edge / 2);
    }
  }

 private:
  void look_at_block(const Vector3i& first, const Vector3d& center, double reach) {
    const Sample middle = field_.sample(center);
    if (!(std::abs(middle.value) <= kSteepest * reach)) return;
    for (int z = 0; z <= kBlock; ++z) {
      for (int y = 0; y <= kBlock; ++y) {
        for (int x = 0; x <= kBlock; ++x) sample(first + Vector3i(x, y, z));
      }
    }
  }

  void sample(const Vector3i& corner) {
    if (lattice_.known(corner)) return;
    const Sample sample = field_.sample(region_.center + lattice_.place(corner));
    lattice_.put(corner, sample.value, sample.support);
  }

  const Field& field_;
  const LocalRegion& region_;
  Lattice& lattice_;
};

}  // namespace

Mesh local_surface(const Field& field, const LocalRegion& region) {
  if (!(region.radius > 0) || !region.center.allFinite()) return {};
  Lattice lattice(kReach * region.radius);
  Sampler(field, region, lattice).look(Vector3i::Zero(), Lattice::kCells);
  return surface_net(lattice, region.least_support);
}

}  // namespace palpate::viewer
