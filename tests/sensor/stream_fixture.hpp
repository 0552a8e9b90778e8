#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"
#include "sensor/fake_camera.hpp"

namespace palpate::sensor {

/// What is pushed, with a gate before it.
class Touchable {
 public:
  [[nodiscard]] Stream::Sink sink() {
    return [this](const DepthFrame& frame, const Source::StartTime& start) { push(frame, start); };
  }
  void close() { open(false); }
  void open(bool is_open = true) {
    const std::lock_guard lock(mutex_);
    open_ = is_open;
    changed_.notify_all();
  }
  void throw_next(const std::string& what) {
    const std::lock_guard lock(mutex_);
    failure_ = what;
  }
  [[nodiscard]] std::size_t entered() {
    const std::lock_guard lock(mutex_);
    return entered_;
  }
  [[nodiscard]] std::vector<double> stamps() {
    const std::lock_guard lock(mutex_);
    return stamps_;
  }
  [[nodiscard]] std::vector<double> starts() {
    const std::lock_guard lock(mutex_);
    return starts_;
  }

 private:
  void push(const DepthFrame& frame, const Source::StartTime& start) {
    std::unique_lock lock(mutex_);
    ++entered_;
    changed_.wait(lock, [this] { return open_; });
    if (!failure_.empty()) throw Error(std::exchange(failure_, ""));
    if (std::ranges::none_of(frame.depth, [](float z) { return z > 0; })) return;
    stamps_.push_back(frame.stamp);
    starts_.push_back(start());
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = true;
  std::string failure_;
  std::size_t entered_ = 0;
  std::vector<double> stamps_;
  std::vector<double> starts_;
};

class StreamTest : public testing::Test {
 protected:
  // The clock jumps in these tests; that is no stall unless a test says so.
  static constexpr double kNever = 1e9;

  [[nodiscard]] Stream stream(const StreamOptions& options = {.stall = kNever}, bool paces = true) {
    return {camera(paces), "table", touchable_.sink(), clock_, options};
  }
  // It lives as long as the test does.
  [[nodiscard]] FakeCamera& camera(bool paces = true, bool repeats = false) {
    return cameras_.emplace_back(script_, paces, repeats);
  }

  // Gives the frame of time `t` and waits until the stream has seen it.
  void give(const Stream& stream, double t, DepthFrame frame) {
    const auto before = stream.state().frames;
    clock_.set(t);
    script_->give({.frame = std::move(frame)});
    ASSERT_TRUE(eventually([&] { return stream.state().frames == before + 1; }));
  }
  void give(const Stream& stream, double t) {
    give(stream, t, frame_at(t, static_cast<float>(1 + t)));
  }
  void expect_touchable(const Stream& stream, std::uint64_t count) {
    EXPECT_TRUE(eventually([&] { return stream.state().touchable == count; }))
        << stream.state().touchable;
  }

  // The clock goes on by `seconds` and the stream looks at it.
  void pass(const Stream& stream, double seconds) {
    clock_.set(clock_.now() + seconds);
    const int before = script_->reads();
    ASSERT_TRUE(eventually([&] { return script_->reads() > before + 1; })) << stream.state().frames;
  }

  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  std::deque<FakeCamera> cameras_;
  Touchable touchable_;
  ManualClock clock_;
};

}  // namespace palpate::sensor
