// prepare() on one page: how a cloud becomes surface points.

#include "palpate/prepare/prepare.hpp"

#include <utility>

#include "large/blocks.hpp"
#include "prepare/assemble.hpp"
#include "prepare/at_once.hpp"
#include "prepare/place.hpp"
#include "prepare/plane_fits.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/stopwatch.hpp"
#include "prepare/weights.hpp"
#include "refine/gaps.hpp"
#include "refine/sheets.hpp"
#include "refine/strays.hpp"

namespace palpate {

Prepared prepare_at_once(const Placed& placed, const PrepareOptions& options,
                         Prepared::Report report) {
  Sampling sampling = sample(placed, options, report);

  Stopwatch watch;
  Radii radii = choose_radii(sampling, options);
  watch.lap(report.seconds_spacing);
  PointFits fits = fit_planes(sampling, radii, options);
  watch.lap(report.seconds_normals);
  const WeightSums sums = close_gaps(options, sampling, radii, fits);
  Weights weights = weigh(sampling, radii, sums, options);
  watch.lap(report.seconds_weights);
  const KnownSigns known = given_signs(placed, sampling, options);
  JoinedSheets joined = join_sheets(sampling, radii, weights, known, fits);
  if (!radii.strays.empty()) drop_strays_off_sheets(sampling, joined, weights);
  watch.lap(report.seconds_normals);

  return assemble(std::move(sampling), std::move(radii), std::move(fits), std::move(weights),
                  std::move(joined), options, report);
}

Prepared prepare(const PointCloud& cloud, const PrepareOptions& options,
                 const Eigen::Isometry3d& T_world_sensor) {
  Stopwatch placing;
  const Placed placed = place(cloud, options, T_world_sensor);
  Prepared::Report report{.points_in = cloud.size()};
  placing.lap(report.seconds_filter);
  if (!goes_by_blocks(placed.cloud().size(), options))
    return prepare_at_once(placed, options, report);
  const Blocks blocks(placed, options);
  Prepared prepared =
      join(blocks.prepare_all(), blocks.facts(), placed.cloud().origin, options.kernel);
  prepared.report.points_in = report.points_in;
  prepared.report.seconds_filter += report.seconds_filter;
  return prepared;
}

}  // namespace palpate
