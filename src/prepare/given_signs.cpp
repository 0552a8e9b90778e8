#include "prepare/given_signs.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/distance.hpp"
#include "geometry/parallel.hpp"
#include "palpate/field/kernel.hpp"
#include "palpate/geometry/orientation.hpp"

namespace palpate {
namespace {

constexpr std::size_t kChunk = 1024;

bool is_given(const Eigen::Vector3f& normal) {
  return normal.allFinite() && normal.squaredNorm() > 0;
}

/// Takes signs over from neighbours, round by round.
class Spread {
 public:
  Spread(const CellGrid& grid, std::span<const float> radii, std::span<Eigen::Vector3f> normals,
         std::vector<std::uint8_t> known)
      : grid_(grid), radii_(radii), normals_(normals), known_(std::move(known)) {
    for (std::uint32_t i = 0; i < known_.size(); ++i) {
      if (known_[i] == 0) open_.push_back(i);
    }
  }

  void run() {
    while (!open_.empty()) {
      const std::vector<float> votes = count_votes();
      if (!apply(votes)) break;
    }
  }

 private:
  [[nodiscard]] std::vector<float> count_votes() const {
    std::vector<float> votes(open_.size());
    detail::parallel_ranges(open_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> near;
      for (std::size_t k = begin; k < end; ++k) votes[k] = vote_on(open_[k], near);
    });
    return votes;
  }

  /// Above 0: the neighbours are on its side.
  [[nodiscard]] float vote_on(std::uint32_t i, std::vector<std::uint32_t>& near) const {
    const Eigen::Vector3f& p = grid_.points()[i];
    near.clear();
    grid_.within(p, radii_[i], near);
    float vote = 0;
    for (const std::uint32_t j : near) {
      if (known_[j] == 0) continue;
      const float squared = detail::squared_distance(grid_.points()[j], p);
      const double weight = wyvill(static_cast<double>(squared / (radii_[i] * radii_[i]))).w;
      vote += static_cast<float>(weight) * normals_[j].dot(normals_[i]);
    }
    return vote;
  }

  /// False: nobody voted.
  bool apply(const std::vector<float>& votes) {
    std::vector<std::uint32_t> still;
    for (std::size_t k = 0; k < open_.size(); ++k) {
      const std::uint32_t i = open_[k];
      if (votes[k] == 0) {
        still.push_back(i);
        continue;
      }
      if (votes[k] < 0) normals_[i] = -normals_[i];
      known_[i] = 1;
    }
    const bool progress = still.size() < open_.size();
    open_ = std::move(still);
    return progress;
  }

  const CellGrid& grid_;
  std::span<const float> radii_;
  std::span<Eigen::Vector3f> normals_;
  std::vector<std::uint8_t> known_;
  std::vector<std::uint32_t> open_;
};

}  // namespace

double share_given(std::span<const Eigen::Vector3f> given) {
  if (given.empty()) return 0;
  return static_cast<double>(std::ranges::count_if(given, is_given)) /
         static_cast<double>(given.size());
}

void orient_as_given(const CellGrid& grid, std::span<const Eigen::Vector3f> given,
                     std::span<const float> spacings, std::span<const float> radii,
                     std::span<Eigen::Vector3f> normals) {
  std::vector<std::uint8_t> known(given.size());
  std::transform(given.begin(), given.end(), known.begin(),
                 [](const Eigen::Vector3f& n) { return is_given(n) ? 1 : 0; });
  const bool complete = std::ranges::count(known, 0) == 0;
  if (!complete) orient_outward(grid, spacings, normals);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (known[i] != 0 && given[i].dot(normals[i]) < 0) normals[i] = -normals[i];
  }
  if (!complete) Spread(grid, radii, normals, std::move(known)).run();
}

}  // namespace palpate
