#include "prepare/close_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "geometry/distance.hpp"
#include "geometry/parallel.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {
namespace {

constexpr float kMultiple = 2.5f;      // R over the gap
constexpr float kFaint = 2.5f;         // sums of weights: 5.8 on a square grid
constexpr float kOpposite = -0.5f;     // cosine between two that lie on opposite sides
constexpr float kFirstReach = 1.5f;    // radii
constexpr int kWidenings = 2;          // of the reach, each twofold: gaps up to three radii
constexpr std::size_t kEnough = 2048;  // points in reach: no sparse place any more

/// The nearest in each of the six cones round the axes.
class Cones {
 public:
  void add(const Eigen::Vector3f& offset) {
    const float distance = offset.norm();
    if (!(distance > 0)) return;
    Eigen::Index axis = 0;
    offset.cwiseAbs().maxCoeff(&axis);
    Nearest& cone = cones_[static_cast<std::size_t>(2 * axis + (offset[axis] > 0 ? 1 : 0))];
    if (distance < cone.distance) cone = {distance, offset / distance};
  }

  /// The further of the nearest two that lie on opposite sides; infinity: there are none, m.
  [[nodiscard]] float gap() const {
    float gap = kNone;
    for (std::size_t a = 0; a < cones_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const float both = std::max(cones_[a].distance, cones_[b].distance);
        if (both < gap && cones_[a].direction.dot(cones_[b].direction) < kOpposite) gap = both;
      }
    }
    return gap;
  }

 private:
  static constexpr float kNone = std::numeric_limits<float>::infinity();
  struct Nearest {
    float distance = kNone;
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();
  };
  std::array<Nearest, 6> cones_;
};

/// The gap that a point lies in; 0 where none is found.
float gap_at(const CellGrid& grid, std::uint32_t i, float radius,
             std::vector<std::uint32_t>& near) {
  const Eigen::Vector3f& p = grid.points()[i];
  float reach = kFirstReach * radius;
  for (int k = 0; k < kWidenings; ++k, reach *= 2) {
    near.clear();
    grid.within(p, reach, near);
    if (near.size() > kEnough) break;
    Cones cones;
    for (const std::uint32_t j : near) cones.add(grid.points()[j] - p);
    // Those in sight only are the nearest of all.
    if (const float gap = cones.gap(); gap <= reach) return gap;
  }
  return 0;
}

}  // namespace

std::size_t close_gaps(const CellGrid& grid, std::span<const float> sums,
                       std::vector<float>& spacings, std::vector<float>& radii, OwnSheets& own) {
  std::vector<std::uint32_t> faint;
  for (std::uint32_t i = 0; i < radii.size(); ++i) {
    if (sums[i] < kFaint) faint.push_back(i);
  }
  std::vector<std::uint8_t> raised(faint.size());
  const std::vector<float> before = radii;
  detail::parallel_ranges(faint.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    SheetFitter fitter;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = faint[k];
      const float wanted = kMultiple * gap_at(grid, i, before[i], near);
      if (!(wanted > before[i])) continue;
      const SheetFit fit = fitter.fit(grid, grid.points()[i], static_cast<double>(wanted),
                                      static_cast<double>(spacings[i]));
      if (!fit.is_sheet(static_cast<double>(wanted), 0)) continue;
      radii[i] = wanted;
      spacings[i] = std::max(spacings[i], wanted / kMultiple);
      own.normals[i] = fit.normal.cast<float>();
      own.confidences[i] = static_cast<float>(fit.planarity);
      own.residuals[i] = static_cast<float>(fit.residual);
      own.bends[i] = static_cast<float>(fit.bend);
      raised[k] = 1;
    }
  });
  return static_cast<std::size_t>(std::ranges::count(raised, 1));
}

}  // namespace palpate
