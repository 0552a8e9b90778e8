// Ranks the blocks of a cloud by how near tools are.
#include "large/block_choice.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace palpate {
namespace {

using State = CloudBlock::State;

// Points of a surface that is not whole: joining them takes a tenth of a second; judgement.
constexpr std::size_t kMostShown = std::size_t{1} << 19;
// Boxes that a servo looks through, 1.4 us a step (measured). A tool gets no others: so many are
// the blocks of about a hundred million points of a surface.
constexpr std::size_t kMostMissing = 1024;
// Share of the work that is done with the blocks where all is prepared together after them: of the
// Stanford dragon a run without them takes 2.3 s of processor time, with them 4.6.
constexpr double kOfBlocks = 0.5;

/// Ranks a block where there is no room for all: first what tools can reach, then what is near.
/// What is shown already comes before others of its kind, or a hand's path would change what is
/// shown all the time.
int rank(const CloudBlock& block, double near) {
  if (block.distance <= 0) return 0;
  return (block.distance <= near ? 1 : 3) + (block.state == State::shown ? 0 : 1);
}

}  // namespace

double BlocksAround::look(BlockSupply& supply, double now) {
  std::vector<Ball> balls(tools.begin(), tools.end());
  if (balls.empty()) balls.push_back({supply.start(), 0});
  unlisted = supply.list(balls, near, blocks);
  const bool has_room = supply.has_room(blocks);
  std::size_t ready = 0;
  std::size_t wanted = 0;  // ready, or to be prepared while tools stay where they are
  for (CloudBlock& block : blocks) {
    block.distance = distance(block.box, balls);
    if (block.state == State::failed && block.retry <= now) block.state = State::missing;
    const bool is_ready = block.state > State::failed;
    ready += is_ready ? 1 : 0;
    wanted += is_ready || has_room || block.distance <= near ? 1 : 0;
  }
  all_ready = wanted > 0 && ready == wanted;
  if (wanted == 0) return 0;
  return (supply.comes_together() ? kOfBlocks : 1) * static_cast<double>(ready) /
         static_cast<double>(wanted);
}

CloudBlock* BlocksAround::nearest_missing(double within) {
  CloudBlock* found = nullptr;
  for (CloudBlock& block : blocks) {
    if (block.state != State::missing || block.distance > within) continue;
    if (found == nullptr || block.distance < found->distance) found = &block;
  }
  return found;
}

std::vector<CloudBlock*> choose_shown(std::span<CloudBlock> blocks, double near) {
  std::vector<CloudBlock*> order;
  for (CloudBlock& block : blocks) {
    if (block.state > State::failed) order.push_back(&block);
  }
  std::ranges::stable_sort(order, {}, [&](const CloudBlock* block) {
    return std::pair(rank(*block, near), block->distance);
  });
  std::vector<CloudBlock*> found;
  std::size_t points = 0;
  for (CloudBlock* const block : order) {
    const std::size_t more = block->piece.positions.size();
    if (!found.empty() && block->distance > 0 && points + more > kMostShown) continue;
    found.push_back(block);
    points += more;
  }
  return found;
}

bool shows_more(std::span<CloudBlock> blocks, double near) {
  return std::ranges::any_of(choose_shown(blocks, near), [&](const CloudBlock* block) {
    return block->state == State::prepared && block->distance <= near;
  });
}

std::vector<Box> missing_boxes(std::span<const CloudBlock> blocks,
                               std::span<CloudBlock* const> shown, std::vector<Box> unlisted) {
  std::vector<const CloudBlock*> others;
  for (const CloudBlock& block : blocks) {
    if (std::ranges::find(shown, &block) == shown.end()) others.push_back(&block);
  }
  std::ranges::stable_sort(others, {}, &CloudBlock::distance);
  std::vector<Box> boxes = std::move(unlisted);
  for (const CloudBlock* const block : others) {
    if (boxes.size() < kMostMissing) boxes.push_back(block->box);
  }
  return boxes;
}

bool has_filled(std::span<const Box> missing, std::span<CloudBlock> blocks,
                const std::vector<Box>& unlisted, std::span<const Ball> tools, double near) {
  std::vector<Box> reported;
  std::ranges::copy_if(missing, std::back_inserter(reported),
                       [&](const Box& box) { return distance(box, tools) <= near; });
  if (reported.empty()) return false;
  const std::vector<Box> now = missing_boxes(blocks, choose_shown(blocks, near), unlisted);
  return std::ranges::any_of(reported, [&](const Box& box) {
    return std::ranges::none_of(now, [&](const Box& other) {
      return other.lower == box.lower && other.upper == box.upper;
    });
  });
}

}  // namespace palpate
