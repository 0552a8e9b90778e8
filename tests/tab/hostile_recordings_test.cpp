// Recordings that are damaged, and bags that are none, in a tab.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <random>
#include <string>

#include "apps/program.hpp"
#include "bag/mcap_writer.hpp"
#include "message/cdr.hpp"
#include "message/palpate_types.hpp"
#include "message/sensor_types.hpp"
#include "palpate/base/error.hpp"
#include "session/options_json.hpp"
#include "session/recorded_messages.hpp"
#include "support/effort.hpp"
#include "support/folder.hpp"
#include "support/rewritten_bag.hpp"
#include "tab/recorded_run.hpp"

namespace palpate::tab {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

std::string words(const std::string& bytes, const std::string& name) {
  try {
    const ReplayPage page(bytes, name);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

// Plays so many s of it. Why it is refused; of that, and of what is told, a person understands the
// words.
std::string refusal(const std::string& bytes, double length = 1.2) {
  const auto expect_words = [](const std::string& text) {
    EXPECT_THAT(text, Not(ContainsRegex("std::|vector|alloc")));
    return text;
  };
  try {
    ReplayPage page(bytes);
    page.play(true, 4);
    page.run(length / 4);
    page.seek(1.5);
    for (const json& each : page.said) {
      if (each["type"] == "notice") expect_words(each["text"]);
    }
    return "";
  } catch (const Error& error) {
    return expect_words(error.what());
  } catch (const nlohmann::json::exception& error) {
    return expect_words(error.what());
  }
}

TEST_F(TabReplayTest, WhatIsNoRecordingIsRefusedInWords) {
  const test::Folder folder;
  {
    bag::McapWriter writer(folder / "other.mcap");
    const auto topic = writer.add_topic<message::Image>("/camera/depth/image_raw");
    writer.write(topic, {1, 1}, message::Image{});
    writer.close();
  }
  EXPECT_THAT(words(folder.read("other.mcap"), "other.mcap"), HasSubstr("no recording of a run"));
  EXPECT_THAT(words(folder.read("other.mcap"), "other"), HasSubstr("palpate touch --record"));
  EXPECT_THAT(words("", "empty.mcap"), HasSubstr("empty.mcap"));
  EXPECT_THAT(words("1 2 3\n", "cloud.mcap"), HasSubstr("cloud.mcap"));
  EXPECT_THAT(words(file.substr(0, 300), "head.mcap"), HasSubstr("head.mcap"));
}

// It is refused, or plays; what it says of itself is not believed.
TEST_F(TabReplayTest, DamagedBytesAreRefusedOrPlayed) {
  std::mt19937 random(1);
  int played = 0;
  for (int i = 0; i < test::effort(30); ++i) {
    std::string damaged = file;
    for (int n = 0; n < 1 + i % 8; ++n) {
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    }
    const std::string why = refusal(damaged);
    EXPECT_TRUE(why.empty() || why.find("run.mcap") != std::string::npos) << why;
    played += why.empty() ? 1 : 0;
  }
  EXPECT_GT(played, 0);
}

// How many of `rounds` recordings with wrong values play; every second has few of them.
int played_with_wrong_values(const std::string& file, int rounds, double length) {
  std::mt19937 random(2);
  int played = 0;
  for (int i = 0; i < std::max(2, test::effort(rounds)); ++i) {
    const unsigned rate = i % 2 == 0 ? 20 : 2000;
    const std::string changed = test::rewritten(file, [&](const std::string&, bag::Bytes& data) {
      while (!data.empty() && random() % rate == 0) {
        const std::array<std::uint8_t, 4> signs{0, 0x7f, 0xff, static_cast<std::uint8_t>(random())};
        const std::size_t begin = random() % data.size();
        const std::size_t end = std::min(data.size(), begin + 1 + random() % 8);
        const std::uint8_t sign = signs[random() % 4];
        std::fill(data.begin() + std::ptrdiff_t(begin), data.begin() + std::ptrdiff_t(end), sign);
      }
    });
    played += refusal(changed, length).empty() ? 1 : 0;
  }
  return played;
}

TEST_F(TabReplayTest, WrongValuesAreRefusedOrPlayed) {
  EXPECT_GT(played_with_wrong_values(file, 30, 1.2), 0);
}

// A camera's recording of every fourth pixel, felt as images or as clouds: the latter take long.
std::string smaller(const std::string& file, bool as_cloud) {
  constexpr std::uint32_t kStep = 4;
  const auto shrink = [](message::Image& image) {
    decltype(image.data) kept;
    for (std::uint32_t y = 0; y < image.height; y += kStep) {
      for (std::uint32_t x = 0; x < image.width; x += kStep) {
        const auto at = image.data.begin() + std::ptrdiff_t(sizeof(float) * (y * image.width + x));
        kept.insert(kept.end(), at, at + sizeof(float));
      }
    }
    image.data = kept;
  };
  const auto shrink_lens = [](message::CameraInfo& info) {
    info.width /= kStep;
    info.height /= kStep;
    for (const std::size_t i : {0, 2, 4, 5}) info.k[i] /= kStep;
  };
  std::string small = test::rewritten<message::Image>(file, "/image_raw", -1, shrink);
  small = test::rewritten<message::CameraInfo>(small, "/camera_info", -1, shrink_lens);
  return test::rewritten(small, [&](const std::string& name, bag::Bytes& data) {
    if (name != session::kSetupName) return;
    session::Json setup = session::Json::parse(data);
    setup["sources"][0]["as_cloud"] = as_cloud;
    setup["sources"][0]["options"]["organised"] = !as_cloud;
    const std::string text = setup.dump();
    data.assign(text.begin(), text.end());
  });
}

TEST(TabReplay, WrongValuesOfCamerasAreRefusedOrPlayed) {
  app::Shell shell;
  ASSERT_EQ(app::record_camera(shell, 0.3).code, 0);
  for (const bool as_cloud : {false, true}) {
    constexpr double kLength = 0.1;  // s: three frames
    const std::string file = smaller(shell.read("run.mcap"), as_cloud);
    EXPECT_EQ(refusal(file, kLength), "");
    EXPECT_GT(played_with_wrong_values(file, 4, kLength), 0) << as_cloud;
    const auto refused = [&](std::uint32_t width) {
      const auto change = [&](message::CameraInfo& info) { info.width = width; };
      return refusal(test::rewritten<message::CameraInfo>(file, "/camera_info", -1, change));
    };
    EXPECT_THAT(refused(0), HasSubstr("0 x ")) << as_cloud;
    EXPECT_THAT(refused(~0U), HasSubstr(" x ")) << as_cloud;
  }
}

// The recording with another time of one step.
std::string with_time(const std::string& file, int step, double time) {
  return test::rewritten<message::Tick>(file, "/tick", step,
                                        [&](message::Tick& tick) { tick.time = time; });
}

TEST_F(TabReplayTest, StepsThatHaveNoTimeAreDamage) {
  for (const double time : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_EQ(words(with_time(file, 0, time), "run.mcap"),
              "run.mcap: a step is damaged: it has no time");
    ReplayPage page(with_time(file, 1500, time));
    page.run(0.2);
    EXPECT_EQ(page.notices("no time"), 1) << time;
    page.seek(2.5);
    page.run(0.05);
    EXPECT_EQ(page.force().cast<float>(), forces[2500]) << "what is whole is shown";
    EXPECT_EQ(test::u32(page.past, 4), 2500U) << "all of the past but one step";
    EXPECT_EQ(page.notices("no time"), 1);
  }
}

TEST_F(TabReplayTest, ADamagedStepPausesAndWhatIsSoughtLaterIsShown) {
  ReplayPage page(with_time(file, 1500, std::nan("")));
  page.run(0.2);
  page.seek(1.4);
  page.play(true);
  page.run(0.5);
  EXPECT_EQ(page.last("time")["playing"], false);
  EXPECT_NEAR(page.shown(), 1.499, 1e-6);
  EXPECT_EQ(page.notices("no time"), 2) << "as the file was read, and as it was played";
  page.play(true);
  page.run(0.5);
  EXPECT_EQ(page.last("time")["playing"], true) << "behind it";
  EXPECT_NEAR(page.shown(), 2, 0.02);
  page.seek(2.5);
  page.run(0.05);
  EXPECT_NEAR(page.shown(), 2.54, 0.03);
  EXPECT_EQ(page.notices("no time"), 2);
}

TEST_F(TabReplayTest, DamageThatIsFoundBeforeThereIsAPageIsToldToTheFirst) {
  ReplayPage page(with_time(file, 100, std::nan("")), "run.mcap", 1);
  page.run(0.05);
  EXPECT_EQ(page.notices("no time"), 1);
  EXPECT_EQ(page.notices("news"), 1);
  page.connect();
  page.run(0.05);
  EXPECT_EQ(page.notices("no time"), 1) << "and to no other";
}

// With checksums that are right, whatever steps say.
TEST_F(TabReplayTest, TimesThatNoClockHasAreRefusedOrPlayed) {
  for (const double time : {9e9, 1e11, 1e300, -9e9, -1e11, -1e300}) {
    for (const int step : {0, 1500, kSteps - 1}) {
      try {
        ReplayPage page(with_time(file, step, time));
        page.play(true);
        page.run(0.1);
        for (const double sought : {0.0, 1.0, 1e9, 1e300}) page.seek(sought);
        EXPECT_EQ(page.closed, 0) << time;
      } catch (const Error& error) {
        EXPECT_NE(step, 1500) << time;
        EXPECT_THAT(error.what(), HasSubstr("no step in it"));
      }
    }
  }
}

// Files that are packed by lz4 are such in a tab, where nothing unpacks them.
TEST_F(TabReplayTest, WhereNoStepCanBeUnpackedTheReasonIsTold) {
  const auto changed = [](const std::string& sign, std::size_t offset) {
    std::string bytes = file;
    for (std::size_t at = 0; (at = bytes.find(sign, at)) != std::string::npos; ++at) {
      bytes[at + offset] = static_cast<char>(bytes[at + offset] ^ 0x55);
    }
    return words(bytes, "run.mcap");
  };
  const char* const none = "run.mcap: there is no step in it; ";
  EXPECT_THAT(changed("zstd", 0), AllOf(HasSubstr(none), HasSubstr("compression is not known")));
  EXPECT_THAT(changed("\x28\xb5\x2f\xfd", 50), HasSubstr(none + std::string("messages in bytes")));
}

TEST_F(TabReplayTest, LossesThatAreFoundWhileTheFileIsReadAreTold) {
  std::string damaged = file;
  const std::size_t middle = damaged.find("zstd", damaged.size() / 2);
  ASSERT_NE(middle, std::string::npos);
  damaged[middle + 100] = static_cast<char>(damaged[middle + 100] ^ 1);
  ReplayPage page(damaged);
  page.run(1);
  EXPECT_EQ(page.notices("are lost"), 1);
  EXPECT_EQ(page.notices("run.mcap: messages in bytes"), 1);
  EXPECT_EQ(page.notices("news"), 1);
}

TEST_F(TabReplayTest, ARunThatSawNothingInACamerasAxesIsShown) {
  ReplayPage page(test::rewritten(file, [](const std::string& name, bag::Bytes& data) {
    if (name != session::kSetupName) return;
    session::Json setup = session::Json::parse(data);
    setup["sources"] = session::Json::array();
    setup["picture_axes"] = true;
    const std::string text = setup.dump();
    data.assign(text.begin(), text.end());
  }));
  page.seek(1);
  page.run(0.05);
  EXPECT_EQ(page.force().cast<float>(), forces[1000]);
}

}  // namespace
}  // namespace palpate::tab
