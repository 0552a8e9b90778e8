// Files that were made to do harm, and files of other kinds than ours.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include "bag/bags.hpp"
#include "bag/chunk.hpp"
#include "support/folder.hpp"

namespace palpate::bag {
namespace {

// A file that is made by hand, record by record.
struct Forged {
  Bytes bytes{kMagic.begin(), kMagic.end()};

  Forged() { Record(bytes, Op::header).text("ros2").text("forged"); }

  static void channel(Bytes& out) {
    Record(out, Op::channel)
        .numbers(std::uint16_t{1}, std::uint16_t{0})
        .text("/a")
        .text("cdr")
        .words({});
  }
  static void message(Bytes& out, std::uint64_t time, std::uint16_t number = 1) {
    Record(out, Op::message).numbers(number, std::uint32_t{0}, time, time).bytes(view_of("data"));
  }
  void chunk(const std::string& compression, std::uint64_t size, std::uint32_t crc, View packed) {
    Record(bytes, Op::chunk)
        .numbers(std::uint64_t{0}, std::uint64_t{0}, size, crc)
        .text(compression)
        .numbers(std::uint64_t{packed.size()})
        .bytes(packed);
  }
  // Ends the file with a summary, whose CRC is not told.
  void end(const Bytes& summary) {
    Record(bytes, Op::data_end).numbers(std::uint32_t{0});
    const std::uint64_t start = bytes.size();
    bytes.insert(bytes.end(), summary.begin(), summary.end());
    Record(bytes, Op::footer).numbers(start, std::uint64_t{0}, std::uint32_t{0});
    bytes.insert(bytes.end(), kMagic.begin(), kMagic.end());
  }
  [[nodiscard]] std::string write(const test::Folder& folder) const {
    folder.write("forged.mcap", std::string(bytes.begin(), bytes.end()));
    return folder / "forged.mcap";
  }
};

Bytes statistics(std::uint64_t messages, std::uint32_t channels, std::uint32_t chunks) {
  Bytes out;
  Record(out, Op::statistics)
      .numbers(messages, std::uint16_t{0}, channels, std::uint32_t{0}, std::uint32_t{0}, chunks,
               std::uint64_t{0}, std::uint64_t{9})
      .words({});
  return out;
}

void index(Bytes& out, std::uint64_t offset, std::uint64_t length, std::uint64_t rest = 0) {
  Record(out, Op::chunk_index)
      .numbers(std::uint64_t{0}, std::uint64_t{9}, offset, length)
      .words({})
      .numbers(rest)
      .text("")
      .numbers(std::uint64_t{0}, std::uint64_t{0});
}

TEST(McapHostile, ChunkThatWouldGrowBeyondReasonIsNotUnpacked) {
  const test::Folder folder;
  const Bytes zeros(100 << 20);
  for (const std::uint64_t size : {zeros.size(), std::size_t{1} << 40, std::size_t{0} - 1}) {
    Forged forged;
    const Packed honest = pack(View(zeros).first(1 << 20));
    forged.chunk("zstd", size, 0, honest.bytes);
    Forged::channel(forged.bytes);
    Forged::message(forged.bytes, 5);
    McapReader reader(forged.write(folder));
    EXPECT_EQ(all_of(reader).size(), 1u) << "what comes behind is read";
    ASSERT_FALSE(reader.contents().losses.empty());
    EXPECT_NE(reader.contents().losses[0].find("refused"), std::string::npos);
  }
}

TEST(McapHostile, ChunkThatIsNotAsLongAsItSaysIsLost) {
  const test::Folder folder;
  Bytes records;
  Forged::channel(records);
  Forged::message(records, 5);
  const Bytes many(5000);
  for (const std::uint64_t size : {many.size() - 1, many.size() + 1, std::size_t{0}}) {
    Forged forged;
    forged.chunk("zstd", size, 0, pack(many).bytes);
    forged.chunk("", records.size(), 0, records);
    McapReader reader(forged.write(folder));
    EXPECT_EQ(all_of(reader).size(), 1u);
    EXPECT_FALSE(reader.contents().losses.empty());
  }
}

TEST(McapHostile, LengthsThatLeadOutsideEndTheSearchThere) {
  const test::Folder folder;
  for (const std::uint64_t length :
       {std::uint64_t{1} << 63, ~std::uint64_t{0}, std::uint64_t{500}}) {
    Forged forged;
    Forged::channel(forged.bytes);
    Forged::message(forged.bytes, 5);
    forged.bytes.push_back(static_cast<std::uint8_t>(Op::chunk));
    append(forged.bytes, length);
    McapReader reader(forged.write(folder));
    EXPECT_EQ(all_of(reader).size(), 1u);
    EXPECT_EQ(reader.contents().losses.size(), 2u) << "not closed, and cut";
  }
}

TEST(McapHostile, IndexesThatOverlapLoopOrLeadOutsideAreNotFollowed) {
  const test::Folder folder;
  Forged forged;
  Bytes records;
  Forged::channel(records);
  Forged::message(records, 5);
  const std::uint64_t at = forged.bytes.size();
  forged.chunk("", records.size(), 0, records);
  const std::uint64_t length = forged.bytes.size() - at;
  for (const auto& [offset, size, rest] :
       std::vector<std::array<std::uint64_t, 3>>{{at, length, 0},
                                                 {at + 1, length, 0},
                                                 {0, length, 0},
                                                 {at, ~at, at},
                                                 {at, 0, 0},
                                                 {at, length, ~length},
                                                 {~std::uint64_t{0}, 1, 0},
                                                 {at, 1 << 20, 0}}) {
    Forged looped = forged;
    Bytes summary;
    Forged::channel(summary);
    for (int i = 0; i < 3; ++i) index(summary, offset, size, rest);
    const Bytes counts = statistics(1, 1, 3);
    summary.insert(summary.end(), counts.begin(), counts.end());
    looped.end(summary);
    McapReader reader(looped.write(folder));
    const std::size_t read = all_of(reader).size();
    EXPECT_LE(read, 1u) << "once at most";
    EXPECT_TRUE(read == 1 || !reader.contents().losses.empty()) << offset << ", " << size;
  }
}

TEST(McapHostile, SummaryThatLiesOutsideIsNotFollowed) {
  const test::Folder folder;
  for (const std::uint64_t start : {std::uint64_t{1}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    Forged forged;
    Forged::channel(forged.bytes);
    Forged::message(forged.bytes, 5);
    Record(forged.bytes, Op::data_end).numbers(std::uint32_t{0});
    Record(forged.bytes, Op::footer).numbers(start, std::uint64_t{0}, std::uint32_t{0});
    forged.bytes.insert(forged.bytes.end(), kMagic.begin(), kMagic.end());
    McapReader reader(forged.write(folder));
    EXPECT_EQ(all_of(reader).size(), 1u);
    EXPECT_FALSE(reader.contents().losses.empty());
  }
}

TEST(McapHostile, FileWithoutChunksOrSummaryIsRead) {
  const test::Folder folder;
  Forged forged;
  Forged::channel(forged.bytes);
  for (std::uint64_t i = 0; i < 100'000; ++i) Forged::message(forged.bytes, 1000 - i % 1000);
  Record(forged.bytes, Op::data_end).numbers(std::uint32_t{0});
  Record(forged.bytes, Op::footer).numbers(std::uint64_t{0}, std::uint64_t{0}, std::uint32_t{0});
  forged.bytes.insert(forged.bytes.end(), kMagic.begin(), kMagic.end());
  McapReader reader(forged.write(folder));
  EXPECT_EQ(reader.contents().messages, 100'000u);
  EXPECT_TRUE(reader.contents().losses.empty());
  const std::vector<Read> read = all_of(reader);
  EXPECT_EQ(read.size(), 100'000u);
  EXPECT_TRUE(std::ranges::is_sorted(read, {}, &Read::time));
}

TEST(McapHostile, ChunksThatLz4PackedAreRead) {
  const test::Folder folder;
  Bytes records;
  Forged::channel(records);
  for (std::uint64_t i = 0; i < 1000; ++i) Forged::message(records, i);
  Bytes packed(LZ4F_compressFrameBound(records.size(), nullptr));
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), records.data(), records.size(), nullptr));
  Forged forged;
  forged.chunk("lz4", records.size(), crc_of(records), packed);
  forged.chunk("lz4", records.size(), 0, View(packed).first(packed.size() - 20));
  forged.chunk("lz4", records.size() - 1, 0, packed);
  forged.chunk("bz2", records.size(), 0, packed);
  McapReader reader(forged.write(folder));
  EXPECT_EQ(all_of(reader).size(), 1000u);
  EXPECT_EQ(reader.contents().losses.size(), 4u) << "the others, and no end";
}

TEST(McapHostile, MessagesThatNothingDescribesAreLostAndTold) {
  const test::Folder folder;
  Forged forged;
  Bytes records;
  Forged::channel(records);
  Forged::message(records, 5, 7);
  Forged::message(records, 6, 1);
  forged.chunk("", records.size(), 0, records);
  McapReader reader(forged.write(folder));
  EXPECT_EQ(reader.contents().messages, 1u);
  EXPECT_EQ(all_of(reader).size(), 1u);
  ASSERT_EQ(reader.contents().losses.size(), 2u);
  EXPECT_NE(reader.contents().losses[1].find("channel 7"), std::string::npos);
}

TEST(McapHostile, ThousandsOfLossesAreToldInTwentyOneLines) {
  const test::Folder folder;
  Forged forged;
  for (int i = 0; i < 5000; ++i) forged.chunk("zstd", 10, 0, view_of("nonsense"));
  const McapReader reader(forged.write(folder));
  EXPECT_EQ(reader.contents().losses.size(), 21u);
}

TEST(McapHostile, ChunkWithinAChunkIsNotUnpacked) {
  const test::Folder folder;
  Bytes inner;
  Forged::channel(inner);
  Forged::message(inner, 5);
  Forged nested;
  const std::size_t begin = nested.bytes.size();
  nested.chunk("", inner.size(), 0, inner);
  const Bytes chunk(nested.bytes.begin() + static_cast<std::ptrdiff_t>(begin), nested.bytes.end());
  Forged forged;
  forged.chunk("", chunk.size(), 0, chunk);
  EXPECT_TRUE(all_of(forged.write(folder)).empty());
}

}  // namespace
}  // namespace palpate::bag
