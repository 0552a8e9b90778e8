// A bit that flips anywhere in a bag is found, and what is whole is called that.
#include "bag/mcap_check.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <random>

#include "bag/bags.hpp"
#include "bag/chunk.hpp"
#include "bag/mcap_facts.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"

namespace palpate::bag {
namespace {

constexpr int kFlips = 300;

struct Kind {
  bool compressed = true;
  bool data_crc = true;
  bool summary_crc = true;
};

// What --check finds.
std::vector<std::string> damage_of(const std::string& path, std::vector<Read>& messages) {
  McapReader reader(path);
  messages = all_of(reader);
  Contents contents = reader.contents();
  check(RandomFile(path), contents);
  return contents.losses;
}

// Takes out a CRC that lies in the last `behind` bytes of a file.
void clear_crc(std::string& bytes, std::size_t behind) {
  bytes.replace(bytes.size() - behind, sizeof(std::uint32_t), sizeof(std::uint32_t), '\0');
}

// A bag with all that the writer writes: two topics, chunks, an attachment, metadata.
std::string bag_of(const Kind& kind, const test::Folder& folder) {
  const std::string path = folder / "whole.mcap";
  {
    McapWriter writer(path, {.compressed = kind.compressed});
    write_poses(writer, 2, 4);
    const auto joys = writer.add_topic<message::Joy>("/hand/joy");
    for (std::uint64_t i = 0; i < 6; ++i) writer.write(joys, {kNoon + i, kNoon}, message::Joy{});
    writer.attach({"setup.toml", "application/toml", kNoon, kNoon, Bytes(40, 'a')});
    writer.add({"palpate", {{"made", "here"}}});
    writer.close();
  }
  std::string bytes = contents_of(path);
  const std::size_t footer = kFooter + kMagic.size();
  std::uint64_t summary = 0;
  std::memcpy(&summary, bytes.data() + bytes.size() - footer + kRecordHead, sizeof(summary));
  if (!kind.data_crc) clear_crc(bytes, bytes.size() - summary + sizeof(std::uint32_t));
  if (!kind.summary_crc) clear_crc(bytes, kMagic.size() + sizeof(std::uint32_t));
  folder.write("whole.mcap", bytes);
  return bytes;
}

struct Flip {
  std::size_t at = 0;
  int bit = 0;
};

// Flips bits one at a time, and gives those of which nothing is told.
std::vector<Flip> silent_flips(const Kind& kind, unsigned seed) {
  const test::Folder folder;
  const std::string whole = bag_of(kind, folder);
  std::vector<Read> read;
  const std::vector<std::string> none = damage_of(folder / "whole.mcap", read);
  EXPECT_TRUE(none.empty()) << none[0];
  EXPECT_EQ(read.size(), 14u);
  std::mt19937 random(seed);
  std::vector<Flip> silent;
  for (int i = 0; i < kFlips; ++i) {
    const Flip flip{kMagic.size() + random() % (whole.size() - kMagic.size()),
                    static_cast<int>(random() % 8)};
    std::string changed = whole;
    changed[flip.at] = static_cast<char>(changed[flip.at] ^ (1 << flip.bit));
    std::filesystem::remove(folder / "changed.mcap");  // some disks wait where a file is replaced
    folder.write("changed.mcap", changed);
    if (damage_of(folder / "changed.mcap", read).empty()) silent.push_back(flip);
  }
  return silent;
}

// Has this byte no meaning that anything else in the file repeats? These are the words of the
// header and of metadata, and the number of a schema's copy in the summary: a copy that no channel
// names is nobody's.
bool is_free(const std::string& bytes, std::size_t at) {
  bool in_summary = false;
  bool is_free = false;
  each_record(
      view_of(bytes).subspan(kMagic.size(), bytes.size() - 2 * kMagic.size()),
      [&](Op op, View content, std::size_t offset) {
        in_summary = in_summary || op == Op::data_end;
        const std::size_t begin = kMagic.size() + offset + kRecordHead;
        const bool words = op == Op::header || op == Op::metadata;
        const std::size_t size = words ? content.size() : op == Op::schema && in_summary ? 2 : 0;
        is_free = is_free || (at >= begin && at < begin + size);
      });
  return is_free;
}

class FlippedBit : public testing::TestWithParam<unsigned> {};

TEST_P(FlippedBit, IsFoundWhereverItIs) {
  for (const bool compressed : {false, true}) {
    for (const Flip& flip : silent_flips({.compressed = compressed}, GetParam())) {
      ADD_FAILURE() << "byte " << flip.at << " bit " << flip.bit << " compressed " << compressed;
    }
  }
}

TEST_P(FlippedBit, IsFoundByIndexesAndCountsWhereNoChecksumIsGiven) {
  const test::Folder folder;
  for (const bool summary_crc : {false, true}) {
    const Kind kind{.compressed = false, .data_crc = false, .summary_crc = summary_crc};
    const std::string bytes = bag_of(kind, folder);
    for (const Flip& flip : silent_flips(kind, GetParam())) {
      EXPECT_TRUE(is_free(bytes, flip.at)) << "byte " << flip.at << " bit " << flip.bit;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FlippedBit, testing::Range(1u, 6u));

TEST(McapCheck, NamesWhatDiffersFromWhat) {
  const test::Folder folder;
  std::string bytes = bag_of({.data_crc = false, .summary_crc = false}, folder);
  const ChunkSpan chunk = McapReader(folder / "whole.mcap").contents().chunks[0];
  ++bytes[chunk.offset + kRecordHead];                         // its first message's time
  ++bytes[chunk.offset + chunk.length + kRecordHead + 2 + 4];  // a message's time in the index
  folder.write("changed.mcap", bytes);
  std::vector<Read> messages;
  const std::vector<std::string> losses = damage_of(folder / "changed.mcap", messages);
  EXPECT_EQ(messages.size(), 14u);
  ASSERT_EQ(losses.size(), 3u);
  EXPECT_EQ(losses[0],
            fmt::format("the chunk at byte {}: it says that its first message is of time "
                        "{}, and {} is there",
                        chunk.offset, kNoon + 1, kNoon));
  EXPECT_EQ(losses[1],
            fmt::format("the message index at byte {} does not lead to the 4 messages of "
                        "channel 1 in its chunk",
                        chunk.offset + chunk.length));
  EXPECT_TRUE(losses[2].starts_with(fmt::format(
      "the summary's index of the chunk at byte {}: it says that it begins at time", chunk.offset)))
      << losses[2];
}

TEST(McapCheck, MessageIsFoundThatNoIndexLeadsTo) {
  const test::Folder folder;
  std::string bytes = bag_of({.data_crc = false}, folder);
  const ChunkSpan chunk = McapReader(folder / "whole.mcap").contents().chunks[1];
  bytes[chunk.offset + chunk.length] = static_cast<char>(kPrivate);  // the index is somebody's own
  folder.write("changed.mcap", bytes);
  std::vector<Read> messages;
  const std::vector<std::string> losses = damage_of(folder / "changed.mcap", messages);
  ASSERT_FALSE(losses.empty());
  EXPECT_TRUE(test::contains(losses[0], "message indexes lie elsewhere")) << losses[0];
}

}  // namespace
}  // namespace palpate::bag
