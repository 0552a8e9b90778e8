#include "field/mean_surface.hpp"

#include <algorithm>

namespace palpate {

PatchSurface mean_surface(const ImplicitSurface& surface, const Patch& patch,
                          const Eigen::Vector3d& x, std::span<const double> presences) noexcept {
  using Eigen::Vector3d;
  const simd::Columns& c = patch.columns();
  const Vector3d local = x - patch.center();
  PatchSurface result;
  double total = 0;
  double largest = 0;
  double material = 0;
  double presence = 0;
  Vector3d velocity = Vector3d::Zero();
  for (int s = 0; patch.points() > 0 && s < c.sources; ++s) {
    double of_source = 0;
    double sure = 0;
    for (std::uint32_t i = c.source_begin[s]; i < c.source_begin[s + 1]; ++i) {
      const Vector3d q = Vector3d(c.position[0][i], c.position[1][i], c.position[2][i]) - local;
      const double w =
          c.weight[i] * evaluate(surface.options.kernel, q.squaredNorm() * c.inverse_r2[i]).w;
      of_source += w;
      material += w * patch.material(i);
      sure += w * patch.presence(i);
      velocity += w * patch.velocity(i);
    }
    total += of_source;
    presence += sure * (presences.empty() ? 1 : presences[static_cast<std::size_t>(s)]);
    if (of_source > largest) {
      largest = of_source;
      result.source = s;
    }
  }
  if (total <= 0) return result;
  result.material = material / total;
  if (patch.has_presences() || !presences.empty()) {
    result.presence = std::min(1.0, presence / largest);
  }
  result.velocity = velocity / total;
  return result;
}

}  // namespace palpate
