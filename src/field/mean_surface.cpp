#include "field/mean_surface.hpp"

#include <algorithm>
#include <array>

namespace palpate {

PatchSurface mean_surface(const ImplicitSurface& surface, const Patch& patch,
                          const Eigen::Vector3d& x, std::span<const double> presences) noexcept {
  using Eigen::Vector3d;
  const simd::Columns& c = patch.columns();
  const Vector3d local = x - patch.center();
  PatchSurface result;
  double total = 0;
  double material = 0;
  double presence = 0;
  Vector3d velocity = Vector3d::Zero();
  std::array<double, simd::kMaxSources> by_source{};
  for (int run = 0; patch.points() > 0 && run < c.labels * c.sources; ++run) {
    const auto s = static_cast<std::size_t>(run % c.sources);
    double sure = 0;
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; ++i) {
      const Vector3d q = Vector3d(c.position[0][i], c.position[1][i], c.position[2][i]) - local;
      const double w =
          c.weight[i] * evaluate(surface.options.kernel, q.squaredNorm() * c.inverse_r2[i]).w;
      by_source[s] += w;
      total += w;
      material += w * patch.material(i);
      sure += w * patch.presence(i);
      velocity += w * patch.velocity(i);
    }
    presence += sure * (presences.empty() ? 1 : presences[s]);
  }
  const auto first = by_source.begin();
  const auto most = std::max_element(first, first + c.sources);
  const double largest = *most;
  result.source = largest > 0 ? static_cast<int>(most - first) : -1;
  if (total <= 0) return result;
  result.material = material / total;
  if (patch.has_presences() || !presences.empty()) {
    result.presence = std::min(1.0, presence / largest);
  }
  result.velocity = velocity / total;
  return result;
}

}  // namespace palpate
