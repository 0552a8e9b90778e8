#include "geometry/patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/distance.hpp"
#include "geometry/neighborhoods.hpp"

namespace palpate::detail {
namespace {

constexpr float kSure = 0.7f;              // agreement that makes one patch of two points
constexpr std::uint32_t kPatchBlock = 32;  // points that are divided at once
constexpr float kParallel = 0.9f;          // cosine between the normals of one sheet
constexpr float kThin = 0.5f;              // spacings that a sheet's points may be off its plane

// Do all points of `next` lie on the plane of the sheet's first point, and are their normals its
// own or opposite to it? Then no spanning tree is needed to know their signs.
bool continues(const PatchInput& input, const Block& sheet, const Block& next) {
  const Eigen::Vector3f& p = input.grid.points()[sheet.begin];
  const Eigen::Vector3f& n = input.normals[sheet.begin];
  const float thickness = kThin * input.spacings[sheet.begin];
  for (std::uint32_t i = next.begin; i < next.end; ++i) {
    if (!(std::abs(n.dot(input.normals[i])) >= kParallel)) return false;
    if (!(std::abs(n.dot(input.grid.points()[i] - p)) <= thickness)) return false;
  }
  return true;
}

void make_patch(const PatchInput& input, const Block& sheet, const Block& block,
                std::uint32_t number, Patches& patches) {
  const Eigen::Vector3f& n = input.normals[sheet.begin];
  for (std::uint32_t i = block.begin; i < block.end; ++i) {
    patches.patch[i] = number;
    patches.sign[i] = n.dot(input.normals[i]) < 0 ? -1.f : 1.f;
  }
}

// Spanning trees of the block's points, from the surest neighbour to the next (Prim). Patches are
// numbered from `count` on; returns the number after the last.
std::uint32_t divide(const PatchInput& input, const Block& block, std::uint32_t count,
                     Patches& patches) {
  std::array<float, kPatchBlock> best{};  // agreement with the tree; signed; 0: not connected
  std::array<bool, kPatchBlock> done{};
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
      const float near = kVoteReach * std::max(input.spacings[i], input.spacings[j]);
      if (squared_distance(input.grid.points()[i], input.grid.points()[j]) > near * near) continue;
      const float value = patches.sign[i] * input.agreement_of(i, j);
      if (std::abs(value) > std::abs(best[k])) best[k] = value;
    }
  }
  return count;
}

// Makes patches of neighbouring blocks, numbered from 0; returns how many there are. As much as
// continues the last sheet is one patch with it.
std::uint32_t divide(const PatchInput& input, std::span<const Block> blocks, Patches& patches) {
  Block sheet;
  std::uint32_t count = 0;
  for (const Block& block : blocks) {
    if (sheet.size() == 0 || !continues(input, sheet, block)) {
      sheet = continues(input, block, block) ? block : Block{};
      if (sheet.size() > 0) ++count;
    }
    if (sheet.size() > 0) {
      make_patch(input, sheet, block, count - 1, patches);
    } else {
      count = divide(input, block, count, patches);
    }
  }
  return count;
}

// Where groups of blocks with at most kBlockPoints points begin, and the number of blocks.
std::vector<std::size_t> groups_of(std::span<const Block> blocks) {
  std::vector<std::size_t> groups;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (groups.empty() || blocks[b].end - blocks[groups.back()].begin > kBlockPoints) {
      groups.push_back(b);
    }
  }
  groups.push_back(blocks.size());
  return groups;
}

}  // namespace

Patches make_patches(const PatchInput& input) {
  Patches patches;
  patches.patch.resize(input.grid.size());
  patches.sign.resize(input.grid.size());
  const std::vector<Block> blocks = make_blocks(input.grid, kPatchBlock);
  const std::vector<std::size_t> groups = groups_of(blocks);
  std::vector<std::uint32_t> first(groups.size(), 0);
  const auto group = [&](std::size_t g) {
    return std::span(blocks).subspan(groups[g], groups[g + 1] - groups[g]);
  };
  parallel_ranges(groups.size() - 1, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) first[g + 1] = divide(input, group(g), patches);
  });
  for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
    for (const Block& block : group(g)) {
      for (std::uint32_t i = block.begin; i < block.end; ++i) patches.patch[i] += first[g];
    }
    first[g + 1] += first[g];
  }
  patches.count = first.back();
  return patches;
}

}  // namespace palpate::detail
