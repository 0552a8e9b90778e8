#include "io/las_header.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "io/number.hpp"

namespace palpate::io {
namespace {

// Offsets of the header's fields, from the ASPRS specification.
constexpr std::size_t kMajor = 24;
constexpr std::size_t kMinor = 25;
constexpr std::size_t kHeaderSize = 94;
constexpr std::size_t kPointsOffset = 96;
constexpr std::size_t kFormat = 104;
constexpr std::size_t kRecordSize = 105;
constexpr std::size_t kLegacyCount = 107;
constexpr std::size_t kScale = 131;
constexpr std::size_t kOffset = 155;
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
      wrong(kMajor, fmt::format("LAS version {}.{} is not known", major, header_.minor_version));
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
      wrong(kFormat, fmt::format("LAS point format {} is not known", header_.format));
    }
    header_.record_size = load_as<std::uint16_t>(data_ + kRecordSize);
    if (header_.record_size < kRecordSizes[static_cast<std::size_t>(header_.format)]) {
      wrong(kRecordSize, fmt::format("point records of {} bytes are too short for format {}",
                                     header_.record_size, header_.format));
    }
    header_.points_offset = load_as<std::uint32_t>(data_ + kPointsOffset);
    const std::size_t header_size = load_as<std::uint16_t>(data_ + kHeaderSize);
    if (header_size < kSmallest || header_.points_offset < header_size) {
      wrong(kHeaderSize, fmt::format("a header of {} bytes with points from byte {} on",
                                     header_size, header_.points_offset));
    }
  }

  void read_transform() {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t step = sizeof(double) * static_cast<std::size_t>(axis);
      header_.scale[axis] = load_as<double>(data_ + kScale + step);
      header_.offset[axis] = load_as<double>(data_ + kOffset + step);
      if (!std::isfinite(header_.scale[axis]) || header_.scale[axis] == 0) {
        wrong(kScale + step, fmt::format("a coordinate scale of {}", header_.scale[axis]));
      }
      if (!std::isfinite(header_.offset[axis])) {
        wrong(kOffset + step, fmt::format("a coordinate offset of {}", header_.offset[axis]));
      }
    }
  }

  void read_count() {
    header_.points = load_as<std::uint32_t>(data_ + kLegacyCount);
    if (header_.minor_version < 4) return;
    const std::uint64_t count = load_as<std::uint64_t>(data_ + kCount14);
    if (count > 0) header_.points = count;  // some writers of 1.4 fill in the old field alone
  }

  [[noreturn]] void wrong(std::size_t offset, std::string_view what) const {
    fail_at_byte(input_, offset, what, "The file is damaged, or no LAS file: export it again");
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

std::string LasHeader::name() const {
  return fmt::format("{} 1.{}, point format {}", compressed ? "LAZ" : "LAS", minor_version, format);
}

LasHeader read_las_header(const Input& input) {
  return LasHeaderParser(input).run();
}

}  // namespace palpate::io
