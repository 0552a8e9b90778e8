// palpate touch --record and palpate replay: a run that is done again gives the same forces, bit
// for bit, whatever it was made of.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "apps/recorded_again.hpp"
#include "apps/recorded_wall.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "message/palpate_types.hpp"
#include "message/schema.hpp"
#include "support/contains.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

using test::contains;

// Records `touch ARGUMENTS` without a loss and does it again; its report.
Json whole_and_replayed(Shell& shell, const std::string& arguments) {
  (void)record_and_replay(shell, arguments);
  Json report = Json::parse(shell.read("run.json"));
  EXPECT_EQ(report["recordings"][0]["lost_steps"], 0);
  EXPECT_EQ(report["recordings"][0]["lost_frames"], 0);
  return report;
}

TEST(ReplayProgram, AFileTouchedInSimulatedTime) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const Json report =
      whole_and_replayed(shell, "plane.xyz --trajectory way.csv --friction-dynamic 0.3");
  EXPECT_GT(report["largest_force_N"], 0.5);
  EXPECT_EQ(shell.run("replay run.mcap --log again.csv").code, 0);
  EXPECT_EQ(columns(shell.read("again.csv"))["fz"].size(), report["steps"]);
}

TEST(ReplayProgram, ADepthImage) {
  Shell shell;
  shell.write("wall.pgm", wall_pgm(0));
  shell.write("way.csv", into_wall(400));
  const Json report = whole_and_replayed(
      shell, "wall.pgm --intrinsics 60,60,31.5,23.5 --depth-unit 0.001 --trajectory way.csv");
  EXPECT_GT(report["largest_force_N"], 0.5);
}

TEST(ReplayProgram, ACameraInSimulatedTimeWhichRecordingDoesNotChange) {
  Shell shell;
  const std::string camera = "camera:simulated --simulated-time --duration 1 --log ";
  const Json report = whole_and_replayed(shell, camera + "recorded.csv");
  EXPECT_GT(report["recordings"][0]["frames"], 20);
  ASSERT_EQ(shell.run("touch " + camera + "alone.csv").code, 0);
  EXPECT_EQ(without_times(shell, "recorded.csv"), without_times(shell, "alone.csv"));
}

TEST(ReplayProgram, TwoCamerasInRealTime) {
  if (test::is_slow_build()) GTEST_SKIP() << "no surface is ready in time";
  Shell shell;
  const Json report =
      whole_and_replayed(shell,
                         "left=camera:simulated:table,view=40,phase=0.011,seed=2,error=0.002 "
                         "right=camera:simulated:table,view=-40 --duration 1.5");
  EXPECT_GT(report["recordings"][0]["frames"], 2);
}

// To its end, and beyond: the last surface stays.
TEST(ReplayProgram, AMovingCameraInRealTime) {
  if (test::is_slow_build()) GTEST_SKIP() << "no surface is ready in time";
  Shell shell;
  write_wall(shell, 75);  // 2.5 s: a busy machine has a surface late
  std::string poses;
  for (int i = 0; i < 75; ++i) poses += fmt::format("{} {} 0 0 0 0 0 1\n", i / 30.0, 2e-3 * i);
  shell.write("wall/groundtruth.txt", poses);
  shell.write("wall/sequence.json",
              R"({"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5,
                  "depth_unit_m": 0.001, "fps": 30, "pose": "groundtruth.txt"})");
  shell.write("way.csv", into_wall(3000));
  const Json report = whole_and_replayed(shell, "sequence:wall --trajectory way.csv");
  EXPECT_GT(report["recordings"][0]["frames"], 2);
  EXPECT_GT(report["largest_force_N"], 0.1);
  EXPECT_TRUE(contains(shell.run("bag info run.mcap").out, "/tf"));
}

TEST(ReplayProgram, TwoHandsInRealTime) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const Json report =
      whole_and_replayed(shell, "plane.xyz --device simulated --device simulated --duration 1.5");
  EXPECT_EQ(report["hands"].size(), 2u);
}

TEST(ReplayProgram, ARecordingThatIsCutBeforeItsSetupSaysSo) {
  Shell shell;
  ASSERT_EQ(shell.run("touch synthetic:sphere --duration 0.1 --record run.mcap").code, 0);
  shell.write("cut.mcap", shell.read("run.mcap").substr(0, 1000));
  const Outcome outcome = shell.run("replay cut.mcap");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.err, "are lost: a record is cut or damaged")) << outcome.err;
}

// run.mcap again as other.mcap; `change` may change the set-up, `keeps` leave out messages.
void copy_bag(const Shell& shell, const std::function<void(Json&)>& change,
              const std::function<bool(const bag::Channel&, bag::View)>& keeps) {
  bag::McapReader reader(shell.path("run.mcap"));
  bag::McapWriter writer(shell.path("other.mcap"));
  for (std::size_t i = 0; i < reader.contents().attachments.size(); ++i) {
    bag::Attachment attachment = reader.attachment(i);
    if (attachment.name == "setup.json") {
      Json setup = Json::parse(attachment.data.begin(), attachment.data.end());
      change(setup);
      const std::string text = setup.dump();
      attachment.data.assign(text.begin(), text.end());
    }
    writer.attach(attachment);
  }
  std::map<std::uint16_t, std::uint16_t> numbers;
  for (const auto& [number, channel] : reader.contents().channels) {
    numbers[number] = writer.add_channel(channel);
  }
  for (bag::Message message; reader.next(message);) {
    if (keeps(reader.channel_of(message), message.data)) {
      writer.write(numbers[message.channel], message.stamp, message.data);
    }
  }
  writer.close();
}

TEST(ReplayProgram, TellsTheFirstStepWhoseForceDiffers) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  (void)whole_and_replayed(shell, "plane.xyz --trajectory way.csv --stiffness 500");
  copy_bag(
      shell, [](Json& setup) { setup["hands"][0]["options"]["proxy"]["stiffness"] = 500.001; },
      [](const auto&, const auto&) { return true; });
  const Outcome outcome = shell.run("replay other.mcap --json other.json");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  const Json found = Json::parse(shell.read("other.json"));
  EXPECT_FALSE(found["exact"]);
  const Json& hand = found["hands"][0];
  EXPECT_GT(hand["first_step"], 1) << "in the air nothing differs";
  EXPECT_GT(hand["largest_difference_N"], 0);
  EXPECT_LT(hand["largest_difference_N"], 1e-4);
  EXPECT_GT(hand["rms_difference_N"], 0);
  EXPECT_TRUE(contains(outcome.out, fmt::format("step {},", hand["first_step"].get<int>())));
}

TEST(ReplayProgram, EndsWhereAStepIsMissing) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  (void)whole_and_replayed(shell, "plane.xyz --trajectory way.csv");
  copy_bag(
      shell, [](Json&) {},
      [](const bag::Channel& channel, bag::View data) {
        if (channel.schema.name != message::ros_name(message::Tick::kName)) return true;
        message::Tick tick;
        message::decode(data, tick);
        return tick.step != 50;
      });
  const Outcome outcome = shell.run("replay other.mcap");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.out, "the steps before step 51 were not recorded")) << outcome.out;
}

TEST(ReplayProgram, RefusesWhatIsNoRecordingOfARun) {
  Shell shell;
  {
    bag::McapWriter writer(shell.path("other.mcap"));
    const auto topic = writer.add_topic<message::Float64>("/a");
    writer.write(topic, {1, 1}, message::Float64{1});
  }
  const Outcome other = shell.run("replay other.mcap");
  EXPECT_EQ(other.code, 1);
  EXPECT_TRUE(contains(other.err, "palpate touch --record")) << other.err;
  EXPECT_EQ(shell.run("replay missing.mcap").code, 1);
  EXPECT_EQ(shell.run("replay missing.mcap --view --headless").code, 1);
  EXPECT_EQ(shell.run("replay other.mcap --port 0").code, 2);
  EXPECT_EQ(shell.run("replay other.mcap --view --log steps.csv").code, 2);
  shell.write("plane.xyz", plane_xyz());
  EXPECT_EQ(shell.run("touch plane.xyz --record -").code, 2);
  EXPECT_EQ(shell.run("touch plane.xyz --record plane.xyz").code, 2);
  EXPECT_EQ(shell.run("touch plane.xyz --record nowhere/run.mcap").code, 1);
}

}  // namespace
}  // namespace palpate::app
