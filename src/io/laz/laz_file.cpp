// Reads what leads to the chunks of a LAZ file: the record that states how they are compressed, and
// the table of their sizes.
#include "io/laz/laz_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/file_bytes.hpp"
#include "io/laz/range_decoder.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io::laz {
namespace {

constexpr std::string_view kIncomplete = "Download it again: it is incomplete or damaged";
constexpr std::string_view kRewrite =
    "Rewrite it with \"pdal translate IN.laz OUT.laz\" or \"laszip\"";

// Offsets into the record "laszip encoded".
constexpr std::size_t kCompressor = 0;
constexpr std::size_t kChunkPoints = 12;
constexpr std::size_t kItemCount = 32;
constexpr std::size_t kItems = 34;
constexpr std::size_t kItemSize = 6;
constexpr std::uint32_t kVaries = 0xFFFFFFFFU;

// A part of each point: what it is, its bytes, and the version of its compression.
struct Item {
  std::uint16_t type;
  std::uint16_t size;
  std::uint16_t version;
};

// The items of a point format, in the numbers of LASzip.
std::vector<Item> items_of(const LasHeader& header) {
  std::vector<Item> items;
  if (header.extended()) {
    items.push_back({10, 30, 3});
    if (header.format == 7) items.push_back({11, 6, 3});
    if (header.format == 8) items.push_back({12, 8, 3});
  } else {
    items.push_back({6, 20, 2});
    if (header.format == 1 || header.format == 3) items.push_back({7, 8, 2});
    if (header.color_offset()) items.push_back({8, 6, 2});
  }
  if (const std::size_t extra = header.extra_bytes(); extra > 0) {
    const bool extended = header.extended();
    items.push_back({static_cast<std::uint16_t>(extended ? 14 : 0),
                     static_cast<std::uint16_t>(extra),
                     static_cast<std::uint16_t>(extended ? 3 : 2)});
  }
  return items;
}

void check_items(const Input& input, const LasHeader& header, std::size_t record,
                 std::size_t length) {
  const std::byte* data = input.bytes.data() + record;
  const std::vector<Item> expected = items_of(header);
  const std::size_t count = load_as<std::uint16_t>(data + kItemCount);
  if (count != expected.size() || kItems + count * kItemSize > length) {
    fail_at_byte(input, record + kItemCount,
                 fmt::format("points of {} compressed parts, but format {} has {}", count,
                             header.format, expected.size()),
                 kRewrite);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = kItems + i * kItemSize;
    const auto type = load_as<std::uint16_t>(data + at);
    const auto size = load_as<std::uint16_t>(data + at + 2);
    const auto version = load_as<std::uint16_t>(data + at + 4);
    if (type == expected[i].type && size == expected[i].size && version == expected[i].version) {
      continue;
    }
    fail_at_byte(
        input, record + at,
        fmt::format("a part of type {}, {} bytes and version {}, which is not read: "
                    "expected were {}, {} and {}",
                    type, size, version, expected[i].type, expected[i].size, expected[i].version),
        kRewrite);
  }
}

}  // namespace

bool can_hold(const LasHeader& header, std::size_t bytes, std::size_t points) {
  return bytes >= header.record_size && points <= largest_unpacked(bytes) / sizeof(LasPoint);
}

void require_whole(const Input& input, std::size_t offset, std::string_view what,
                   std::size_t decoded, std::size_t points) {
  if (decoded == points) return;
  fail_at_byte(input, offset,
               fmt::format("{} ends inside its point {} of {}", what, decoded + 1, points),
               "Download the file again; \"lasinfo\" or \"pdal info\" tests it");
}

std::optional<std::size_t> read_chunk_size(const Input& input, const LasHeader& header) {
  if (header.format > 8 || header.format == 4 || header.format == 5) {
    fail(input,
         fmt::format("point format {} holds waveforms, which are not read from LAZ", header.format),
         "Write it as LAS: \"pdal translate IN.laz OUT.las\"");
  }
  const auto found = find_record(input, header, "laszip encoded", 22204);
  if (!found || found->size < kItems) {
    fail(input, "marked as LAZ, but it does not say how it is compressed", kIncomplete);
  }
  const std::byte* data = input.bytes.data() + found->offset;
  const int compressor = load_as<std::uint16_t>(data + kCompressor);
  if (compressor != (header.extended() ? 3 : 2)) {
    fail_at_byte(input, found->offset + kCompressor,
                 fmt::format("point format {} compressed by compressor {} of LASzip, which is not "
                             "read",
                             header.format, compressor),
                 kRewrite);
  }
  check_items(input, header, found->offset, found->size);
  const auto points = load_as<std::uint32_t>(data + kChunkPoints);
  if (points == 0) {
    fail_at_byte(input, found->offset + kChunkPoints, "chunks of 0 points", kIncomplete);
  }
  if (points == kVaries) return std::nullopt;
  return points;
}

namespace {

class ChunkTableReader {
 public:
  ChunkTableReader(const Input& head, const LasHeader& header, const Parts& file)
      : head_(head),
        header_(header),
        size_(file.size),
        file_(file),
        chunk_size_(read_chunk_size(head, header)) {}

  std::vector<Chunk> run() {
    find_table();
    const std::size_t count = load_as<std::uint32_t>(file_.read(table_ + 4, 4).span().data());
    const std::size_t most = (table_ - begin()) / header_.record_size;
    if (count > most) {
      wrong(fmt::format("a table of {} chunks, but {} bytes are too few for them", count,
                        table_ - begin()));
    }
    read_sizes(count);
    return std::move(chunks_);
  }

 private:
  // Bytes before the first chunk: behind the offset of the table.
  [[nodiscard]] std::size_t begin() const { return header_.points_offset + 8; }

  void find_table() {
    if (begin() > size_) fail_at_byte(head_, size_, "the file ends before its points", kIncomplete);
    auto offset = load_as<std::uint64_t>(file_.read(header_.points_offset, 8).span().data());
    if (offset == ~std::uint64_t{0}) {  // a writer that could not go back to write it
      offset = load_as<std::uint64_t>(file_.read(size_ - 8, 8).span().data());
    }
    if (offset < begin() || offset > size_ - 8) {
      fail_at_byte(
          head_, header_.points_offset,
          fmt::format("the chunk table at byte {} is outside the file of {} bytes", offset, size_),
          kIncomplete);
    }
    table_ = offset;
  }

  void read_sizes(std::size_t count) {
    // Bytes of a chunk's two numbers at most: 54 bits each for symbols and what is raw.
    constexpr std::size_t kLongestEntry = 16;
    const std::size_t rest = size_ - table_ - 8;
    const Bytes table = file_.read(table_ + 8, std::min(rest, kLongestEntry * (count + 1)));
    RangeDecoder in(table.span());
    NumberModel sizes(32, 2);
    Chunk chunk{.offset = begin()};
    std::uint32_t varying = 0;
    std::uint32_t bytes = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!chunk_size_) varying = sizes.decode(in, varying, 0);
      bytes = sizes.decode(in, bytes, 1);
      if (in.overran()) wrong(fmt::format("the file ends inside the sizes of chunk {}", i + 1));
      const std::size_t left = header_.points - chunk.first;
      chunk.points = chunk_size_ ? std::min(*chunk_size_, left) : varying;
      chunk.bytes = bytes;
      check(chunk, i);
      chunks_.push_back(chunk);
      chunk.offset += chunk.bytes;
      chunk.first += chunk.points;
    }
    if (chunk.first != header_.points) {
      wrong(fmt::format("{} points in {} chunks, but the header announces {}", chunk.first, count,
                        header_.points));
    }
  }

  void check(const Chunk& chunk, std::size_t i) const {
    if (chunk.bytes > table_ - chunk.offset) {
      wrong(fmt::format("chunk {} of {} bytes at byte {} reaches into the table", i + 1,
                        chunk.bytes, chunk.offset));
    }
    if (chunk.points > header_.points - chunk.first) {
      wrong(fmt::format("chunk {} ends with point {}, but the header announces {}", i + 1,
                        chunk.first + chunk.points, header_.points));
    }
    if (chunk.points > 0 && !can_hold(header_, chunk.bytes, chunk.points)) {
      wrong(fmt::format("chunk {} of {} points has {} bytes, which cannot hold them", i + 1,
                        chunk.points, chunk.bytes));
    }
  }

  [[noreturn]] void wrong(std::string_view what) const {
    fail_at_byte(head_, table_, what, kIncomplete);
  }

  const Input& head_;
  const LasHeader& header_;
  std::size_t size_;  // of the file, bytes
  const Parts& file_;
  std::optional<std::size_t> chunk_size_;  // points
  std::size_t table_ = 0;                  // its offset, bytes
  std::vector<Chunk> chunks_;
};

}  // namespace

std::vector<Chunk> read_chunk_table(const Input& head, const LasHeader& header, const Parts& file) {
  return ChunkTableReader(head, header, file).run();
}

std::vector<Chunk> read_chunk_table(const Input& input, const LasHeader& header) {
  return read_chunk_table(input, header, parts_of(input.bytes));
}

}  // namespace palpate::io::laz
