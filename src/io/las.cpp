// Reads LAS files: the header, then positions, intensities and colours of points.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/cloud_builder.hpp"
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
    const std::size_t header_size = load_as<std::uint16_t>(data_ + kHeaderSize);
    if (header_size < kSmallest || header_.points_offset < header_size) {
      wrong(kHeaderSize, fmt::format("a header of {} bytes, but points from byte {}", header_size,
                                     header_.points_offset));
    }
  }

  void read_transform() {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t step = sizeof(double) * static_cast<std::size_t>(axis);
      header_.scale[axis] = load_as<double>(data_ + kScale + step);
      header_.offset[axis] = load_as<double>(data_ + kOffset + step);
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
    if (count > 0) header_.points = count;  // some writers of 1.4 fill in the old field alone
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

std::string LasHeader::name() const {
  return fmt::format("{} 1.{}, point format {}", compressed ? "LAZ" : "LAS", minor_version, format);
}

LasHeader read_las_header(const Input& input) {
  return LasHeaderParser(input).run();
}

namespace {

constexpr std::size_t kIntensity = 12;  // bytes into a record of every format
constexpr std::size_t kFlags = 15;

class LasReader {
 public:
  LasReader(const Input& input, const LasHeader& header)
      : input_(input),
        header_(header),
        scale_(input.options.scale * header.scale),
        offset_(input.options.scale * header.offset),
        withheld_(header.withheld_mask()) {}

  CloudFile run() {
    check_size();
    CloudFile file;
    file.format = header_.name();
    file.declared = header_.points;
    file.cloud.origin = choose_origin(header_.points, [&](std::size_t i) { return point(i); });
    read_positions(file.cloud);
    file.dropped = header_.points - file.cloud.size();
    check_not_empty(input_, file.cloud.size(), file.dropped);
    return file;
  }

 private:
  void check_size() const {
    const std::size_t begin = std::min(header_.points_offset, input_.bytes.size());
    const std::size_t present = (input_.bytes.size() - begin) / header_.record_size;
    if (present >= header_.points) return;
    fail_at_byte(input_, input_.bytes.size(),
                 fmt::format("the file ends after {} of {} points", present, header_.points),
                 "Download or copy it again; \"lasinfo -repair_counters\" (LAStools) makes the "
                 "present points usable");
  }

  const std::byte* record(std::size_t i) const {
    return input_.bytes.data() + header_.points_offset + i * header_.record_size;
  }

  Eigen::Vector3d point(std::size_t i) const {
    const std::byte* at = record(i);
    const Eigen::Vector3d numbers(load_as<std::int32_t>(at), load_as<std::int32_t>(at + 4),
                                  load_as<std::int32_t>(at + 8));
    return numbers.cwiseProduct(scale_) + offset_;
  }

  void read_positions(PointCloud& cloud) const {
    cloud.positions.reserve(header_.points);
    cloud.intensities.reserve(header_.points);
    const std::optional<std::size_t> color_offset = header_.color_offset();
    std::vector<std::array<float, 3>> colors;
    if (color_offset) colors.reserve(header_.points);
    Progress progress(input_.options, header_.points);
    float brightest = 0;
    float most_color = 0;
    for (std::size_t i = 0; i < header_.points; ++i) {
      progress.at(i);
      const std::byte* at = record(i);
      const Eigen::Vector3d p = point(i);
      if ((at[kFlags] & withheld_) != std::byte{0} || !is_usable(p)) continue;
      cloud.positions.emplace_back((p - cloud.origin).cast<float>());
      cloud.intensities.push_back(load_as<std::uint16_t>(at + kIntensity));
      brightest = std::max(brightest, cloud.intensities.back());
      if (color_offset) {
        colors.push_back(color(at + *color_offset));
        most_color = std::max({most_color, colors.back()[0], colors.back()[1], colors.back()[2]});
      }
    }
    if (brightest == 0) cloud.intensities = {};
    if (most_color > 0) cloud.colors = byte_colors(colors, ColorScale::guess_integer);
  }

  static std::array<float, 3> color(const std::byte* at) {
    return {static_cast<float>(load_as<std::uint16_t>(at)),
            static_cast<float>(load_as<std::uint16_t>(at + 2)),
            static_cast<float>(load_as<std::uint16_t>(at + 4))};
  }

  const Input& input_;
  const LasHeader& header_;
  Eigen::Vector3d scale_;   // m
  Eigen::Vector3d offset_;  // m
  std::byte withheld_;
};

}  // namespace

CloudFile read_las(const Input& input) {
  const LasHeader header = read_las_header(input);
  return header.compressed ? read_laz(input, header) : LasReader(input, header).run();
}

}  // namespace palpate::io
