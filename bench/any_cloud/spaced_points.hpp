#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace palpate::any_cloud {

/// Points of which no two are nearer than 0.8 spacings, found by the unit cells that they lie in.
class SpacedPoints {
 public:
  bool add(const Eigen::Vector3d& point) {
    const Eigen::Vector3i cell = point.array().floor().cast<int>();
    for (int i = 0; i < 27; ++i) {
      const auto found = cells_.find(key(cell + offset(i)));
      if (found == cells_.end()) continue;
      for (const Eigen::Vector3d& other : found->second) {
        if ((other - point).squaredNorm() < kLeastAway * kLeastAway) return false;
      }
    }
    cells_[key(cell)].push_back(point);
    return true;
  }

 private:
  static constexpr double kLeastAway = 0.8;

  // The cell itself first: most points are refused by what lies nearest.
  static Eigen::Vector3i offset(int i) {
    const int k = (i + 13) % 27;
    return {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
  }
  static std::int64_t key(const Eigen::Vector3i& cell) {
    constexpr std::int64_t kSide = 1 << 20;
    return (cell.x() * kSide + cell.y()) * kSide + cell.z();
  }
  std::unordered_map<std::int64_t, std::vector<Eigen::Vector3d>> cells_;
};

}  // namespace palpate::any_cloud
