// Prepares a cloud with all refinements: at once, or in blocks if it is a large one.

#include <utility>

#include "base/progress.hpp"
#include "large/blocks.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"
#include "prepare/stopwatch.hpp"
#include "prepare/surfels.hpp"
#include "refine/refinements.hpp"

namespace palpate {
namespace {

// Shares of the time that is over before blocks are prepared, and after that.
constexpr double kDivided = 0.02;   // measured on a survey of 10 million points
constexpr double kPrepared = 0.87;  // measured there

}  // namespace

Prepared prepare(const PointCloud& cloud, const PrepareOptions& options,
                 const Eigen::Isometry3d& T_world_sensor) {
  Stopwatch placing;
  const Placed placed = place(cloud, options, T_world_sensor);
  Prepared::Report report{.points_in = cloud.size()};
  placing.lap(report.seconds_filter);
  if (!goes_by_blocks(placed.cloud().size(), options))
    return prepare_at_once(placed, options, refinements(), report);
  const Blocks blocks(placed, options);
  detail::tell(options.progress, kDivided);
  std::vector<Piece> pieces =
      blocks.prepare_all(detail::part(options.progress, kDivided, kPrepared));
  Prepared prepared =
      join(std::move(pieces), blocks.facts(), placed.cloud().origin, options.kernel);
  prepared.report.points_in = report.points_in;
  prepared.report.seconds_filter += report.seconds_filter;
  return prepared;
}

}  // namespace palpate
