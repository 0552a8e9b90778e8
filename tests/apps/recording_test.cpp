// Recordings that begin and end in the middle of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <thread>

#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/replay/replay.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "message/palpate_types.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

std::vector<message::Tick> ticks_in(const std::string& path) {
  bag::McapReader reader(path);
  reader.choose([](const bag::Channel& channel) { return channel.topic.ends_with("/tick"); });
  std::vector<message::Tick> ticks;
  for (bag::Message message; reader.next(message);) {
    message::decode(message.data, ticks.emplace_back());
  }
  EXPECT_TRUE(reader.contents().losses.empty());
  return ticks;
}

// Copies a recording, with half of each step's message.
void copy_with_half_steps(const std::string& from, const std::string& to) {
  bag::McapReader reader(from);
  bag::McapWriter writer(to);
  for (std::size_t i = 0; i < reader.contents().attachments.size(); ++i) {
    writer.attach(reader.attachment(i));
  }
  reader.choose([](const bag::Channel& channel) { return channel.topic.ends_with("/tick"); });
  std::optional<std::uint16_t> channel;
  for (bag::Message message; reader.next(message);) {
    if (!channel) channel = writer.add_channel(reader.channel_of(message));
    writer.write(*channel, message.stamp, message.data.first(message.data.size() / 2));
  }
  writer.close();
}

Json setup_in(const std::string& path) {
  const bag::McapReader reader(path);
  const auto& attached = reader.contents().attachments;
  for (std::size_t i = 0; i < attached.size(); ++i) {
    if (attached[i].head.name != session::kSetupName) continue;
    const bag::Bytes text = reader.attachment(i).data;
    return Json::parse(text.begin(), text.end());
  }
  return {};
}

// A hand on a plane in simulated time, in the folder where recordings go.
class RecordingTest : public testing::Test {
 protected:
  RecordingTest() {
    fs::current_path(folder_.path());
    shell_.write("plane.xyz", plane_xyz());
    loaded_ = load_sources(planned(shell_.path("plane.xyz")).sources, {.keep_clouds = true});
    begin_run(loaded_, {});
  }
  ~RecordingTest() override { fs::current_path(before_); }

  void begin(const std::string& path = {}) {
    recorder_ = std::make_unique<Recorder>(path);
    ServoOptions options;
    options.traces = recorder_->add_hand();
    servo_ = std::make_unique<Servo>(device_, loaded_.scene, options);
    recorder_->begin(loaded_, {servo_.get()}, 0, true);
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) {
      DeviceState hand;
      hand.position = {0, 0, 1e-3 - 1e-5 * static_cast<double>(i % 300)};
      servo_->step(hand, 1e-3 * ++steps_);
      servo_->show();
      recorder_->keep_up();
    }
  }
  // The thread has carried out what it was told: it takes steps, or takes none.
  void wait_until(bool records) const {
    while (options().traces->accepts() != records) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  [[nodiscard]] const ServoOptions& options() const { return servo_->options(); }

  fs::path before_ = fs::current_path();
  test::Folder folder_;
  Shell shell_;
  LoadedScene loaded_;
  ScriptedDevice device_{{{0, Eigen::Vector3d::Zero()}, {1, Eigen::Vector3d::Zero()}}};
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Servo> servo_;
  int steps_ = 0;
};

TEST_F(RecordingTest, BeginsAndEndsTwiceInTheMiddleOfARun) {
  begin();
  step(100);
  EXPECT_EQ(recorder_->recording(), "");
  const std::string first = recorder_->record(true);
  EXPECT_EQ(recorder_->recording(), first);
  EXPECT_EQ(recorder_->record(true), first) << "what goes on goes on";
  wait_until(true);
  step(200);
  EXPECT_EQ(recorder_->record(false), first);
  EXPECT_EQ(recorder_->record(false), "") << "nothing goes on any more";
  wait_until(false);
  step(50);
  servo_->set_contact({321, {0.3, 0.2, 0}, {}});
  const std::string second = recorder_->record(true);
  EXPECT_NE(first, second) << "in the same second";
  wait_until(true);
  step(30);
  const std::vector<RecordReport> reports = recorder_->finish();
  ASSERT_EQ(reports.size(), 2u) << "what was begun is kept when the run ends";
  EXPECT_EQ(reports[0].path, first);
  EXPECT_EQ(reports[0].steps, 200u);
  EXPECT_EQ(reports[1].steps, 30u);
  EXPECT_EQ(reports[0].lost_steps + reports[1].lost_steps, 0u);
  EXPECT_EQ(reports[0].problem + reports[1].problem, "");
  const std::vector<message::Tick> ticks = ticks_in(first);
  ASSERT_EQ(ticks.size(), 200u);
  EXPECT_EQ(ticks.front().step, 101u);
  EXPECT_EQ(ticks.back().step, 300u);
  EXPECT_EQ(ticks_in(second).front().step, 351u);
  EXPECT_EQ(setup_in(first)["hands"][0]["options"]["proxy"]["stiffness"], 500.0);
  EXPECT_EQ(setup_in(second)["hands"][0]["options"]["proxy"]["stiffness"], 321.0);
}

TEST_F(RecordingTest, ARunThatIsRecordedFromItsBeginningMayEndItsFileAndBeginAnother) {
  begin("run.mcap");
  EXPECT_EQ(recorder_->recording(), "run.mcap");
  step(100);
  EXPECT_EQ(recorder_->record(false), "run.mcap");
  wait_until(false);
  step(10);
  const std::string second = recorder_->record(true);
  wait_until(true);
  step(20);
  EXPECT_EQ(recorder_->finish().size(), 2u);
  const auto nothing = [](const ServoState&, const DeviceInfo&) {};
  EXPECT_TRUE(Replay("run.mcap").run(0, nothing).exact());
  const ForceDifference later = Replay(second).run(0, nothing);
  EXPECT_FALSE(later.exact());
  EXPECT_EQ(later.ended,
            "recorded from step 111 of its run on: it can be viewed (--view), not done again; use "
            "--record to record a run from its beginning");
}

TEST_F(RecordingTest, AFileFromTheMiddleHoldsItsStepsToTheLastBit) {
  begin();
  step(120);
  const std::string file = recorder_->record(true);
  wait_until(true);
  std::vector<ServoState> felt;
  for (int i = 0; i < 100; ++i) {
    step(1);
    felt.push_back(servo_->state());
  }
  (void)recorder_->finish();
  std::vector<ServoState> recorded;
  Replay(file).show(0,
                    [&](const ServoState& state, const DeviceInfo&) { recorded.push_back(state); });
  ASSERT_EQ(recorded.size(), felt.size());
  for (std::size_t i = 0; i < felt.size(); ++i) {
    EXPECT_EQ(recorded[i].hip, felt[i].hip);
    EXPECT_EQ(recorded[i].force, felt[i].force);
    EXPECT_EQ(recorded[i].contact.proxy, felt[i].contact.proxy);
    EXPECT_EQ(recorded[i].contact.normal, felt[i].contact.normal);
    EXPECT_EQ(recorded[i].contact.touching, felt[i].contact.touching);
    EXPECT_EQ(recorded[i].contact.stiffness, felt[i].contact.stiffness);
    EXPECT_EQ(recorded[i].patch_points, felt[i].patch_points);
    EXPECT_DOUBLE_EQ(recorded[i].time, felt[i].time - felt[0].time);
  }
  const Outcome replay = shell_.run("replay " + folder_ / file + " --log steps.csv");
  EXPECT_EQ(replay.code, 1);
  EXPECT_TRUE(test::contains(replay.out, "recorded from step 121")) << replay.out;
  EXPECT_EQ(columns(shell_.read("steps.csv"))["fz"].size(), felt.size());
}

TEST_F(RecordingTest, ADamagedStepIsToldWithTheFilesNameWhereItIsOnlyShownToo) {
  begin("whole.mcap");
  step(10);
  (void)recorder_->finish();
  copy_with_half_steps("whole.mcap", "half.mcap");
  const Replay replay("half.mcap");
  const auto nothing = [](const ServoState&, const DeviceInfo&) {};
  const auto told = testing::ThrowsMessage<Error>(testing::StartsWith("half.mcap: damaged: "));
  EXPECT_THAT([&] { (void)replay.run(0, nothing); }, told);
  EXPECT_THAT([&] { replay.show(0, nothing); }, told);
}

TEST_F(RecordingTest, WhatCannotBeMadeChangesNothing) {
  begin();
  fs::current_path("/proc");
  EXPECT_ANY_THROW(recorder_->record(true));
  EXPECT_EQ(recorder_->recording(), "");
  fs::current_path(folder_.path());
  EXPECT_FALSE(recorder_->record(true).empty()) << "it may be begun again";
}

// A disk with room for 100 kB.
struct SmallDisk {
  SmallDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{100'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  rlimit before{};
};

TEST_F(RecordingTest, AFullDiskEndsTheFileAndIsTold) {
  begin("run.mcap");
  std::string told;
  recorder_->on_broken([&](const std::string& why) { told = why; });
  {
    const SmallDisk disk;
    while (!recorder_->recording().empty()) step(100);
  }
  const std::vector<RecordReport> reports = recorder_->finish();
  EXPECT_EQ(recorder_->recording(), "");
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_FALSE(reports[0].problem.empty());
  EXPECT_EQ(told, reports[0].problem);
}

}  // namespace
}  // namespace palpate::app
