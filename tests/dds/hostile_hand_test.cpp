// Nodes whose poses are none. Nothing of them crashes palpate, fills its memory or becomes a force.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>

#include "dds/hostile.hpp"
#include "message/transforms.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate::hostile {
namespace {

using message::eigen;
using message::PoseStamped;
using message::to_time;
using message::WrenchStamped;

// A node that owns a hand: sends what it is told to, as often as it is told, and keeps the force
// that it was sent last.
class HandNode {
 public:
  using Make = std::function<Bytes()>;

  static Bytes still() {
    return bytes_of(PoseStamped{{to_time(system_now()), "hand"}, {{0.01, 0.02, 0.03}, {}}});
  }

  HandNode() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

  // `rate`: Hz; 0: nothing is sent.
  void send(Make make, int rate = 500) {
    const std::lock_guard lock(mutex_);
    make_ = std::move(make);
    rate_ = rate;
  }
  [[nodiscard]] double force() const { return force_; }

 private:
  void run(const std::stop_token& stop) {
    auto due = std::chrono::steady_clock::now();
    WrenchStamped wrench;
    while (!stop.stop_requested()) {
      {
        const std::lock_guard lock(mutex_);
        if (rate_ > 0) poses_.write(make_());
        due += std::chrono::nanoseconds(1'000'000'000 / std::max(rate_, 500));
      }
      while (wrenches_.take(wrench)) force_ = eigen(wrench.wrench.force).norm();
      due = std::max(due, std::chrono::steady_clock::now() - std::chrono::milliseconds(5));
      std::this_thread::sleep_until(due);
    }
  }

  dds::Participant participant_{own_domain()};
  dds::RawWriter poses_{participant_, {"/hand/pose", PoseStamped::kName, PoseStamped::kHash}, {}};
  dds::Reader<WrenchStamped> wrenches_{participant_, "/hand/wrench", {.reliable = true}};
  std::mutex mutex_;
  Make make_ = still;
  int rate_ = 500;
  std::atomic<double> force_ = 0;
  std::jthread thread_;  // last: it uses all of the above
};

class HostileHand : public testing::Test {
 protected:
  // Asks for 1 N, as a servo does, until `done`.
  bool press_until(const std::function<bool()>& done) {
    return before_long([&] {
      state_ = device_->read();
      device_->write(state_.status == DeviceState::Status::ok ? Eigen::Vector3d(0, 0, 1)
                                                              : Eigen::Vector3d::Zero());
      return done();
    });
  }
  bool feels() {
    return press_until([&] {
      return state_.status == DeviceState::Status::ok && node_.force() > 0.99 &&
             node_.force() < 1.01;
    });
  }
  bool is_silent() {
    return press_until([&] {
      return state_.status == DeviceState::Status::silent && node_.force() == 0 &&
             !device_->reason().empty();
    });
  }

  HandNode node_;
  SteadyClock clock_;
  std::unique_ptr<Device> device_ =
      open_device("ros:generic,pose=/hand/pose,wrench=/hand/wrench,profile=omega", clock_);
  DeviceState state_;
};

PoseStamped pose_at(double stamp, double x = 0.01, double w = 1) {
  return {{to_time(stamp), "hand"}, {{x, 0.02, 0.03}, {0, 0, 0, w}}};
}

TEST_F(HostileHand, GetsNoForceWhilePosesAreNone) {
  ASSERT_TRUE(feels()) << device_->reason();
  const std::vector<std::pair<std::string, HandNode::Make>> kinds = {
      {"not a number",
       [] { return bytes_of(pose_at(system_now(), std::numeric_limits<double>::quiet_NaN())); }},
      {"no rotation", [] { return bytes_of(pose_at(system_now(), 0.01, 0)); }},
      {"far away", [] { return bytes_of(pose_at(system_now(), 1e30)); }},
      {"cut", [] { return Bytes{0, 1, 0, 0, 1, 2, 3, 4}; }},
      {"empty", [] { return Bytes{}; }},
      {"a length of 2^31",
       [] {
         Bytes bytes = HandNode::still();
         bytes[15] = 0x80;
         return bytes;
       }},
      {"a second old", [] { return bytes_of(pose_at(system_now() - 1)); }},
      {"of an hour later", [] { return bytes_of(pose_at(system_now() + 3600)); }},
      {"of the year 1970", [] { return bytes_of(pose_at(0)); }}};
  for (const auto& [name, make] : kinds) {
    node_.send(make);
    EXPECT_TRUE(is_silent()) << name << ": force " << node_.force() << ", " << device_->reason();
    node_.send(HandNode::still);
    ASSERT_TRUE(feels()) << name << ": " << device_->reason();
  }
}

TEST_F(HostileHand, WhoseStampsStopIsToldSo) {
  ASSERT_TRUE(feels()) << device_->reason();
  node_.send([] { return bytes_of(pose_at(0)); });
  EXPECT_TRUE(press_until([&] {
    return device_->reason().find("has no stamp, though earlier ones had") != std::string::npos;
  })) << device_->reason();
}

TEST_F(HostileHand, GetsNoForceWhileItJumpsAbout) {
  ASSERT_TRUE(feels()) << device_->reason();
  int count = 0;
  node_.send([&count] { return bytes_of(pose_at(system_now(), ++count % 2 == 0 ? 0.2 : -0.2)); });
  EXPECT_TRUE(is_silent()) << node_.force() << " " << device_->reason();
  node_.send(HandNode::still);
  EXPECT_TRUE(feels()) << device_->reason();
}

TEST_F(HostileHand, ThatSendsTenThousandPosesASecondIsFeltAndFillsNoMemory) {
  ASSERT_TRUE(feels()) << device_->reason();
  const double before = memory();
  node_.send(HandNode::still, 10'000);
  const double end = clock_.now() + 3;
  press_until([&] { return clock_.now() > end; });
  EXPECT_TRUE(feels()) << device_->reason();
  EXPECT_LT(memory() - before, kMostMemory);
}

}  // namespace
}  // namespace palpate::hostile
