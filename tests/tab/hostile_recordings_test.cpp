// Recordings that are damaged, and bags that are none, in a tab.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <random>
#include <string>

#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "message/cdr.hpp"
#include "message/palpate_types.hpp"
#include "message/sensor_types.hpp"
#include "session/options_json.hpp"
#include "session/recorded_messages.hpp"
#include "support/folder.hpp"
#include "tab/recorded_run.hpp"

namespace palpate::tab {
namespace {

using testing::HasSubstr;

std::string words(const std::string& bytes, const std::string& name) {
  try {
    const ReplayPage page(bytes, name);
    return "";
  } catch (const std::exception& error) {
    return error.what();
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
  for (int i = 0; i < 30; ++i) {
    std::string damaged = file;
    for (int n = 0; n < 1 + i % 8; ++n) {
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    }
    try {
      ReplayPage page(damaged);
      page.play(true, 4);
      page.run(0.3);
      page.seek(1.5);
      ++played;
    } catch (const std::exception& error) {
      EXPECT_THAT(error.what(), HasSubstr("run.mcap"));
    }
  }
  EXPECT_GT(played, 0);
}

// The recording with what `change` makes of its attachments and messages, given their name or
// topic; all of its checksums are right.
using Change = std::function<void(const std::string&, bag::Bytes&)>;
std::string rewritten(const std::string& bytes, const Change& change) {
  const test::Folder folder;
  const FileBytes memory = in_memory(bytes);
  bag::McapReader reader(bag::RandomFile("run.mcap", memory.bytes, memory.size));
  bag::McapWriter writer(folder / "changed.mcap");
  for (std::size_t i = 0; i < reader.contents().attachments.size(); ++i) {
    bag::Attachment attachment = reader.attachment(i);
    change(attachment.name, attachment.data);
    writer.attach(attachment);
  }
  std::map<std::uint16_t, std::uint16_t> numbers;
  for (const auto& [number, channel] : reader.contents().channels) {
    numbers[number] = writer.add_channel(channel);
  }
  for (bag::Message message; reader.next(message);) {
    bag::Bytes data(message.data.begin(), message.data.end());
    change(reader.channel_of(message).topic, data);
    writer.write(numbers[message.channel], message.stamp, data);
  }
  writer.close();
  return folder.read("changed.mcap");
}

TEST_F(TabReplayTest, WrongValuesAreRefusedOrPlayed) {
  std::mt19937 random(2);
  int played = 0;
  for (int i = 0; i < 30; ++i) {
    const unsigned rate = i % 2 == 0 ? 20 : 2000;
    const std::string changed = rewritten(file, [&](const std::string&, bag::Bytes& data) {
      while (!data.empty() && random() % rate == 0) {
        const std::array<std::uint8_t, 4> signs{0, 0x7f, 0xff, static_cast<std::uint8_t>(random())};
        const std::size_t begin = random() % data.size();
        const std::size_t end = std::min(data.size(), begin + 1 + random() % 8);
        const std::uint8_t sign = signs[random() % 4];
        std::fill(data.begin() + std::ptrdiff_t(begin), data.begin() + std::ptrdiff_t(end), sign);
      }
    });
    try {
      ReplayPage page(changed);
      page.play(true, 4);
      page.run(0.3);
      page.seek(1.5);
      ++played;
    } catch (const std::exception& error) {
      EXPECT_GT(std::string(error.what()).size(), 10U);
    }
  }
  EXPECT_GT(played, 0);
}

TEST_F(TabReplayTest, StepsThatHaveNoTimeAreDamage) {
  for (const double time : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    int step = 0;
    const auto changed = [&](int which) {
      step = 0;
      return rewritten(file, [&](const std::string& topic, bag::Bytes& data) {
        if (!topic.ends_with("/tick") || step++ != which) return;
        message::Tick tick;
        message::decode(bag::View(data), tick);
        tick.time = time;
        data.clear();
        message::encode(tick, data);
      });
    };
    EXPECT_THAT(words(changed(0), "run.mcap"), HasSubstr("no time")) << time;
    ReplayPage page(changed(1500));
    page.run(0.2);
    EXPECT_THAT(std::string(page.last("notice")["text"]), HasSubstr("no time")) << time;
    page.seek(2.5);
    page.run(0.05);
    EXPECT_EQ(page.force().cast<float>(), forces[2500]) << "what is whole is shown";
  }
}

TEST_F(TabReplayTest, ARunThatSawNothingInACamerasAxesIsShown) {
  ReplayPage page(rewritten(file, [](const std::string& name, bag::Bytes& data) {
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
