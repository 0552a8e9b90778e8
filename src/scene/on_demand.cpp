// Chooses which block of a cloud is prepared next, and which are shown.

#include "palpate/scene/on_demand.hpp"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "prepare/blocks.hpp"
#include "prepare/place.hpp"
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

/// How far a box is beyond a ball, m; negative within.
double distance(const Box& box, const Ball& ball) {
  const Eigen::Vector3d nearest = ball.center.cwiseMax(box.lower).cwiseMin(box.upper);
  return (ball.center - nearest).norm() - ball.radius;
}

}  // namespace

struct OnDemand::Inside {
  enum class State : std::uint8_t { missing, prepared, shown };

  Inside(std::shared_ptr<const PointCloud> given, const PrepareOptions& options,
         const Eigen::Isometry3d& pose)
      : cloud(std::move(given)),
        placed(place(*cloud, options, pose)),
        blocks(placed, options),
        pieces(blocks.size()),
        states(blocks.size(), State::missing),
        distances(blocks.size()) {}

  void look(const Source& source);
  [[nodiscard]] std::optional<std::size_t> nearest_missing(double within) const;
  [[nodiscard]] std::vector<std::size_t> chosen() const;
  [[nodiscard]] bool shows_more(double within) const;
  template <class Work>
  void beside_servos(const Work& work);
  void prepare(std::size_t block);
  void show_near(Source& source, double now);
  void show_all(Source& source);
  void publish(Source& source, std::span<const Piece* const> shown, Snapshot snapshot);

  std::shared_ptr<const PointCloud> cloud;
  Placed placed;
  Blocks blocks;
  std::vector<Piece> pieces;
  std::vector<State> states;
  std::vector<double> distances;  // of blocks from what tools can reach, m
  std::vector<Reach> tools;
  const Source* source = nullptr;  // that was shown something last
  // All but one core: that is the servos'.
  tbb::task_arena background{std::max(1, tbb::this_task_arena::max_concurrency() - 1)};
  std::atomic<std::size_t> prepared{0};
  std::atomic<bool> done{false};
  std::mutex mutex;  // of advance()
};

/// Where tools are; at the middle of the cloud before there are any.
void OnDemand::Inside::look(const Source& at) {
  at.inside_->reaches.read(tools);
  std::vector<Ball> balls(tools.begin(), tools.end());
  if (balls.empty()) balls.push_back({blocks.facts().extent.center(), 0});
  for (std::size_t k = 0; k < distances.size(); ++k) {
    const Box box = blocks.box(k);
    distances[k] = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) distances[k] = std::min(distances[k], distance(box, ball));
  }
}

/// The nearest block that is missing, if one is nearer than `within`, m.
std::optional<std::size_t> OnDemand::Inside::nearest_missing(double within) const {
  std::optional<std::size_t> found;
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k] != State::missing || distances[k] > within) continue;
    if (!found || distances[k] < distances[*found]) found = k;
  }
  return found;
}

/// The blocks to show, the nearest first: all that tools can reach, and more while they are few.
std::vector<std::size_t> OnDemand::Inside::chosen() const {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k] != State::missing) order.push_back(k);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return distances[k]; });
  std::vector<std::size_t> found;
  std::size_t points = 0;
  for (const std::size_t k : order) {
    const std::size_t more = pieces[k].positions.size();
    if (!found.empty() && distances[k] > 0 && points + more > kMostShown) continue;
    found.push_back(k);
    points += more;
  }
  return found;
}

/// Is there a block nearer than `within`, m, that is to be shown and is not yet? One for which
/// there is no room does not count: nobody is to wait for it.
bool OnDemand::Inside::shows_more(double within) const {
  return std::ranges::any_of(chosen(), [&](std::size_t k) {
    return states[k] == State::prepared && distances[k] <= within;
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

void OnDemand::Inside::prepare(std::size_t block) {
  beside_servos([&] { pieces[block] = blocks.prepare(block); });
  states[block] = State::prepared;
  ++prepared;
}

void OnDemand::Inside::show_near(Source& to, double now) {
  const bool first = source != &to;
  std::vector<const Piece*> shown;
  std::vector<std::size_t> others(states.size());
  std::iota(others.begin(), others.end(), std::size_t{0});
  for (const std::size_t k : chosen()) {
    auto& [positions, columns, report] = pieces[k];
    const bool stood = first || states[k] == State::shown;
    columns.presences.assign(positions.size(), stood ? 1.f : 0.f);
    columns.end_presences.assign(positions.size(), 1.f);
    states[k] = State::shown;
    shown.push_back(&pieces[k]);
    others[k] = states.size();
  }
  std::erase(others, states.size());
  std::ranges::stable_sort(others, {}, [&](std::size_t k) { return distances[k]; });
  Snapshot snapshot;
  for (const std::size_t k : others) {
    if (states[k] == State::shown) states[k] = State::prepared;
    if (snapshot.missing.size() < kMostMissing) snapshot.missing.push_back(blocks.box(k));
  }
  if (!first) snapshot.start = now + kLead;
  snapshot.end = snapshot.start + (first ? 0 : kAppear);
  publish(to, shown, std::move(snapshot));
}

void OnDemand::Inside::show_all(Source& to) {
  std::vector<const Piece*> all;
  for (Piece& piece : pieces) {
    piece.columns.presences.clear();
    piece.columns.end_presences.clear();
    all.push_back(&piece);
  }
  publish(to, all, {});
  pieces.clear();
  done = true;
}

void OnDemand::Inside::publish(Source& to, std::span<const Piece* const> shown, Snapshot snapshot) {
  Prepared joined;
  beside_servos([&] { joined = blocks.join(shown); });
  joined.report.points_in = cloud->size();
  {
    const std::lock_guard lock(to.inside_->mutex);
    to.inside_->report = joined.report;
  }
  auto points = std::make_shared<const SurfacePoints>(std::move(joined.points));
  snapshot.layers.push_back({std::move(points), 1, 1});
  snapshot.publication = ++to.inside_->publications;
  source = &to;
  to.publish(std::make_shared<const Snapshot>(std::move(snapshot)));
}

bool OnDemand::suits(const PointCloud& cloud, const PrepareOptions& options) {
  if (cloud.width != 0) return false;
  std::size_t kept = options.clip ? 0 : cloud.size();
  for (std::size_t i = 0; options.clip && i < cloud.size(); ++i) {
    kept += options.clip->contains(cloud.point(i)) ? 1 : 0;
  }
  return goes_by_blocks(kept, options);
}

OnDemand::OnDemand(std::shared_ptr<const PointCloud> cloud, const PrepareOptions& options,
                   const Eigen::Isometry3d& T_world_sensor)
    : inside_(std::make_unique<Inside>(std::move(cloud), options, T_world_sensor)) {}

OnDemand::~OnDemand() = default;

void OnDemand::advance(Source& source, double now) {
  Inside& in = *inside_;
  const std::lock_guard lock(in.mutex);
  if (in.done) return;
  in.look(source);
  const double near = kAhead * in.blocks.facts().radius;
  const double anywhere = std::numeric_limits<double>::infinity();
  if (const auto needed = in.nearest_missing(near)) return in.prepare(*needed);
  const bool waits = in.source != &source || in.shows_more(near);
  if (waits && in.prepared > 0) return in.show_near(source, now);
  const auto next = in.nearest_missing(anywhere);
  next ? in.prepare(*next) : in.show_all(source);
}

void OnDemand::cancel() {
  const std::lock_guard lock(inside_->mutex);
  inside_->done = true;
}

double OnDemand::share() const noexcept {
  if (done()) return 1;
  const auto all = static_cast<double>(inside_->states.size());
  return static_cast<double>(inside_->prepared) / all;
}

bool OnDemand::done() const noexcept {
  return inside_->done;
}

}  // namespace palpate
