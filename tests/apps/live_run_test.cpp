#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "apps/palpate/touch/touch.hpp"
#include "apps/setup_parsed.hpp"

namespace palpate::app {
namespace {

// Stands still, and ends in some way after some reads.
class ShortDevice final : public Device {
 public:
  ShortDevice(int reads, DeviceState::Status end) : left_(reads), end_(end) {
    info_.name = "short";
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override {
    DeviceState state;
    if (left_ == 0) state.status = end_;
    if (left_ > 0) --left_;
    return state;
  }
  void write(const Eigen::Vector3d& /*force*/) noexcept override {}
  [[nodiscard]] std::string reason() const override { return "its cable is out"; }
  [[nodiscard]] int left() const { return left_; }

 private:
  DeviceInfo info_;
  int left_;
  DeviceState::Status end_;
};

Hand hand_with(const std::string& name, int reads, DeviceState::Status end) {
  Hand hand;
  hand.name = name;
  hand.device = std::make_unique<ShortDevice>(reads, end);
  hand.stiffness = kStiffness;
  return hand;
}

int left(const Hand& hand) {
  return static_cast<const ShortDevice&>(*hand.device).left();
}

TEST(LiveRun, ADeviceThatFailsEndsItsOwnHandAlone) {
  TouchPlan plan = planned("synthetic:sheet");
  plan.time.realtime.realtime_priority = false;
  plan.time.realtime.lock_memory = false;
  LoadedScene loaded = load_sources(plan.sources, {});
  std::vector<Hand> hands;
  hands.push_back(hand_with("hand 1", 20, DeviceState::Status::failed));
  hands.push_back(hand_with("hand 2", 200, DeviceState::Status::finished));
  app::Run run{
      plan.time, plan.page, plan.ros, loaded, hands, {}, plan.surface.proxy_of(kStiffness)};
  std::vector<std::size_t> steps(2);
  SteadyClock clock;
  const Interruption interruption;
  const LiveOutcome outcome = run_live(run, clock, interruption,
                                       [&](std::size_t hand, const ServoState&) { ++steps[hand]; });
  const std::vector<LiveReport>& reports = outcome.hands;
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_EQ(reports[0].failure, "hand 1: device 'short' failed: its cable is out");
  EXPECT_EQ(reports[0].guard.fault, Guard::Fault::device);
  EXPECT_EQ(reports[1].failure, "");
  EXPECT_EQ(reports[1].guard.fault, Guard::Fault::none);
  EXPECT_EQ(left(hands[1]), 0) << "went on to its own end";
  EXPECT_LE(steps[0], 21u);
  EXPECT_GT(steps[1], 0u);
}

// A slow disk or a busy machine may write steps down more slowly than they are made.
TEST(LiveRun, EndsInTimeWhereStepsAreMadeFasterThanWritten) {
  TouchPlan plan = planned("synthetic:sheet");
  plan.time.realtime.realtime_priority = false;
  plan.time.realtime.lock_memory = false;
  LoadedScene loaded = load_sources(plan.sources, {});
  std::vector<Hand> hands;
  constexpr int kReads = 100'000;  // what it never comes to
  hands.push_back(hand_with("hand 1", kReads, DeviceState::Status::finished));
  hands.front().duration = 0.05;
  app::Run run{
      plan.time, plan.page, plan.ros, loaded, hands, {}, plan.surface.proxy_of(kStiffness)};
  SteadyClock clock;
  const Interruption interruption;
  double written = 0;  // s
  const auto each = [&](std::size_t, const ServoState& state) {
    written = std::max(written, state.time);
    for (const double end = clock.now() + 3e-3; clock.now() < end;) {
    }
  };
  const LiveOutcome outcome = run_live(run, clock, interruption, each);
  EXPECT_EQ(outcome.hands.front().failure, "");
  EXPECT_GE(written, 0.04) << "what was made is written";
  EXPECT_GT(left(hands.front()), 0) << "the hand's end, not its device's";
}

}  // namespace
}  // namespace palpate::app
