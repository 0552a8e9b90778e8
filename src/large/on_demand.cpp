// Chooses which block of a cloud is prepared next, and which are shown.

#include "palpate/scene/on_demand.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "geometry/parallel.hpp"
#include "large/block_choice.hpp"
#include "large/block_supply.hpp"
#include "large/change_over.hpp"
#include "prepare/surfels.hpp"
#include "scene/source_inside.hpp"

namespace palpate {
namespace {

constexpr double kAhead = 8;     // typical R around what a tool can reach; judgement
constexpr double kLead = 0.002;  // s from publishing to being felt: a servo's step; judgement
constexpr double kAppear = 0.1;  // s in which a block's presence rises; judgement
// s until what could not be read is tried again: a disk or a network may be back; judgement.
constexpr double kRetry = 10;
// Share of the work that is done with the blocks where all is prepared together after them: of the
// Stanford dragon a run without them takes 2.3 s of processor time, with them 4.6.
constexpr double kOfBlocks = 0.5;

}  // namespace

struct OnDemand::Inside {
  using State = CloudBlock::State;

  Inside(std::unique_ptr<BlockSupply> from, const PrepareOptions& options,
         const std::optional<SurfaceEye>& seen_from)
      : supply(std::move(from)),
        kernel(options.kernel),
        near(kAhead * supply->facts().radius),
        eye(seen_from) {}

  void look(const Source& source, double now);
  [[nodiscard]] CloudBlock* nearest_missing(double within);
  [[nodiscard]] bool has_news(const Source& source);
  template <class Work>
  void beside_servos(const Work& work);
  void prepare(CloudBlock& block, double now);
  void show_near(Source& source, double now);
  [[nodiscard]] Prepared join_all();
  void prepare_rest(Source& source, std::unique_lock<std::mutex>& lock,
                    const std::stop_token& stop);
  [[nodiscard]] bool change_over(Source& source, double now);
  void publish(Source& source, Prepared::Report report, Snapshot snapshot);
  void finish();

  std::unique_ptr<BlockSupply> supply;
  Kernel kernel;
  double near;  // how far around what tools can reach nothing is to be missing, m
  std::optional<SurfaceEye> eye;
  std::vector<CloudBlock> blocks;
  std::vector<Box> unlisted;       // where no block is
  std::vector<Box> told_missing;   // where it was last shown that nothing is known
  double last_start = 0;           // of what was shown last, s
  std::optional<ChangeOver> over;  // from the blocks to all of it prepared together
  std::set<std::string> errors;    // that were thrown
  std::vector<Reach> tools;
  const Source* source = nullptr;  // that was shown something last
  detail::Background background;
  bool all_ready = false;  // of the blocks that are wanted
  std::atomic<double> share{0};
  std::atomic<bool> done{false};  // or cancelled
  std::mutex mutex;               // of advance()
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
  all_ready = wanted > 0 && ready == wanted;
  share = wanted == 0 ? 0
                      : (supply->comes_together() ? kOfBlocks : 1) * static_cast<double>(ready) /
                            static_cast<double>(wanted);
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

/// Is there more to show than the source shows? Nothing new is shown while all is prepared
/// together, so before that blocks that are not near count, too.
bool OnDemand::Inside::has_news(const Source& at) {
  const bool is_last = all_ready && supply->comes_together();
  return share > 0 &&
         (source != &at ||
          shows_more(blocks, is_last ? std::numeric_limits<double>::infinity() : near) ||
          has_filled(told_missing, blocks, unlisted, tools, near));
}

template <class Work>
void OnDemand::Inside::beside_servos(const Work& work) {
  if (tools.empty()) {
    work();
  } else {
    background.run(work);
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
  const double start = first ? 0 : now + kLead;
  // A block whose presence still rises goes on from where that is at the new start.
  const double past = std::clamp((start - last_start) / kAppear, 0., 1.);
  last_start = start;
  const std::vector<CloudBlock*> chosen = choose_shown(blocks, near);
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
  told_missing = missing_boxes(blocks, chosen, unlisted);
  Prepared joined;
  beside_servos([&] { joined = join(shown, supply->facts(), supply->origin(), kernel); });
  joined.points.eye = eye;
  Snapshot snapshot = still(std::move(joined.points));
  snapshot.start = start;
  snapshot.end = start + (first ? 0 : kAppear);
  snapshot.missing = told_missing;
  publish(to, joined.report, std::move(snapshot));
}

Prepared OnDemand::Inside::join_all() {
  std::vector<Piece> all;
  for (CloudBlock& block : blocks) {
    block.piece.columns.presences.clear();
    block.piece.columns.end_presences.clear();
    all.push_back(std::move(block.piece));
  }
  blocks.clear();
  Prepared joined;
  beside_servos([&] { joined = join(std::move(all), supply->facts(), supply->origin(), kernel); });
  joined.points.eye = eye;
  return joined;
}

/// Makes the surface of all of the cloud, once all blocks are there. Where memory is short for
/// preparing it together, the blocks stay.
void OnDemand::Inside::prepare_rest(Source& to, std::unique_lock<std::mutex>& lock,
                                    const std::stop_token& stop) {
  std::optional<Prepared> together;
  if (supply->comes_together()) {
    lock.unlock();  // cancel() does not wait for seconds
    try {
      beside_servos([&] { together = supply->prepare_together(stop); });
    } catch (const PreparationStopped&) {
      return lock.lock();
    } catch (const std::exception&) {
      together.reset();  // the blocks are all that there will be
    }
    lock.lock();
    if (done) return;
  }
  Prepared joined = join_all();
  if (together) {
    together->points.eye = eye;
    return void(over.emplace(std::move(joined), std::move(*together)));
  }
  publish(to, joined.report, still(std::move(joined.points)));
  finish();
}

/// @return false: the fade goes on
bool OnDemand::Inside::change_over(Source& to, double now) {
  std::optional<Snapshot> next = over->next(now, kLead, kAppear);
  if (!next) return false;
  const bool is_last = next->layers.size() == 1;
  publish(to, over->report(), std::move(*next));
  if (is_last) finish();
  return true;
}

void OnDemand::Inside::finish() {
  over.reset();
  supply.reset();
  share = 1;
  done = true;
}

void OnDemand::Inside::publish(Source& to, Prepared::Report report, Snapshot snapshot) {
  report.points_in = supply->points();
  const std::shared_ptr<const PointCloud> overview = supply->overview(blocks);
  {
    const std::lock_guard lock(to.inside_->mutex);
    to.inside_->report = report;
    to.inside_->state.overview = overview;
  }
  snapshot.publication = ++to.inside_->publications;
  source = &to;
  to.publish(std::make_shared<const Snapshot>(std::move(snapshot)));
}

OnDemand::OnDemand(const std::shared_ptr<const PointCloud>& cloud, const PrepareOptions& options,
                   const Eigen::Isometry3d& T_world_sensor)
    : inside_(std::make_unique<Inside>(blocks_of(cloud, options, T_world_sensor), options,
                                       eye_of(*cloud, options, T_world_sensor))) {}

OnDemand::OnDemand(const std::shared_ptr<const PointStore>& store, const PrepareOptions& options,
                   const Eigen::Isometry3d& T_world_sensor, std::size_t memory)
    : inside_(std::make_unique<Inside>(blocks_of(store, options, T_world_sensor, memory), options,
                                       std::nullopt)) {}

OnDemand::~OnDemand() = default;

bool OnDemand::advance(Source& source, double now, bool ahead, const std::stop_token& stop) {
  Inside& in = *inside_;
  std::unique_lock lock(in.mutex);
  if (in.done) return false;
  if (in.over) return in.change_over(source, now);
  in.look(source, now);
  CloudBlock* wanted = in.nearest_missing(in.near);
  if (wanted == nullptr && in.has_news(source)) {
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
  if (!ahead || !in.supply->is_whole() || !in.all_ready) return false;
  in.prepare_rest(source, lock, stop);
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
