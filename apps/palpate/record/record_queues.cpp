// Holds what waits for a recorder's thread.
#include "apps/palpate/record/record_queues.hpp"

#include <utility>

#include "session/options_json.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kMostFrames = 16;  // queue of all sources: half a second at 30 Hz; judgement

}  // namespace

void WaitingFrames::begin(std::size_t sources, bool waits) {
  waits_ = waits;
  changes_.assign(sources, 0);
  gaps_.assign(sources, 0);
}

void WaitingFrames::put(std::size_t source, message::FrameUse use, DepthFrame frame,
                        const SourceTrace& trace) {
  std::deque<session::RecordedFrame>& frames = waiting_.frames;
  std::unique_lock lock(mutex_);
  if (waits_) room_.wait(lock, [&] { return frames.size() < kMostFrames; });
  if (frames.size() >= kMostFrames && use.kind != "end") {
    ++lost_;
    gaps_[source] = 1;
    return;
  }
  use.gap = std::exchange(gaps_[source], 0) != 0;
  if (trace.changes() != std::exchange(changes_[source], trace.changes())) {
    use.options = session::exact_json(trace.options()).dump();
  }
  frames.push_back({source, std::move(frame), std::move(use)});
}

void WaitingFrames::put(RecordedRobot robot) {
  const std::lock_guard lock(mutex_);
  waiting_.robots.push_back(std::move(robot));
}

WaitingFrames::Taken WaitingFrames::take() {
  Taken taken;
  {
    const std::lock_guard lock(mutex_);
    std::swap(taken, waiting_);
  }
  room_.notify_all();
  return taken;
}

void WaitingFrames::forget_gaps() {
  const std::lock_guard lock(mutex_);
  gaps_.assign(gaps_.size(), 0);
}

std::uint64_t WaitingFrames::take_lost() {
  const std::lock_guard lock(mutex_);
  return std::exchange(lost_, 0);
}

std::string RecordOrders::record(bool on, const std::function<RecordOrder()>& make) {
  const std::lock_guard lock(mutex_);
  if (on != name_.empty()) return name_;
  RecordOrder order = on ? make() : RecordOrder{};
  std::string name = on ? order.path : name_;
  name_ = order.path;
  orders_.push_back(std::move(order));
  called_.notify_one();
  return name;
}

std::string RecordOrders::name() const {
  const std::lock_guard lock(mutex_);
  return name_;
}

void RecordOrders::forget(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (name_ == name) name_.clear();
}

void RecordOrders::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  called_.notify_one();
}

std::deque<RecordOrder> RecordOrders::wait(bool looks, bool& last) {
  std::unique_lock lock(mutex_);
  const auto called = [this] { return ending_ || !orders_.empty(); };
  if (looks) {
    called_.wait_for(lock, kQueueLook, called);
  } else {
    called_.wait(lock, called);
  }
  last = ending_;
  return std::exchange(orders_, {});
}

}  // namespace palpate::app
