#include "palpate/geometry/orientation.hpp"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "geometry/parallel.hpp"
#include "geometry/patches.hpp"
#include "geometry/votes.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

constexpr double kOpen = 0.3;     // |sum a n| / sum a above which a part does not close
constexpr double kUpright = 0.2;  // sine of the lean that makes an open part have an upper side

// Sums over the points of one part.
struct PartSums {
  double area = 0;                                   // m^2
  double flux = 0;                                   // sum a n.p, m^3
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();  // sum a n, m^2
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // sum a p, m^3
};

// Must the part's normals be turned round?
bool is_inside_out(const PartSums& part, const Eigen::Vector3d& center_of_all) {
  if (!(part.area > 0)) return false;
  const Eigen::Vector3d center = part.moment / part.area;
  if (part.vector.norm() <= kOpen * part.area) return part.flux - center.dot(part.vector) < 0;
  if (std::abs(part.vector.z()) > kUpright * part.vector.norm()) return part.vector.z() < 0;
  return part.vector.dot(center - center_of_all) < 0;
}

void check(std::size_t points, std::size_t normals, std::size_t spacings) {
  if (normals == points && spacings == points) return;
  throw Error(fmt::format("orientation: {} normals and {} spacings for {} points; give one each",
                          normals, spacings, points));
}

}  // namespace

void orient_to_viewpoint(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& viewpoint,
                         std::span<Eigen::Vector3f> normals) {
  check(points.size(), normals.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (normals[i].dot(viewpoint - points[i]) < 0) normals[i] = -normals[i];
  }
}

void orient_outward(const CellGrid& grid, std::span<const float> spacings,
                    std::span<Eigen::Vector3f> normals) {
  check(grid.size(), normals.size(), spacings.size());
  const detail::PatchInput input{grid, spacings, normals};
  const detail::Patches patches = detail::make_patches(input);
  const detail::SignedParts parts =
      detail::merge_by_votes(patches.count, detail::collect_votes(input, patches));
  std::vector<PartSums> sums(parts.count);
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double area_of_all = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const std::uint32_t patch = patches.patch[i];
    normals[i] *= patches.sign[i] * parts.sign[patch];
    const Eigen::Vector3d p = grid.points()[i].cast<double>();
    const Eigen::Vector3d n = normals[i].cast<double>();
    const double area = static_cast<double>(spacings[i]) * static_cast<double>(spacings[i]);
    PartSums& part = sums[parts.part[patch]];
    part.area += area;
    part.flux += area * n.dot(p);
    part.vector += area * n;
    part.moment += area * p;
    moment += area * p;
    area_of_all += area;
  }
  const Eigen::Vector3d center = area_of_all > 0 ? Eigen::Vector3d(moment / area_of_all) : moment;
  std::vector<float> turn(parts.count);
  for (std::size_t k = 0; k < sums.size(); ++k) turn[k] = is_inside_out(sums[k], center) ? -1 : 1;
  detail::parallel_ranges(normals.size(), std::size_t{1} << 16, [&](auto begin, auto end) {
    for (std::size_t i = begin; i < end; ++i) normals[i] *= turn[parts.part[patches.patch[i]]];
  });
}

void orient_outward(const CellGrid& grid, std::span<Eigen::Vector3f> normals) {
  orient_outward(grid, local_spacings(grid), normals);
}

}  // namespace palpate
