// Files that were cut or changed lose what was hit and no more.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "bag/bags.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"

namespace palpate::bag {
namespace {

constexpr int kChunks = 5;
constexpr int kPerChunk = 4;

std::string small_file(const test::Folder& folder, bool compressed = true) {
  McapWriter writer(folder / "small.mcap", {.compressed = compressed});
  write_poses(writer, kChunks, kPerChunk);
  writer.close();
  return contents_of(folder / "small.mcap");
}

// Where each chunk ends in a file.
std::vector<std::size_t> ends_of(const std::string& path) {
  std::vector<std::size_t> ends;
  const McapReader reader(path);
  for (const ChunkSpan& span : reader.contents().chunks) {
    ends.push_back(span.offset + span.length);
  }
  return ends;
}

TEST(McapDamage, FileThatIsCutAtAnyByteLosesTheChunkThatWasCutAlone) {
  const test::Folder folder;
  const std::string whole = small_file(folder);
  const std::vector<std::size_t> ends = ends_of(folder / "small.mcap");
  ASSERT_EQ(ends.size(), static_cast<std::size_t>(kChunks));
  for (std::size_t size = whole.size(); size >= 8; --size) {
    std::filesystem::resize_file(folder / "small.mcap", size);
    McapReader reader(folder / "small.mcap");
    const auto chunks = std::ranges::count_if(ends, [&](std::size_t end) { return end <= size; });
    const std::size_t expected = static_cast<std::size_t>(chunks) * kPerChunk;
    EXPECT_EQ(reader.contents().messages, expected) << "cut to " << size;
    EXPECT_EQ(all_of(reader).size(), expected) << "cut to " << size;
    EXPECT_EQ(reader.contents().closed, size == whole.size()) << size;
    EXPECT_EQ(reader.contents().losses.empty(), size == whole.size()) << size;
  }
}

TEST(McapDamage, AnyByteThatChangesLosesOneChunkAtMostAndNoMessageIsWrong) {
  const test::Folder folder;
  const std::string whole = small_file(folder);
  const std::vector<Read> right = all_of(folder / "small.mcap");
  for (std::size_t at = 8; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x41);
    std::filesystem::remove(folder / "changed.mcap");  // some disks wait where a file is replaced
    folder.write("changed.mcap", changed);
    McapReader reader(folder / "changed.mcap");
    const std::vector<Read> read = all_of(reader);
    EXPECT_GE(read.size(), right.size() - kPerChunk) << "byte " << at;
    for (const Read& each : read) {
      const auto same = [&](const Read& other) {
        return other.time == each.time && other.data == each.data && other.topic == each.topic;
      };
      EXPECT_TRUE(std::ranges::any_of(right, same)) << "byte " << at;
    }
    EXPECT_TRUE(read.size() == right.size() || !reader.contents().losses.empty()) << at;
  }
}

TEST(McapDamage, LossIsToldWithItsPlaceAndItsReason) {
  const test::Folder folder;
  std::string bytes = small_file(folder, false);
  const std::size_t chunk = McapReader(folder / "small.mcap").contents().chunks[2].offset;
  bytes[chunk + 100] = static_cast<char>(bytes[chunk + 100] ^ 1);
  folder.write("changed.mcap", bytes);
  McapReader reader(folder / "changed.mcap");
  EXPECT_EQ(all_of(reader).size(), static_cast<std::size_t>((kChunks - 1) * kPerChunk));
  const std::vector<std::string>& losses = reader.contents().losses;
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_TRUE(losses[0].starts_with(fmt::format("messages in bytes {} to ", chunk))) << losses[0];
  EXPECT_TRUE(test::contains(losses[0], "CRC")) << losses[0];
}

TEST(McapDamage, DamagedSummaryIsNotUsed) {
  const test::Folder folder;
  std::string bytes = small_file(folder);
  bytes[bytes.size() - 60] = static_cast<char>(bytes[bytes.size() - 60] ^ 1);
  folder.write("changed.mcap", bytes);
  McapReader reader(folder / "changed.mcap");
  EXPECT_EQ(reader.contents().messages, static_cast<std::uint64_t>(kChunks * kPerChunk));
  ASSERT_EQ(reader.contents().losses.size(), 1u);
  EXPECT_TRUE(test::contains(reader.contents().losses[0], "summary"));
  EXPECT_EQ(all_of(reader).size(), static_cast<std::size_t>(kChunks * kPerChunk));
}

TEST(McapDamage, AttachmentThatChangedIsRefusedAndTheMessagesAreRead) {
  const test::Folder folder;
  {
    McapWriter writer(folder / "run.mcap");
    write_poses(writer, 1, 10);
    writer.attach({"notes", "text/plain", 0, 0, Bytes(1000, 'n')});
    writer.close();
  }
  std::string bytes = contents_of(folder / "run.mcap");
  bytes[bytes.find("nnnn") + 100] = 'm';
  folder.write("run.mcap", bytes);
  McapReader reader(folder / "run.mcap");
  EXPECT_THROW((void)reader.attachment(0), Error);
  EXPECT_EQ(all_of(reader).size(), 10u);
}

}  // namespace
}  // namespace palpate::bag
