// Draws positions in a cloud and measures there what is one for all of it.

#include "palpate/prepare/cloud_facts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/cell_builder.hpp"
#include "geometry/inner_box.hpp"
#include "geometry/parallel.hpp"
#include "large/store_sample.hpp"
#include "palpate/geometry/spacing.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kDrawn = 32;  // positions; judgement
constexpr std::size_t kPointsAround =
    4096;                                  // points around each: windows of 20 s fit in; judgement
constexpr std::size_t kRun = 256;          // points that are passed over together; judgement
constexpr std::size_t kSampled = 1 << 17;  // points whose distance is measured; judgement
constexpr std::size_t kOneOutlierOf = 1000;  // points, one an outlier, at either end; judgement

/// How far from a `center` the `share` of the sampled points lie, m^2.
float reach(std::span<const Vector3f> sample, const Vector3f& center, double share) {
  std::vector<float> squares;
  for (const Vector3f& p : sample) squares.push_back((p - center).squaredNorm());
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(squares.size() - 1));
  std::nth_element(squares.begin(), squares.begin() + rank, squares.end());
  return squares[static_cast<std::size_t>(rank)];
}

std::vector<Vector3f> sample_of(const std::vector<Vector3f>& points) {
  const std::size_t step = points.size() / kSampled + 1;
  std::vector<Vector3f> sample;
  for (std::size_t i = step / 2; i < points.size(); i += step) sample.push_back(points[i]);
  return sample;
}

/// The tight box of some points, m.
struct Bounds {
  Vector3f lower;
  Vector3f upper;
};

/// The box of each run of kRun points. Scanners write down together what lies together, so most
/// runs are far from most positions and are passed over whole.
std::vector<Bounds> boxes_of_runs(std::span<const Vector3f> points) {
  std::vector<Bounds> boxes((points.size() + kRun - 1) / kRun);
  detail::parallel_each(boxes.size(), 64, [&](std::size_t r) {
    const auto run = points.subspan(r * kRun, std::min(kRun, points.size() - r * kRun));
    boxes[r] = {run.front(), run.front()};
    for (const Vector3f& p : run) {
      boxes[r] = {boxes[r].lower.cwiseMin(p), boxes[r].upper.cwiseMax(p)};
    }
  });
  return boxes;
}

/// The points around the drawn positions; all of a cloud that has no more.
PointCloud draw(const PointCloud& cloud, const std::vector<Vector3f>& sample) {
  if (cloud.size() <= kDrawn * kPointsAround) return cloud;
  const double share = static_cast<double>(kPointsAround) / static_cast<double>(cloud.size());
  const std::vector<Bounds> boxes = boxes_of_runs(cloud.positions);
  std::vector<std::vector<std::uint32_t>> found(kDrawn);
  detail::parallel_each(kDrawn, 1, [&](std::size_t k) {
    const Vector3f& center = sample[(2 * k + 1) * sample.size() / (2 * kDrawn)];
    const float squared = reach(sample, center, share);
    for (std::size_t r = 0; r < boxes.size(); ++r) {
      const Vector3f nearest = center.cwiseMax(boxes[r].lower).cwiseMin(boxes[r].upper);
      if ((center - nearest).squaredNorm() > squared) continue;
      const std::size_t end = std::min(cloud.size(), (r + 1) * kRun);
      for (std::size_t i = r * kRun; i < end; ++i) {
        if ((cloud.positions[i] - center).squaredNorm() > squared) continue;
        found[k].push_back(static_cast<std::uint32_t>(i));
      }
    }
  });
  std::vector<std::uint32_t> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return select(cloud, all);
}

Box extent_of(const PointCloud& cloud, const std::vector<Vector3f>& sample) {
  const Box box = detail::inner_box(sample, sample.size() / kOneOutlierOf);
  return {cloud.origin + box.lower, cloud.origin + box.upper};
}

}  // namespace

namespace {

/// `alone`: options without facts. `sample`: points of all of the cloud, in the frame of `drawn`.
CloudFacts facts_of(const Placed& drawn, const PrepareOptions& alone,
                    const std::vector<Vector3f>& sample_points) {
  Prepared::Report report;
  Sampling sampling = sample(drawn, alone, report);
  sampling.facts.extent = extent_of(drawn.cloud(), sample_points);
  sampling.facts.radius = median(choose_radii(sampling, alone).values);
  return sampling.facts;
}

PrepareOptions without_facts(PrepareOptions options) {
  options.facts.reset();
  return options;
}

}  // namespace

CloudFacts measure_facts(const PointCloud& cloud, const PrepareOptions& options,
                         const Eigen::Isometry3d& T_world_sensor) {
  const Placed placed = place(cloud, options, T_world_sensor);
  detail::require_finite(placed.cloud().positions);
  const std::vector<Vector3f> sample_points = sample_of(placed.cloud().positions);
  const PointCloud drawn = draw(placed.cloud(), sample_points);
  return facts_of({drawn, {}, placed.viewpoint}, without_facts(options), sample_points);
}

CloudFacts measure_facts(const StoreSample& sample, const PrepareOptions& options,
                         const Eigen::Isometry3d& T_world_sensor) {
  PrepareOptions whole = without_facts(options);
  whole.clip.reset();
  const Placed all = place(sample.all, whole, T_world_sensor);
  const Placed drawn = place(sample.around, whole, T_world_sensor);
  detail::require_finite(all.cloud().positions);
  detail::require_finite(drawn.cloud().positions);
  return facts_of(drawn, whole, all.cloud().positions);
}

CloudFacts measure_facts(const PointStore& store, const PrepareOptions& options,
                         const Eigen::Isometry3d& T_world_sensor) {
  return measure_facts(sample_of(store), options, T_world_sensor);
}

}  // namespace palpate
