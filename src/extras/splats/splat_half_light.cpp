// Sends a ray through each point of a shell and adds up what the splats on it hold back.
#include "extras/splats/splat_half_light.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/parallel.hpp"

namespace palpate::detail {
namespace {

constexpr float kThinnest = 1e-3F;  // of a splat's length; flat ones have no thickness (judgement)
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();  // no height (a mark)

// What turns a vector into a splat's sigmas along its axes.
std::vector<Eigen::Matrix3f> frames_of(std::span<const Splat> splats) {
  std::vector<Eigen::Matrix3f> frames(splats.size());
  parallel_each(splats.size(), 4096, [&](std::size_t i) {
    const Eigen::Vector3f& sigma = splats[i].sigma;
    const Eigen::Array3f wide = sigma.array().max(kThinnest * sigma.maxCoeff());
    frames[i] =
        wide.inverse().matrix().asDiagonal() * splats[i].rotation.toRotationMatrix().transpose();
  });
  return frames;
}

// What a ray meets: heights along it and optical depths there.
struct Ray {
  std::vector<std::uint32_t> splats;
  std::vector<std::pair<float, float>> met;
};

// The height at which half of the light is gone that meets these in turn.
template <class Met>
std::optional<float> half_of(Met first, Met last) {
  float depth = 0;
  for (; first != last; ++first) {
    depth += first->second;
    if (depth >= std::numbers::ln2_v<float>) return first->first;
  }
  return std::nullopt;
}

class RayCaster {
 public:
  RayCaster(std::span<const SplatShare> shares, std::span<const Splat> splats,
            const SplatGrid& grid, float reach)
      : shares_(shares), splats_(splats), grid_(grid), reach_(reach), frames_(frames_of(splats)) {}

  [[nodiscard]] float height(const SplatCell& point, Ray& ray) const {
    if (!(point.normal.squaredNorm() > 0.5F)) return kNone;
    find_splats(point, ray.splats);
    ray.met.clear();
    for (const std::uint32_t splat : ray.splats) meet(point, splat, ray.met);
    std::ranges::sort(ray.met, std::greater());
    const auto before = half_of(ray.met.begin(), ray.met.end());
    if (!before) return kNone;
    const auto behind = half_of(ray.met.rbegin(), ray.met.rend());
    return (1 - point.behind) * *before + point.behind * behind.value_or(*before);
  }

 private:
  // Finds the splats near the ray: also a cell aside, as they reach farther than their samples.
  void find_splats(const SplatCell& point, std::vector<std::uint32_t>& found) const {
    found.clear();
    const Eigen::Vector3f u = grid_.edge * point.normal.unitOrthogonal();
    const Eigen::Vector3f v = point.normal.cross(u);
    for (const Eigen::Vector3f& aside :
         {Eigen::Vector3f(0, 0, 0), u, v, Eigen::Vector3f(-u), Eigen::Vector3f(-v)}) {
      for (float at = -reach_; at <= reach_; at += 1) {
        add_splats(point.position + at * grid_.edge * point.normal + aside, found);
      }
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

  // Adds the splats of the cell that is at `p`.
  void add_splats(const Eigen::Vector3f& p, std::vector<std::uint32_t>& found) const {
    const auto key = grid_.key_of(p);
    if (!key) return;
    auto share = std::ranges::lower_bound(shares_, *key, {}, &SplatShare::key);
    for (; share != shares_.end() && share->key == *key; ++share) found.push_back(share->splat);
  }

  void meet(const SplatCell& point, std::uint32_t index,
            std::vector<std::pair<float, float>>& met) const {
    const Splat& splat = splats_[index];
    const Eigen::Vector3f from = frames_[index] * (point.position - splat.position);
    const Eigen::Vector3f along = frames_[index] * point.normal;
    const float square = along.squaredNorm();
    const float height = -from.dot(along) / square;
    const float opacity = std::min(
        splat.opacity * std::exp(from.cross(along).squaredNorm() / square / -2), kMostOpaque);
    if (!(opacity >= kFaintest) || !(std::abs(height) <= reach_ * grid_.edge)) return;
    met.emplace_back(height, -std::log(1 - opacity));
  }

  std::span<const SplatShare> shares_;
  std::span<const Splat> splats_;
  const SplatGrid& grid_;
  float reach_;
  std::vector<Eigen::Matrix3f> frames_;
};

}  // namespace

void find_half_light(std::span<SplatCell> points, std::span<const SplatShare> shares,
                     std::span<const Splat> splats, const SplatGrid& grid, float reach) {
  const RayCaster caster(shares, splats, grid, reach);
  parallel_each_with<Ray>(points.size(), 256, [&](std::size_t i, Ray& ray) {
    points[i].height = caster.height(points[i], ray);
  });
}

}  // namespace palpate::detail
