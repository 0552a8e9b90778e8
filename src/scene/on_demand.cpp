// Chooses which block of a cloud is prepared next, and which are shown.

#include "palpate/scene/on_demand.hpp"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/block_supply.hpp"
#include "scene/source_inside.hpp"

namespace palpate {
namespace {

constexpr double kAhead = 8;     // typical R around what a tool can reach; judgement
constexpr double kLead = 0.002;  // s from publishing to being felt: a servo's step; judgement
constexpr double kAppear = 0.1;  // s in which a block's presence rises; judgement
// Points of a surface that is not whole: joining them takes a tenth of a second; judgement.
constexpr std::size_t kMostShown = std::size_t{1} << 19;
// Boxes that a servo looks through, 1.4 us a step (measured). A tool is not told of others: so many
// are the blocks of about a hundred million points of a surface.
constexpr std::size_t kMostMissing = 1024;
// s until what could not be read is tried again: a disk or a network may be back; judgement.
constexpr double kRetry = 10;

}  // namespace

struct OnDemand::Inside {
  using State = CloudBlock::State;

  Inside(std::unique_ptr<BlockSupply> from, const PrepareOptions& options)
      : supply(std::move(from)), kernel(options.kernel), near(kAhead * supply->facts().radius) {}

  void look(const Source& source, double now);
  [[nodiscard]] CloudBlock* nearest_missing(double within);
  [[nodiscard]] int rank(const CloudBlock& block) const;
  [[nodiscard]] std::vector<CloudBlock*> chosen();
  [[nodiscard]] bool shows_more();
  [[nodiscard]] std::vector<Box> missing(std::span<CloudBlock* const> shown) const;
  [[nodiscard]] bool was_missing();
  template <class Work>
  void beside_servos(const Work& work);
  void prepare(CloudBlock& block, double now);
  void show_near(Source& source, double now);
  void show_all(Source& source);
  void publish(Source& source, Prepared joined, Snapshot snapshot);

  std::unique_ptr<BlockSupply> supply;
  Kernel kernel;
  double near;  // how far around what tools can reach nothing is to be missing, m
  std::vector<CloudBlock> blocks;
  std::vector<Box> unlisted;      // where no block is
  std::vector<Box> told_missing;  // where it was last shown that nothing is known
  double last_start = 0;          // of what was shown last, s
  std::set<std::string> errors;   // that were thrown
  std::vector<Reach> tools;
  const Source* source = nullptr;  // that was shown something last
  // All but one core: that is the servos'.
  tbb::task_arena background{std::max(1, tbb::this_task_arena::max_concurrency() - 1)};
  std::atomic<double> share{0};
  std::atomic<bool> done{false};
  std::mutex mutex;  // of advance()
};

/// Reads where tools are (the cloud's start before there are any), lists the blocks there and
/// measures how far each is.
void OnDemand::Inside::look(const Source& at, double now) {
  at.inside_->reaches.read(tools);
  std::vector<Ball> balls(tools.begin(), tools.end());
  if (balls.empty()) balls.push_back({supply->start(), 0});
  unlisted = supply->list(balls, near, blocks);
  const bool has_room = supply->has_room(blocks);
  std::size_t ready = 0;
  std::size_t wanted = 0;  // ready, or to be prepared while tools stay where they are
  for (CloudBlock& block : blocks) {
    block.distance = distance(block.box, balls);
    if (block.state == State::failed && block.retry <= now) block.state = State::missing;
    const bool is_ready = block.state > State::failed;
    ready += is_ready ? 1 : 0;
    wanted += is_ready || has_room || block.distance <= near ? 1 : 0;
  }
  share = wanted == 0 ? 0 : static_cast<double>(ready) / static_cast<double>(wanted);
}

/// The nearest block that is missing, if one is nearer than `within`, m.
CloudBlock* OnDemand::Inside::nearest_missing(double within) {
  CloudBlock* found = nullptr;
  for (CloudBlock& block : blocks) {
    if (block.state != State::missing || block.distance > within) continue;
    if (found == nullptr || block.distance < found->distance) found = &block;
  }
  return found;
}

/// Ranks a block where there is no room for all: first what tools can reach, then what is near.
/// What is shown already comes before others of its kind, or a hand's way would change what is
/// shown all the time.
int OnDemand::Inside::rank(const CloudBlock& block) const {
  if (block.distance <= 0) return 0;
  return (block.distance <= near ? 1 : 3) + (block.state == State::shown ? 0 : 1);
}

/// The blocks to show: all that tools can reach, and more while they are few.
std::vector<CloudBlock*> OnDemand::Inside::chosen() {
  std::vector<CloudBlock*> order;
  for (CloudBlock& block : blocks) {
    if (block.state > State::failed) order.push_back(&block);
  }
  std::ranges::stable_sort(
      order, {}, [&](const CloudBlock* block) { return std::pair(rank(*block), block->distance); });
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

/// Is there a block near that is to be shown and is not yet? One for which there is no room does
/// not count: nobody is to wait for it.
bool OnDemand::Inside::shows_more() {
  return std::ranges::any_of(chosen(), [&](const CloudBlock* block) {
    return block->state == State::prepared && block->distance <= near;
  });
}

/// Where nothing is known or shown, the nearest blocks first.
std::vector<Box> OnDemand::Inside::missing(std::span<CloudBlock* const> shown) const {
  std::vector<const CloudBlock*> others;
  for (const CloudBlock& block : blocks) {
    if (std::ranges::find(shown, &block) == shown.end()) others.push_back(&block);
  }
  std::ranges::stable_sort(others, {}, &CloudBlock::distance);
  std::vector<Box> boxes = unlisted;
  for (const CloudBlock* const block : others) {
    if (boxes.size() < kMostMissing) boxes.push_back(block->box);
  }
  return boxes;
}

/// Was a place near shown as one of which nothing is known, and is it not so any more? A block may
/// turn out to have no points there.
bool OnDemand::Inside::was_missing() {
  std::vector<Box> told;
  std::ranges::copy_if(told_missing, std::back_inserter(told),
                       [&](const Box& box) { return distance(box, tools) <= near; });
  if (told.empty()) return false;
  const std::vector<Box> now = missing(chosen());
  return std::ranges::any_of(told, [&](const Box& box) {
    return std::ranges::none_of(now, [&](const Box& other) {
      return other.lower == box.lower && other.upper == box.upper;
    });
  });
}

template <class Work>
void OnDemand::Inside::beside_servos(const Work& work) {
  if (tools.empty()) {
    work();
  } else {
    background.execute(work);
  }
}

/// @throws what is wrong with a block, the first time that it is.
void OnDemand::Inside::prepare(CloudBlock& block, double now) {
  try {
    beside_servos([&] { supply->prepare(block); });
    block.state = State::prepared;
  } catch (const std::exception& error) {
    block.state = State::failed;
    block.retry = now + kRetry;
    if (errors.insert(error.what()).second) throw;
  }
}

void OnDemand::Inside::show_near(Source& to, double now) {
  const bool first = source != &to && tools.empty();  // nobody can be pushed
  Snapshot snapshot;
  if (!first) snapshot.start = now + kLead;
  snapshot.end = snapshot.start + (first ? 0 : kAppear);
  // A block whose presence still rises goes on from where that is at the new start.
  const double past = std::clamp((snapshot.start - last_start) / kAppear, 0., 1.);
  last_start = snapshot.start;
  const std::vector<CloudBlock*> chosen = this->chosen();
  std::vector<const Piece*> shown;
  for (CloudBlock* const block : chosen) {
    auto& [positions, columns, report] = block->piece;
    const double before = block->state == State::shown ? block->presence : 0;
    const double risen = block->state == State::shown ? past : 0;
    block->presence = first ? 1 : before + (1 - before) * risen;
    columns.presences.assign(positions.size(), static_cast<float>(block->presence));
    columns.end_presences.assign(positions.size(), 1.f);
    shown.push_back(&block->piece);
  }
  for (CloudBlock& block : blocks) {
    if (block.state == State::shown) block.state = State::prepared;
  }
  for (CloudBlock* const block : chosen) block->state = State::shown;
  snapshot.missing = told_missing = missing(chosen);
  Prepared joined;
  beside_servos([&] { joined = join(shown, supply->facts(), supply->origin(), kernel); });
  publish(to, std::move(joined), std::move(snapshot));
}

void OnDemand::Inside::show_all(Source& to) {
  std::vector<Piece> all;
  for (CloudBlock& block : blocks) {
    block.piece.columns.presences.clear();
    block.piece.columns.end_presences.clear();
    all.push_back(std::move(block.piece));
  }
  blocks.clear();
  Prepared joined;
  beside_servos([&] { joined = join(std::move(all), supply->facts(), supply->origin(), kernel); });
  publish(to, std::move(joined), {});
  share = 1;
  done = true;
}

void OnDemand::Inside::publish(Source& to, Prepared joined, Snapshot snapshot) {
  joined.report.points_in = supply->points();
  {
    const std::lock_guard lock(to.inside_->mutex);
    to.inside_->report = joined.report;
    to.inside_->state.overview = supply->overview();
  }
  auto points = std::make_shared<const SurfacePoints>(std::move(joined.points));
  snapshot.layers.push_back({std::move(points), 1, 1});
  snapshot.publication = ++to.inside_->publications;
  source = &to;
  to.publish(std::make_shared<const Snapshot>(std::move(snapshot)));
}

OnDemand::OnDemand(std::shared_ptr<const PointCloud> cloud, const PrepareOptions& options,
                   const Eigen::Isometry3d& T_world_sensor)
    : inside_(std::make_unique<Inside>(blocks_of(std::move(cloud), options, T_world_sensor),
                                       options)) {}

OnDemand::OnDemand(const std::shared_ptr<const PointStore>& store, const PrepareOptions& options,
                   const Eigen::Isometry3d& T_world_sensor, std::size_t memory)
    : inside_(
          std::make_unique<Inside>(blocks_of(store, options, T_world_sensor, memory), options)) {}

OnDemand::~OnDemand() = default;

bool OnDemand::advance(Source& source, double now, bool ahead) {
  Inside& in = *inside_;
  const std::lock_guard lock(in.mutex);
  if (in.done) return false;
  in.look(source, now);
  CloudBlock* wanted = in.nearest_missing(in.near);
  if (wanted == nullptr && in.share > 0 &&
      (in.source != &source || in.shows_more() || in.was_missing())) {
    in.show_near(source, now);
    return true;
  }
  if (wanted == nullptr && ahead && in.supply->has_room(in.blocks)) {
    wanted = in.nearest_missing(std::numeric_limits<double>::infinity());
  }
  if (wanted != nullptr) {
    in.prepare(*wanted, now);
    return true;
  }
  if (!ahead || !in.supply->is_whole() || in.share < 1) return false;
  in.show_all(source);
  return true;
}

void OnDemand::cancel() {
  const std::lock_guard lock(inside_->mutex);
  inside_->done = true;
}

double OnDemand::share() const noexcept {
  return done() ? 1. : inside_->share.load();
}

bool OnDemand::done() const noexcept {
  return inside_->done;
}

}  // namespace palpate
