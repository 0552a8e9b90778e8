// palpate bag, as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "bag/bags.hpp"
#include "bag/mcap_peer.hpp"
#include "support/contains.hpp"

namespace palpate::bag {
namespace {

using app::Outcome;
using app::Shell;
using test::contains;

void record(const Shell& shell) {
  McapWriter writer(shell.path("run.mcap"));
  write_poses(writer, 5, 100);
  writer.attach({"setup.toml", "application/toml", kNoon, kNoon, Bytes(1234, 'a')});
  writer.close();
}

TEST(BagProgram, InfoTellsTopicsTypesCountsRatesAndDuration) {
  Shell shell;
  record(shell);
  const Outcome outcome = shell.run("bag info run.mcap --check --json facts.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* words :
       {"run.mcap", "ros2", "palpate", "500 in 5 chunks", "2025-10-09 08:53:20 UTC, 4.99 s",
        "/hand/pose (geometry_msgs/msg/PoseStamped): 500 messages, 100 a second",
        "setup.toml, 1 234 bytes", "damaged    nothing\n"}) {
    EXPECT_TRUE(contains(outcome.out, words)) << words << "\n" << outcome.out;
  }
  const auto facts = nlohmann::json::parse(shell.read("facts.json"));
  EXPECT_EQ(facts["messages"], 500);
  EXPECT_EQ(facts["start_ns"], kNoon);
  EXPECT_EQ(facts["topics"][0]["type"], "geometry_msgs/msg/PoseStamped");
  EXPECT_NEAR(facts["topics"][0]["rate_hz"], 100, 1e-9);
  EXPECT_TRUE(facts["closed"]);
  EXPECT_TRUE(facts["checked"]);
  EXPECT_TRUE(facts["losses"].empty());
}

TEST(BagProgram, CheckFindsADamagedAttachment) {
  Shell shell;
  record(shell);
  std::string damaged = shell.read("run.mcap");
  damaged[damaged.find(std::string(1234, 'a')) + 7] = 'b';
  shell.write("damaged.mcap", damaged);
  const Outcome outcome = shell.run("bag info damaged.mcap --check");
  EXPECT_TRUE(contains(outcome.out, "the attachment setup.toml is damaged")) << outcome.out;
  EXPECT_FALSE(contains(outcome.out, "nothing")) << outcome.out;
}

TEST(BagProgram, RecoverClosesAFileThatWasCutAndLosesOneChunk) {
  Shell shell;
  record(shell);
  const std::string whole = shell.read("run.mcap");
  const McapReader reader(shell.path("run.mcap"));
  const ChunkSpan& last = reader.contents().chunks.back();
  shell.write("cut.mcap", whole.substr(0, last.offset + last.length / 2));
  const Outcome cut = shell.run("bag info cut.mcap");
  EXPECT_EQ(cut.code, 0) << cut.err;
  EXPECT_TRUE(contains(cut.out, "the file was not closed")) << cut.out;
  const Outcome outcome = shell.run("bag recover cut.mcap whole.mcap");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "messages   400")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "are lost")) << outcome.out;
  McapReader recovered(shell.path("whole.mcap"));
  EXPECT_TRUE(recovered.contents().closed);
  EXPECT_TRUE(recovered.contents().losses.empty());
  const std::vector<Read> right = all_of(shell.path("run.mcap"));
  const std::vector<Read> read = all_of(recovered);
  ASSERT_EQ(read.size(), 400u);
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].data, right[i].data);
  EXPECT_EQ(recovered.contents().channels.at(1).metadata,
            reader.contents().channels.at(1).metadata);
}

TEST(BagProgram, RefusesWhatMakesNoSenseWithWords) {
  Shell shell;
  record(shell);
  shell.write("cloud.xyz", "0 0 0\n");
  const auto refuses = [&](const std::string& arguments, int code, const char* words) {
    const Outcome outcome = shell.run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_TRUE(contains(outcome.err, words)) << arguments << ": " << outcome.err;
  };
  refuses("bag", 2, "use info or recover");
  refuses("bag info", 2, "file");
  refuses("bag info absent.mcap", 1, "absent.mcap: cannot be read");
  refuses("bag info cloud.xyz", 1, "is no MCAP file");
  refuses("bag info run.mcap --json run.mcap", 2, "same file");
  refuses("bag recover run.mcap run.mcap", 2, "already exists");
  refuses("bag recover run.mcap no/such/new.mcap", 1, "cannot be created");
  EXPECT_EQ(McapReader(shell.path("run.mcap")).contents().messages, 500u) << "as it was";
}

TEST_F(McapPeer, DecodesEveryMessageOfARecordedRun) {
  Shell shell;
  ASSERT_EQ(shell
                .run("touch camera:simulated:wander synthetic:sphere --simulated-time --no-view "
                     "--duration 0.5 --record run.mcap")
                .code,
            0);
  const nlohmann::json found = nlohmann::json::parse(run("read.mjs", shell.path("run.mcap")))[0];
  EXPECT_EQ(found["indexed"]["counts"], found["streamed"]["counts"]);
  EXPECT_EQ(found["indexed"]["attachments"].size(), 2u);  // set-up and the sphere's surface
  const nlohmann::json& last = found["indexed"]["last"];
  EXPECT_EQ(last.size(), 9u);
  EXPECT_EQ(last["/palpate/hand/tick"]["step"], found["indexed"]["counts"]["/palpate/hand/tick"]);
  EXPECT_EQ(last["/palpate/simulated_wander_0/depth/image_raw"]["encoding"], "32FC1");
}

}  // namespace
}  // namespace palpate::bag
