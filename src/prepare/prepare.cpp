// The steps of prepare() on one page: how a cloud becomes surface points.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/progress.hpp"
#include "palpate/base/error.hpp"
#include "prepare/assemble.hpp"
#include "prepare/orientation.hpp"
#include "prepare/plane_fits.hpp"
#include "prepare/stopwatch.hpp"
#include "prepare/surfels.hpp"

namespace palpate {
namespace {

using Refinements = std::span<const Refinement>;

// Shares of the time that is over before each stage: means of four real clouds.
constexpr double kBeforeRadii = 0.3;     // measured: 0.13 to 0.45
constexpr double kBeforeFits = 0.55;     // measured: 0.49 to 0.64
constexpr double kBeforeWeights = 0.67;  // measured: 0.6 to 0.7
constexpr double kBeforePoints = 0.98;   // measured: 0.96 to 1

void check_names(const PrepareOptions& options, Refinements refinements) {
  for (const std::string& name : options.without) {
    if (std::ranges::find(refinements, name, &Refinement::name) != refinements.end()) continue;
    std::string names;
    for (const Refinement& one : refinements) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", one.name);
    }
    throw Error(
        fmt::format("preparation without '{}': there is no such refinement; give of these: {}",
                    name, names.empty() ? "none" : names));
  }
}

/// Runs the refinements of a stage, but those that the options leave out. `share`: of the work that
/// is done before them.
void refine(Refinements refinements, Stage stage, Surfels& surfels, double share) {
  detail::tell(surfels.options.progress, share);
  for (const Refinement& one : refinements) {
    if (one.stage != stage || surfels.options.without.contains(one.name)) continue;
    one.refine(surfels);
    detail::tell(surfels.options.progress, share);
  }
}

}  // namespace

Prepared prepare_at_once(const Placed& placed, const PrepareOptions& options,
                         std::span<const Refinement> refinements, Prepared::Report report) {
  check_names(options, refinements);
  Surfels s{.placed = placed, .options = options};
  s.sampling = sample(placed, options, report);

  Stopwatch watch;
  s.radii = choose_radii(s.sampling, options);
  refine(refinements, Stage::radii, s, kBeforeRadii);
  watch.lap(report.seconds_spacing);
  s.graph = neighborhood_graph(s.sampling.grid, s.radii.values);
  s.fits = fit_planes(s.graph, s.sampling, s.radii, options);
  watch.lap(report.seconds_normals);
  s.sums = WeightSums(s.graph, s.radii.values, options.kernel);
  refine(refinements, Stage::fits, s, kBeforeFits);
  s.weights = weigh(s.graph, s.sampling, s.radii, s.sums, options);
  watch.lap(report.seconds_weights);
  refine(refinements, Stage::weights, s, kBeforeWeights);
  if (s.segments.empty()) orient(s.sampling, given_signs(placed, s.sampling, options), s.fits);
  watch.lap(report.seconds_normals);

  s.prepared.report = report;
  s.graph = {};  // its grid moves on
  assemble(s);
  refine(refinements, Stage::points, s, kBeforePoints);
  complete(s.prepared);
  return std::move(s.prepared);
}

}  // namespace palpate
