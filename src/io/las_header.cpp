// Reads headers and variable length records of LAS files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

// Offsets of the header's fields, from the ASPRS specification.
constexpr std::size_t kMajor = 24;
constexpr std::size_t kMinor = 25;
constexpr std::size_t kHeaderSize = 94;
constexpr std::size_t kPointsOffset = 96;
constexpr std::size_t kRecords = 100;
constexpr std::size_t kFormat = 104;
constexpr std::size_t kRecordSize = 105;
constexpr std::size_t kLegacyCount = 107;
constexpr std::size_t kScale = 131;
constexpr std::size_t kOffset = 155;
constexpr std::size_t kBounds = 179;  // highest and lowest x, then y, then z
constexpr std::size_t kSmallest = 227;
constexpr std::size_t kCount14 = 247;
constexpr std::size_t kSmallest14 = 375;

constexpr std::array<std::size_t, 11> kRecordSizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

class LasHeaderParser {
 public:
  explicit LasHeaderParser(const Input& input) : input_(input), data_(input.bytes.data()) {}

  LasHeader run() {
    need(kSmallest);
    header_.minor_version = std::to_integer<int>(data_[kMinor]);
    const int major = std::to_integer<int>(data_[kMajor]);
    if (major != 1 || header_.minor_version > 4) {
      wrong(kMajor,
            fmt::format("LAS version {}.{} is not supported", major, header_.minor_version));
    }
    if (header_.minor_version == 4) need(kSmallest14);
    read_layout();
    read_transform();
    read_count();
    return header_;
  }

 private:
  void need(std::size_t size) const {
    if (input_.bytes.size() >= size) return;
    fail_at_byte(input_, input_.bytes.size(),
                 fmt::format("the file ends inside its LAS header of {} bytes", size),
                 "Fetch the file again");
  }

  void read_layout() {
    const auto format = std::to_integer<unsigned>(data_[kFormat]);
    header_.compressed = (format & 0xC0U) != 0;  // LASzip marks the format byte
    header_.format = static_cast<int>(format & 0x3FU);
    if (header_.format > 10) {
      wrong(kFormat, fmt::format("LAS point format {} is not supported", header_.format));
    }
    header_.record_size = load_as<std::uint16_t>(data_ + kRecordSize);
    if (header_.record_size < kRecordSizes[static_cast<std::size_t>(header_.format)]) {
      wrong(kRecordSize, fmt::format("point records of {} bytes are too short for format {}",
                                     header_.record_size, header_.format));
    }
    header_.points_offset = load_as<std::uint32_t>(data_ + kPointsOffset);
    header_.size = load_as<std::uint16_t>(data_ + kHeaderSize);
    header_.records = load_as<std::uint32_t>(data_ + kRecords);
    if (header_.size < kSmallest || header_.points_offset < header_.size) {
      wrong(kHeaderSize, fmt::format("a header of {} bytes, but points from byte {}", header_.size,
                                     header_.points_offset));
    }
    need(header_.size);
  }

  void read_transform() {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t step = sizeof(double) * static_cast<std::size_t>(axis);
      header_.scale[axis] = load_as<double>(data_ + kScale + step);
      header_.offset[axis] = load_as<double>(data_ + kOffset + step);
      header_.upper[axis] = load_as<double>(data_ + kBounds + 2 * step);
      header_.lower[axis] = load_as<double>(data_ + kBounds + 2 * step + sizeof(double));
      if (!std::isfinite(header_.scale[axis]) || header_.scale[axis] == 0) {
        wrong(kScale + step, fmt::format("invalid coordinate scale of {}", header_.scale[axis]));
      }
      if (!std::isfinite(header_.offset[axis])) {
        wrong(kOffset + step, fmt::format("invalid coordinate offset of {}", header_.offset[axis]));
      }
    }
  }

  void read_count() {
    header_.points = load_as<std::uint32_t>(data_ + kLegacyCount);
    if (header_.minor_version < 4) return;
    const std::uint64_t count = load_as<std::uint64_t>(data_ + kCount14);
    if (count == 0) return;  // some writers of 1.4 fill in the old field alone
    // More than memory addresses: too many for any file's bytes, which is reported later.
    constexpr std::uint64_t kMost = std::numeric_limits<std::size_t>::max();
    header_.points = static_cast<std::size_t>(std::min(count, kMost));
  }

  [[noreturn]] void wrong(std::size_t offset, std::string_view what) const {
    fail_at_byte(input_, offset, what, "The file is damaged or not a LAS file: export it again");
  }

  const Input& input_;
  const std::byte* data_;
  LasHeader header_;
};

}  // namespace

std::optional<std::size_t> LasHeader::color_offset() const {
  switch (format) {
    case 2:
      return 20;
    case 3:
    case 5:
      return 28;
    case 7:
    case 8:
    case 10:
      return 30;
    default:
      return {};
  }
}

std::byte LasHeader::withheld_mask() const {
  if (minor_version == 0) return std::byte{0};
  return extended() ? std::byte{4} : std::byte{128};
}

std::size_t LasHeader::extra_bytes() const {
  return record_size - kRecordSizes[static_cast<std::size_t>(format)];
}

std::string LasHeader::name() const {
  return fmt::format("{} 1.{}, point format {}", compressed ? "LAZ" : "LAS", minor_version, format);
}

LasHeader read_las_header(const Input& input) {
  return LasHeaderParser(input).run();
}

Bytes read_las_head(const OpenFile& file) {
  Bytes start = file.read(0, std::min(file.size(), kSmallest14));
  if (start.size() < kSmallest) return start;
  const std::size_t points = load_as<std::uint32_t>(start.span().data() + kPointsOffset);
  return points > start.size() ? file.read(0, std::min(file.size(), points)) : std::move(start);
}

std::optional<LasRecord> find_record(const Input& input, const LasHeader& header,
                                     std::string_view user, int id) {
  constexpr std::size_t kUser = 2;  // bytes into a record's own header
  constexpr std::size_t kUserLength = 16;
  constexpr std::size_t kId = 18;
  constexpr std::size_t kLength = 20;
  constexpr std::size_t kOwnHeader = 54;
  const std::size_t end = std::min(header.points_offset, input.bytes.size());
  std::size_t at = header.size;
  for (std::size_t i = 0; i < header.records && at + kOwnHeader <= end; ++i) {
    const std::byte* data = input.bytes.data() + at;
    const std::string_view name = input.text().substr(at + kUser, kUserLength);
    const std::size_t size = load_as<std::uint16_t>(data + kLength);
    at += kOwnHeader;
    if (name.substr(0, name.find('\0')) == user && load_as<std::uint16_t>(data + kId) == id &&
        size <= end - at) {
      return LasRecord{at, size};
    }
    at += size;
  }
  return std::nullopt;
}

}  // namespace palpate::io
