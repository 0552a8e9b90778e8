#include "geometry/votes.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "geometry/distance.hpp"
#include "geometry/neighborhoods.hpp"

namespace palpate::detail {
namespace {

constexpr std::size_t kLate = 8;  // votes looked back at

/// The votes of one block.
class Ballot {
 public:
  Ballot(const PatchInput& input, const Patches& patches) : input_(input), patches_(patches) {}

  /// Adds what the points [first, first + count) say about points of other patches.
  void take(std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
    keep_others(first, count, runs);
    if (others_.empty()) return;
    const simd::Join join = make_join(input_.grid, first, count, others_);
    simd::Row squared_reach = {};
    for (std::uint32_t q = 0; q < count; ++q) squared_reach[q] = squared_reach_of(first + q);
    const std::size_t found = simd::best_joins().within(join, squared_reach, hits_.data());
    for (std::size_t h = 0; h < found; ++h) {
      const simd::Hit& hit = hits_[h];
      for (std::uint32_t queries = hit.queries; queries != 0; queries &= queries - 1) {
        vote(first + static_cast<std::uint32_t>(std::countr_zero(queries)), hit.candidate);
      }
    }
  }

  /// All votes so far; none are left.
  std::vector<Vote> hand_over() { return std::exchange(votes_, {}); }

 private:
  [[nodiscard]] float squared_reach_of(std::uint32_t i) const {
    const float reach = kVoteReach * input_.spacings[i];
    return reach * reach;
  }

  // The points of one patch round the given ones; none if these are of several.
  [[nodiscard]] simd::Run patch_around(std::uint32_t first, std::uint32_t last) const {
    const std::vector<std::uint32_t>& patch = patches_.patch;
    for (std::uint32_t i = first + 1; i < last; ++i) {
      if (patch[i] != patch[first]) return {last, last};
    }
    while (first > 0 && patch[first - 1] == patch[first]) --first;
    while (last < patch.size() && patch[last] == patch[first]) ++last;
    return {first, last};
  }

  // What of the runs is not surely of the points' own patch.
  void keep_others(std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
    if (first >= own_.end || first + count > own_.end) own_ = patch_around(first, first + count);
    others_.clear();
    std::size_t candidates = 0;
    const auto keep = [&](std::uint32_t begin, std::uint32_t end) {
      if (begin >= end) return;
      others_.push_back({begin, end});
      candidates += end - begin;
    };
    for (const simd::Run& run : runs) {
      keep(run.begin, std::min(run.end, own_.begin));
      keep(std::max(run.begin, own_.end), run.end);
    }
    if (hits_.size() <= candidates) hits_.resize(2 * candidates + 1);
  }

  // j is within reach of i. Each pair votes once.
  void vote(std::uint32_t i, std::uint32_t j) {
    const std::uint32_t own = patches_.patch[i];
    const std::uint32_t other = patches_.patch[j];
    if (other == own) return;
    const float squared = squared_distance(input_.grid.points()[i], input_.grid.points()[j]);
    if (j < i && squared <= squared_reach_of(j)) return;
    const float near = 1 - squared / squared_reach_of(i);
    const float signs = patches_.sign[i] * patches_.sign[j];
    add({std::min(own, other), std::max(own, other), input_.agreement_of(i, j) * near * signs});
  }

  // Adds to a vote of late on the same two patches, or appends. Those that are missed are added up
  // later.
  void add(const Vote& vote) {
    const std::size_t oldest = votes_.size() > kLate ? votes_.size() - kLate : 0;
    for (std::size_t k = votes_.size(); k-- > oldest;) {
      if (votes_[k].a == vote.a && votes_[k].b == vote.b) {
        votes_[k].value += vote.value;
        return;
      }
    }
    votes_.push_back(vote);
  }

  const PatchInput& input_;
  const Patches& patches_;
  simd::Run own_{0, 0};
  std::vector<simd::Run> others_;
  std::vector<simd::Hit> hits_;
  std::vector<Vote> votes_;
};

}  // namespace

std::vector<Vote> collect_votes(const PatchInput& input, const Patches& patches) {
  const Reach reach{.of_points = input.spacings, .times = kVoteReach, .of_cells = {}};
  const std::vector<Block> blocks = make_blocks(input.grid, kBlockPoints);
  std::vector<std::vector<Vote>> votes(blocks.size());
  parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    Surroundings surroundings;
    Ballot ballot(input, patches);
    for (std::size_t b = begin; b < end; ++b) {
      for_each_part(input.grid, reach, blocks[b], surroundings,
                    [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
                      ballot.take(first, count, runs);
                    });
      votes[b] = ballot.hand_over();
    }
  });
  std::size_t count = 0;
  for (const auto& list : votes) count += list.size();
  std::vector<Vote> all;
  all.reserve(count);
  for (const auto& list : votes) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace palpate::detail
