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

/// Thrown by a preparation that was stopped.
struct Stopped {};

}  // namespace

// What was shown last.
struct ShownLast {
  const Source* source = nullptr;  // to which
  std::vector<Box> missing;        // where nothing is loaded
  double start = 0;                // s
};

struct OnDemand::Inside {
  using State = CloudBlock::State;

  Inside(std::unique_ptr<BlockSupply> from, const PrepareOptions& options,
         const std::optional<SurfaceEye>& seen_from)
      : supply(std::move(from)),
        kernel(options.kernel),
        eye(seen_from),
        around{kAhead * supply->facts().radius} {}

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
  std::optional<SurfaceEye> eye;
  BlocksAround around;
  ShownLast last;
  std::optional<ChangeOver> over;  // from the blocks to all of it prepared together
  std::set<std::string> errors;    // that were thrown
  detail::Background background;
  std::atomic<double> share{0};
  std::atomic<bool> done{false};  // or cancelled
  std::mutex mutex;               // of advance()
};

/// Is there more to show than the source shows? Nothing new is shown while all is prepared
/// together, so before that blocks that are not near count, too.
bool OnDemand::Inside::has_news(const Source& at) {
  auto& [near, blocks, unlisted, tools, all_ready] = around;
  const bool is_last = all_ready && supply->comes_together();
  return share > 0 &&
         (last.source != &at ||
          shows_more(blocks, is_last ? std::numeric_limits<double>::infinity() : near) ||
          has_filled(last.missing, blocks, unlisted, tools, near));
}

template <class Work>
void OnDemand::Inside::beside_servos(const Work& work) {
  if (around.tools.empty()) {
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
  auto& blocks = around.blocks;
  const bool first = last.source != &to && around.tools.empty();  // nobody can be pushed
  const double start = first ? 0 : now + kLead;
  // A block whose presence still rises goes on from where that is at the new start.
  const double past = std::clamp((start - last.start) / kAppear, 0., 1.);
  last.start = start;
  const std::vector<CloudBlock*> chosen = choose_shown(blocks, around.near);
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
  last.missing = missing_boxes(blocks, chosen, around.unlisted);
  Prepared joined;
  beside_servos([&] { joined = join(shown, supply->facts(), supply->origin(), kernel); });
  joined.points.eye = eye;
  Snapshot snapshot = still(std::move(joined.points));
  snapshot.start = start;
  snapshot.end = start + (first ? 0 : kAppear);
  snapshot.missing = last.missing;
  publish(to, joined.report, std::move(snapshot));
}

Prepared OnDemand::Inside::join_all() {
  std::vector<Piece> all;
  for (CloudBlock& block : around.blocks) {
    block.piece.columns.presences.clear();
    block.piece.columns.end_presences.clear();
    all.push_back(std::move(block.piece));
  }
  around.blocks.clear();
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
      const auto go_on = [&](double /*share*/) {
        if (stop.stop_requested()) throw Stopped();
      };
      beside_servos([&] { together = supply->prepare_together(go_on); });
    } catch (const Stopped&) {
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
  const std::shared_ptr<const PointCloud> overview = supply->overview(around.blocks);
  {
    const std::lock_guard lock(to.inside_->mutex);
    to.inside_->report = report;
    to.inside_->state.overview = overview;
  }
  snapshot.publication = ++to.inside_->publications;
  last.source = &to;
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
  source.inside_->reaches.read(in.around.tools);
  in.share = in.around.look(*in.supply, now);
  CloudBlock* wanted = in.around.nearest_missing(in.around.near);
  if (wanted == nullptr && in.has_news(source)) {
    in.show_near(source, now);
    return true;
  }
  if (wanted == nullptr && ahead && in.supply->has_room(in.around.blocks)) {
    wanted = in.around.nearest_missing(std::numeric_limits<double>::infinity());
  }
  if (wanted != nullptr) {
    in.prepare(*wanted, now);
    return true;
  }
  if (!ahead || !in.supply->is_whole() || !in.around.all_ready) return false;
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
