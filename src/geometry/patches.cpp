#include "geometry/patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/distance.hpp"
#include "geometry/neighborhoods.hpp"

namespace palpate::detail {
namespace {

constexpr float kSure = 0.7f;  // agreement that makes one patch of two points
constexpr float kReach = 2;    // spacings within which neighbours vote
constexpr std::size_t kMaxCandidates = 4096;

struct Input {
  const CellGrid& grid;
  std::span<const float> spacings;
  std::span<const Eigen::Vector3f> normals;

  [[nodiscard]] float agreement_of(std::uint32_t i, std::uint32_t j) const {
    return agreement(grid.points()[i], normals[i], grid.points()[j], normals[j]);
  }
};

// Spanning trees of the group's points, from the surest neighbour to the next (Prim). Patches are
// numbered within the group; returns how many there are.
std::uint32_t divide(const Input& input, const Group& group, Patches& patches) {
  std::array<float, kGroupPoints> best{};  // agreement with the tree; signed; 0: not connected
  std::array<bool, kGroupPoints> done{};
  std::uint32_t count = 0;
  for (std::uint32_t step = 0; step < group.size(); ++step) {
    std::uint32_t next = group.size();
    for (std::uint32_t k = 0; k < group.size(); ++k) {
      if (done[k]) continue;
      if (next == group.size() || std::abs(best[k]) > std::abs(best[next])) next = k;
    }
    const std::uint32_t i = group.begin + next;
    const bool joins = std::abs(best[next]) >= kSure;
    if (!joins) {
      ++count;
      best.fill(0);
    }
    done[next] = true;
    patches.patch[i] = count - 1;
    patches.sign[i] = joins && best[next] < 0 ? -1.f : 1.f;
    for (std::uint32_t k = 0; k < group.size(); ++k) {
      if (done[k]) continue;
      const std::uint32_t j = group.begin + k;
      const float near = kReach * std::max(input.spacings[i], input.spacings[j]);
      if (squared_distance(input.grid.points()[i], input.grid.points()[j]) > near * near) continue;
      const float value = patches.sign[i] * input.agreement_of(i, j);
      if (std::abs(value) > std::abs(best[k])) best[k] = value;
    }
  }
  return count;
}

// Adds what point i says about its neighbours in other patches to `votes`.
void vote(const Input& input, const Patches& patches, std::uint32_t i, const Columns& candidates,
          std::vector<Vote>& votes) {
  const Eigen::Vector3f& p = input.grid.points()[i];
  const float reach = kReach * input.spacings[i];
  const std::uint32_t own = patches.patch[i];
  for (const std::uint32_t j : candidates.indices()) {
    const std::uint32_t other = patches.patch[j];
    if (other == own) continue;
    const float squared = squared_distance(p, input.grid.points()[j]);
    if (squared > reach * reach) continue;
    const float near = 1 - squared / (reach * reach);
    const float value = input.agreement_of(i, j) * near * patches.sign[i] * patches.sign[j];
    const auto known = std::find_if(votes.begin(), votes.end(),
                                    [&](const Vote& v) { return v.a == own && v.b == other; });
    if (known != votes.end()) {
      known->value += value;
    } else {
      votes.push_back({own, other, value});
    }
  }
}

}  // namespace

float agreement(const Eigen::Vector3f& p, const Eigen::Vector3f& n_p, const Eigen::Vector3f& q,
                const Eigen::Vector3f& n_q) {
  const Eigen::Vector3f d = q - p;
  const float squared = d.squaredNorm();
  const float straight = n_p.dot(n_q);
  return squared > 0 ? straight - 2 * n_p.dot(d) * n_q.dot(d) / squared : straight;
}

Patches make_patches(const CellGrid& grid, std::span<const float> spacings,
                     std::span<const Eigen::Vector3f> normals) {
  const Input input{grid, spacings, normals};
  Patches patches;
  patches.patch.resize(grid.size());
  patches.sign.resize(grid.size());
  const std::vector<Group> groups = make_groups(grid);
  std::vector<std::uint32_t> first(groups.size() + 1, 0);
  parallel_ranges(groups.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) first[g + 1] = divide(input, groups[g], patches);
  });
  for (std::size_t g = 0; g < groups.size(); ++g) first[g + 1] += first[g];
  patches.count = first.back();
  parallel_ranges(groups.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      for (std::uint32_t i = groups[g].begin; i < groups[g].end; ++i) patches.patch[i] += first[g];
    }
  });
  std::vector<std::vector<Vote>> votes((groups.size() + 63) / 64);
  parallel_ranges(votes.size(), 1, [&](std::size_t begin, std::size_t end) {
    Columns candidates;
    std::vector<Vote> of_group;
    for (std::size_t g = 64 * begin; g < std::min(64 * end, groups.size()); ++g) {
      const auto own = spacings.subspan(groups[g].begin, groups[g].size());
      const float reach = kReach * *std::max_element(own.begin(), own.end());
      if (!gather(grid, groups[g], reach, candidates, kMaxCandidates)) continue;
      of_group.clear();
      for (std::uint32_t i = groups[g].begin; i < groups[g].end; ++i) {
        vote(input, patches, i, candidates, of_group);
      }
      auto& list = votes[g / 64];
      list.insert(list.end(), of_group.begin(), of_group.end());
    }
  });
  for (const auto& list : votes) {
    patches.votes.insert(patches.votes.end(), list.begin(), list.end());
  }
  return patches;
}

}  // namespace palpate::detail
