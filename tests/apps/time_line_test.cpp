// What a recording shows at each of its moments.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

#include "apps/palpate/record/recorder.hpp"
#include "apps/playing.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"
#include "bag/mcap_writer.hpp"
#include "palpate/device/simulated.hpp"
#include "session/shown_run.hpp"
#include "support/folder.hpp"

namespace palpate::app {
namespace {

constexpr double kBegin = Playing::kBegin;
constexpr int kSteps = 6000;

using States = std::vector<ServoState>;

// Two hands that dip into a plane, each in its rhythm, are recorded.
class TimeLineTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    run_folder = std::make_unique<test::Folder>();
    run_folder->write("plane.xyz", plane_xyz());
    LoadedScene loaded =
        load_sources(planned(*run_folder / "plane.xyz").sources, {.keep_clouds = true});
    begin_run(loaded, {});
    ScriptedDevice device({{0, Eigen::Vector3d::Zero()}, {1, Eigen::Vector3d::Zero()}});
    Recorder recorder(path());
    ServoOptions options;
    options.traces = recorder.add_hand();
    Servo first(device, loaded.scene, options);
    options.traces = recorder.add_hand();
    Servo second(device, loaded.scene, options);
    recorder.begin(loaded, {&first, &second}, 0, true);
    felt_states.assign(2, {});
    for (int i = 0; i < kSteps; ++i) {
      if (i == kSteps / 2) first.set_field({.kind = FieldOptions::Kind::metaball});
      dip(first, i, 3e-3, felt_states[0]);
      dip(second, i, 5e-3, felt_states[1]);
      recorder.keep_up();
    }
    EXPECT_EQ(recorder.finish().at(0).steps, 2u * kSteps);
  }
  static void TearDownTestSuite() { run_folder.reset(); }

  static void dip(Servo& servo, int i, double pace, States& felt) {
    DeviceState hand;
    hand.position = {5e-3 * std::sin(pace * i), 0, -2e-3 * std::sin(pace * i)};
    servo.step(hand, kBegin + 1e-3 * i);
    servo.show();
    felt.push_back(servo.state());
  }
  [[nodiscard]] static std::string path() { return *run_folder / "run.mcap"; }

  // The last of them at or before `time`, s on the run's clock.
  [[nodiscard]] static const ServoState& at(std::size_t hand, double time) {
    const States& felt = felt_states[hand];
    auto after = std::ranges::upper_bound(felt, time, {}, &ServoState::time);
    return after == felt.begin() ? *after : *--after;
  }
  static void expect_same(const ServoState& shown, const ServoState& felt) {
    EXPECT_EQ(shown.time, felt.time);
    EXPECT_EQ(shown.hip, felt.hip);
    EXPECT_EQ(shown.force, felt.force);
    EXPECT_EQ(shown.contact.proxy, felt.contact.proxy);
    EXPECT_EQ(shown.contact.normal, felt.contact.normal);
    EXPECT_EQ(shown.contact.touching, felt.contact.touching);
    EXPECT_EQ(shown.guard.fault, felt.guard.fault);
  }

  inline static std::unique_ptr<test::Folder> run_folder;
  inline static std::vector<States> felt_states;  // of each hand
};

TEST_F(TimeLineTest, ASeekToAnyMomentShowsItsStepExactly) {
  const session::Recording recording(path());
  Scene scene;
  const session::ShownSource source(recording, 0, scene);
  EXPECT_FALSE(source.lives());
  EXPECT_GT(scene.source(0).points()->size(), 100u);
  for (std::size_t i = 0; i < 2; ++i) {
    session::ShownHand hand(recording, i, scene);
    for (const double time : {0.0, 5.5, 1.2345, 1.2344, 5.999, 99.0, 3.0, -1.0, 3.0004}) {
      hand.seek(kBegin + time);
      expect_same(hand.servo().state(), at(i, kBegin + time));
      hand.advance(kBegin + time + 0.25);
      expect_same(hand.servo().state(), at(i, kBegin + time + 0.25));
    }
  }
}

TEST_F(TimeLineTest, ThePastIsOfTheStepsBefore) {
  const session::Recording recording(path());
  Scene scene;
  session::ShownHand hand(recording, 0, scene);
  hand.seek(kBegin + 4);
  const auto past = hand.past(1.5, [] { return false; });
  ASSERT_NEAR(static_cast<double>(past.size()), 1501, 1);
  for (const auto& each : past) {
    EXPECT_EQ(each.force, at(0, each.time).force.cast<float>());
  }
  EXPECT_EQ(past.back().time, hand.servo().state().time);
  EXPECT_TRUE(hand.past(1.5, [] { return true; }).empty());
}

TEST_F(TimeLineTest, APlayerSeeksPlaysToTheEndAndBeginsAgain) {
  Playing playing(path());
  Playback& player = playing.player;
  const Playback::TimeLine& line = playing.line;
  EXPECT_NEAR(line.length, 1e-3 * (kSteps - 1), 1e-9);
  EXPECT_EQ(player.servos().size(), 2u);
  EXPECT_NEAR(playing.shown(0), 0, 1e-9);
  line.seek(2.5);
  Playing::wait([&] { return playing.shown(1) > 2.4 && line.past(1).size() > 2400; });
  EXPECT_EQ(line.past(0).back().time, player.servos()[0]->state().time);
  expect_same(player.servos()[1]->state(), at(1, kBegin + 2.5));
  line.seek(1e6);
  Playing::wait([&] { return playing.shown(0) > 5.9; });
  EXPECT_EQ(line.moment().time, line.length);
  line.play(true, 4);
  Playing::wait([&] { return playing.shown(0) > 0.01 && playing.shown(0) < 5; });
  line.seek(line.length - 0.1);
  Playing::wait([&] { return playing.shown(0) > line.length - 1e-6; });
  EXPECT_FALSE(line.moment().playing);
  EXPECT_EQ(line.moment().time, line.length) << "it ends there";
  EXPECT_EQ(line.moment().speed, 4);
  expect_same(player.servos()[0]->state(), felt_states[0].back());
  EXPECT_TRUE(playing.complained().empty());
}

TEST_F(TimeLineTest, TheEnvelopeHasTheLargestForceOfEachPart) {
  Playing playing(path());
  const double part = playing.line.length / session::PlayedRun::kEnvelope;
  std::vector<float> largest(session::PlayedRun::kEnvelope);
  for (const States& felt : felt_states) {
    for (const ServoState& state : felt) {
      const auto i = static_cast<std::size_t>((state.time - kBegin) / part);
      float& top = largest[std::min(i, session::PlayedRun::kEnvelope - 1)];
      top = std::max(top, static_cast<float>(state.force.norm()));
    }
  }
  Playing::wait([&] { return playing.line.envelope() == largest; });
  EXPECT_GT(*std::ranges::max_element(largest), 0.1F);
  Playing::wait([&] { return playing.envelopes > 0 && playing.changes > 0; });
  EXPECT_EQ(playing.changes, 1) << "the past is told where it begins, and not while it is read";
}

TEST_F(TimeLineTest, TheFieldIsTheOneThatWasFeltThen) {
  Playing playing(path());
  Playback& player = playing.player;
  const Playback::TimeLine& line = playing.line;
  // Hangs until the test's time is over if it never is; the file may be read after the seek.
  const auto wait_for = [&](double time, FieldOptions::Kind kind) {
    line.seek(time);
    Playing::wait([&] {
      return std::abs(playing.shown(0) - time) < 1e-3 && player.servos()[0]->field().kind == kind;
    });
  };
  wait_for(4, FieldOptions::Kind::metaball);
  wait_for(2, FieldOptions::Kind::balanced);
  wait_for(3.5, FieldOptions::Kind::metaball);
  EXPECT_EQ(player.servos()[1]->field().kind, FieldOptions::Kind::balanced);
}

TEST_F(TimeLineTest, AFileThatWasCutShowsWhatIsThere) {
  const std::string cut = *run_folder / "cut.mcap";
  std::filesystem::copy(path(), cut);
  std::filesystem::resize_file(cut, 3 * std::filesystem::file_size(cut) / 5);
  EXPECT_FALSE(bag::McapReader(cut).contents().closed);
  Playing playing(cut);
  EXPECT_GT(playing.line.length, 1);
  playing.line.seek(1);
  Playing::wait([&] { return playing.shown(1) > 0.9; });
  expect_same(playing.player.servos()[1]->state(), at(1, kBegin + 1));
}

TEST_F(TimeLineTest, InAGapTheLastStepBeforeItStays) {
  const std::string gap = *run_folder / "gap.mcap";
  {
    bag::McapReader reader(path());
    bag::McapWriter writer(gap);
    for (std::size_t i = 0; i < reader.contents().attachments.size(); ++i) {
      writer.attach(reader.attachment(i));
    }
    std::map<std::uint16_t, std::uint16_t> numbers;
    for (const auto& [number, channel] : reader.contents().channels) {
      numbers[number] = writer.add_channel(channel);
    }
    const auto begin = static_cast<std::int64_t>(reader.contents().start);
    for (bag::Message message; reader.next(message);) {
      const auto at = static_cast<std::int64_t>(message.stamp.log) - begin;
      if (at > 1'000'000'000 && at < 4'000'000'000) continue;
      writer.write(numbers[message.channel], message.stamp, message.data);
    }
    writer.close();
  }
  const session::Recording recording(gap);
  Scene scene;
  session::ShownHand hand(recording, 0, scene);
  for (const double time : {10.5, 8.5, 11.2, 10.9}) {
    hand.seek(time);
    expect_same(hand.servo().state(), at(0, time < 11 ? 8 : time));
  }
}

// The camera's surface is that of the newest frame that was felt.
TEST(TimeLine, ACameraShowsItsFramesOneByOne) {
  Shell shell;
  ASSERT_EQ(record_camera(shell, 1).code, 0);
  const session::Recording recording(shell.path("run.mcap"));
  const double begin = recording.stretch().begin;
  Scene scene;
  session::ShownSource source(recording, 0, scene);
  ASSERT_TRUE(source.lives());
  EXPECT_TRUE(source.stream().frustum);
  const auto shown = [&](double time) {
    source.show(begin + time);
    return scene.source(0).points();
  };
  EXPECT_EQ(shown(-1), nullptr) << "nothing was felt yet";
  const auto first = shown(0.5);
  ASSERT_NE(first, nullptr);
  EXPECT_GT(first->size(), 1000u);
  EXPECT_EQ(shown(0.501), first) << "no other frame has come";
  const auto later = shown(0.7);
  EXPECT_NE(later, first);
  const auto again = shown(0.5);
  EXPECT_TRUE(std::ranges::equal(again->grid.points(), first->grid.points())) << "the same again";
  EXPECT_EQ(shown(50)->size(), shown(60)->size()) << "the last one stays";
}

// Hangs until the test's time is over if frames stand still.
TEST(TimeLine, ItBeginsAtTheFirstSurfaceAndFramesGoOnAfterAPause) {
  Shell shell;
  ASSERT_EQ(record_camera(shell, 2).code, 0);
  Playing playing(shell.path("run.mcap"));
  const Source& camera = playing.player.scene().source(0);
  Playing::wait([&] { return camera.points() != nullptr; });
  const double first = playing.line.moment().time;
  EXPECT_GT(first, 0) << "a camera's first frame comes later than the first step";
  Playing::wait([&] { return !playing.line.past(0).empty(); });
  const double until = playing.line.past(0).back().time;
  EXPECT_EQ(until, playing.player.servos()[0]->state().time) << "what was felt before it is told";
  playing.line.seek(first / 2);
  Playing::wait([&] { return camera.points() == nullptr; });
  playing.line.seek(0.3);
  Playing::wait([&] { return camera.points() != nullptr; });
  for (int time = 0; time < 2; ++time) {
    const auto before = camera.points();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // whoever looks looks again
    playing.line.play(true, 1);
    Playing::wait([&] { return camera.points() != before; });
    playing.line.play(false, 1);
  }
}

}  // namespace
}  // namespace palpate::app
