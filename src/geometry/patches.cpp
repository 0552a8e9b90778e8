#include "geometry/patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/distance.hpp"
#include "geometry/neighborhoods.hpp"

namespace palpate::detail {
namespace {

constexpr float kSure = 0.7f;         // agreement that makes one patch of two points
constexpr std::size_t kLate = 8;      // votes looked back at
constexpr float kReach = 1.6f;        // spacings within which neighbours vote
constexpr std::uint32_t kBlock = 32;  // points that are divided at once

struct Input {
  const CellGrid& grid;
  std::span<const float> spacings;
  std::span<const Eigen::Vector3f> normals;

  [[nodiscard]] float agreement_of(std::uint32_t i, std::uint32_t j) const {
    return agreement(grid.points()[i], normals[i], grid.points()[j], normals[j]);
  }
};

// Spanning trees of the block's points, from the surest neighbour to the next (Prim). Patches are
// numbered within the block; returns how many there are.
std::uint32_t divide(const Input& input, const Block& block, Patches& patches) {
  std::array<float, kBlock> best{};  // agreement with the tree; signed; 0: not connected
  std::array<bool, kBlock> done{};
  std::uint32_t count = 0;
  for (std::uint32_t step = 0; step < block.size(); ++step) {
    std::uint32_t next = block.size();
    for (std::uint32_t k = 0; k < block.size(); ++k) {
      if (done[k]) continue;
      if (next == block.size() || std::abs(best[k]) > std::abs(best[next])) next = k;
    }
    const std::uint32_t i = block.begin + next;
    const bool joins = std::abs(best[next]) >= kSure;
    if (!joins) {
      ++count;
      best.fill(0);
    }
    done[next] = true;
    patches.patch[i] = count - 1;
    patches.sign[i] = joins && best[next] < 0 ? -1.f : 1.f;
    for (std::uint32_t k = 0; k < block.size(); ++k) {
      if (done[k]) continue;
      const std::uint32_t j = block.begin + k;
      const float near = kReach * std::max(input.spacings[i], input.spacings[j]);
      if (squared_distance(input.grid.points()[i], input.grid.points()[j]) > near * near) continue;
      const float value = patches.sign[i] * input.agreement_of(i, j);
      if (std::abs(value) > std::abs(best[k])) best[k] = value;
    }
  }
  return count;
}

// Adds to a vote of late on the same two patches, or appends. Those that are missed are added up
// later; from `mine` on they are this part's, whatever thread works on it.
void add(const Vote& vote, std::size_t mine, std::vector<Vote>& votes) {
  const std::size_t oldest = votes.size() > mine + kLate ? votes.size() - kLate : mine;
  for (std::size_t k = votes.size(); k-- > oldest;) {
    if (votes[k].a == vote.a && votes[k].b == vote.b) {
      votes[k].value += vote.value;
      return;
    }
  }
  votes.push_back(vote);
}

// Adds what point i says about its neighbours in other patches to `votes`, from `mine` on.
void vote(const Input& input, const Patches& patches, std::uint32_t i,
          std::span<const simd::Run> runs, std::size_t mine, std::vector<Vote>& votes) {
  const Eigen::Vector3f& p = input.grid.points()[i];
  const float reach = kReach * input.spacings[i];
  const std::uint32_t own = patches.patch[i];
  for (const simd::Run& run : runs) {
    for (std::uint32_t j = run.begin; j < run.end; ++j) {
      const std::uint32_t other = patches.patch[j];
      if (other == own) continue;
      const float squared = squared_distance(p, input.grid.points()[j]);
      if (squared > reach * reach) continue;
      const float reach_of_other = kReach * input.spacings[j];
      if (j < i && squared <= reach_of_other * reach_of_other) continue;  // j has said so
      const float near = 1 - squared / (reach * reach);
      const float value = input.agreement_of(i, j) * near * patches.sign[i] * patches.sign[j];
      add({std::min(own, other), std::max(own, other), value}, mine, votes);
    }
  }
}

// What all points say, in their order.
std::vector<Vote> collect_votes(const Input& input, const Patches& patches) {
  std::vector<float> reach(input.spacings.begin(), input.spacings.end());
  for (float& r : reach) r *= kReach;
  const std::vector<Block> blocks = make_blocks(input.grid, kBlockPoints);
  std::vector<std::vector<Vote>> votes(blocks.size());
  parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    Surroundings surroundings;
    for (std::size_t b = begin; b < end; ++b) {
      for_each_part(input.grid, {.of_points = reach, .of_cells = {}}, blocks[b], surroundings,
                    [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
                      const std::size_t mine = votes[b].size();
                      for (std::uint32_t i = first; i < first + count; ++i) {
                        vote(input, patches, i, runs, mine, votes[b]);
                      }
                    });
    }
  });
  std::vector<Vote> all;
  for (const auto& list : votes) all.insert(all.end(), list.begin(), list.end());
  return all;
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
  const std::vector<Block> blocks = make_blocks(grid, kBlock);
  std::vector<std::uint32_t> first(blocks.size() + 1, 0);
  parallel_ranges(blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) first[b + 1] = divide(input, blocks[b], patches);
  });
  for (std::size_t b = 0; b < blocks.size(); ++b) first[b + 1] += first[b];
  patches.count = first.back();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::uint32_t i = blocks[b].begin; i < blocks[b].end; ++i) patches.patch[i] += first[b];
  }
  patches.votes = collect_votes(input, patches);
  return patches;
}

}  // namespace palpate::detail
