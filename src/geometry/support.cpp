#include "palpate/geometry/support.hpp"

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

void check(const SupportOptions& options) {
  const Requirement require{"support radius"};
  if (options.multiple) {
    require.positive("the multiple", *options.multiple, "it must be positive; 2 to 5 are usual");
  }
  require.not_negative("the noise", options.noise, "give metres, 0 or more");
  require.not_negative("the footprint", options.footprint, "give metres, 0 or more");
  require.not_negative("the minimum", options.minimum, "give metres, 0 or more");
  require.positive("the normal error", options.normal_error, "give radians above 0");
  require(options.most_spacings > 0, "the most spacings", options.most_spacings,
          "it must be positive; 6 is usual");
  require(options.finest_shape > 0, "the finest shape", options.finest_shape,
          "give metres above 0");
}

}  // namespace

double support_multiple(double noise, double spacing) {
  if (noise > 0.4 * spacing) return 4;
  return noise > 0.15 * spacing ? 3 : 2.5;
}

double noise_radius(double noise, double footprint, double normal_error) {
  return std::sqrt(3.2 * noise * footprint / normal_error);
}

std::vector<float> support_radii(std::span<const float> spacings, const SupportOptions& options) {
  check(options);
  const double typical = median(spacings);
  const double multiple = options.multiple.value_or(support_multiple(options.noise, typical));
  std::vector<float> radii(spacings.size());
  detail::parallel_ranges(radii.size(), std::size_t{1} << 16, [&](auto begin, auto end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto spacing = static_cast<double>(spacings[i]);
      const double footprint = options.footprint > 0 ? options.footprint : spacing;
      const double smoothing =
          std::min({noise_radius(options.noise, footprint, options.normal_error),
                    options.most_spacings * spacing, options.finest_shape});
      radii[i] = static_cast<float>(std::max({multiple * spacing, options.minimum, smoothing}));
    }
  });
  return radii;
}

}  // namespace palpate
