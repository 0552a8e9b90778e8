// The steps of prepare() on one page: how a cloud becomes surface points.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "palpate/base/error.hpp"
#include "prepare/assemble.hpp"
#include "prepare/orientation.hpp"
#include "prepare/plane_fits.hpp"
#include "prepare/stopwatch.hpp"
#include "prepare/surfels.hpp"

namespace palpate {
namespace {

using Refinements = std::span<const Refinement>;

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

void stop_if(const std::stop_token& stop) {
  if (stop.stop_requested()) throw PreparationStopped{};
}

/// Runs the refinements of a stage, but those that the options leave out.
void refine(Refinements refinements, Stage stage, Surfels& surfels, const std::stop_token& stop) {
  stop_if(stop);
  for (const Refinement& one : refinements) {
    if (one.stage != stage || surfels.options.without.contains(one.name)) continue;
    one.refine(surfels);
    stop_if(stop);
  }
}

}  // namespace

Prepared prepare_at_once(const Placed& placed, const PrepareOptions& options,
                         std::span<const Refinement> refinements, Prepared::Report report,
                         const std::stop_token& stop) {
  check_names(options, refinements);
  Surfels s{.placed = placed, .options = options};
  s.sampling = sample(placed, options, report);

  Stopwatch watch;
  s.radii = choose_radii(s.sampling, options);
  refine(refinements, Stage::radii, s, stop);
  watch.lap(report.seconds_spacing);
  s.graph = neighborhood_graph(s.sampling.grid, s.radii.values);
  s.fits = fit_planes(s.graph, s.sampling, s.radii, options);
  watch.lap(report.seconds_normals);
  s.sums = WeightSums(s.graph, s.radii.values, options.kernel);
  refine(refinements, Stage::fits, s, stop);
  s.weights = weigh(s.graph, s.sampling, s.radii, s.sums, options);
  watch.lap(report.seconds_weights);
  refine(refinements, Stage::weights, s, stop);
  if (s.segments.empty()) orient(s.sampling, given_signs(placed, s.sampling, options), s.fits);
  watch.lap(report.seconds_normals);

  s.prepared.report = report;
  s.graph = {};  // its grid moves on
  assemble(s);
  refine(refinements, Stage::points, s, stop);
  complete(s.prepared);
  return std::move(s.prepared);
}

}  // namespace palpate
