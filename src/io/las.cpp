// Reads the points of LAS and LAZ files: positions, intensities and colours.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/las_coordinates.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

LasPoint las_point(const LasHeader& header, const std::byte* record) {
  constexpr std::size_t kIntensity = 12;  // bytes into a record of every format
  constexpr std::size_t kFlags = 15;
  LasPoint point;
  for (std::size_t k = 0; k < 3; ++k) point.number[k] = load_as<std::int32_t>(record + 4 * k);
  point.intensity = load_as<std::uint16_t>(record + kIntensity);
  point.withheld = (record[kFlags] & header.withheld_mask()) != std::byte{0};
  point.color = {};
  if (const std::optional<std::size_t> offset = header.color_offset()) {
    for (std::size_t k = 0; k < 3; ++k) {
      point.color[k] = load_as<std::uint16_t>(record + *offset + 2 * k);
    }
  }
  return point;
}

namespace {

// Does the header declare that other things follow the points: waveforms, or more records?
bool has_more_behind(const Input& input, const LasHeader& header) {
  constexpr std::size_t kWaveforms = 227;  // bytes into the header: where they begin, from 1.3 on
  constexpr std::size_t kRecords14 = 243;  // and how many records follow the points, from 1.4 on
  const std::byte* data = input.bytes.data();
  if (header.minor_version >= 3 && header.size >= kWaveforms + sizeof(std::uint64_t) &&
      load_as<std::uint64_t>(data + kWaveforms) != 0) {
    return true;
  }
  return header.minor_version >= 4 && load_as<std::uint32_t>(data + kRecords14) != 0;
}

// Records behind as many as the header declares, if whole ones fill the file from there.
std::size_t points_behind(const Input& input, const LasHeader& header) {
  const std::size_t size = input.bytes.size();
  const std::size_t begin = std::min(header.points_offset, size);
  const std::size_t bytes = size - begin;
  if (header.compressed || bytes % header.record_size != 0) return 0;
  const std::size_t present = bytes / header.record_size;
  return has_more_behind(input, header) || present < header.points ? 0 : present - header.points;
}

// Makes a cloud of points, which `point_at` gives by their number.
template <class PointAt>
class LasReader {
 public:
  // `before`: work that is done already, in points.
  LasReader(const Input& input, const LasHeader& header, const PointAt& point_at,
            std::size_t before = 0)
      : input_(input),
        header_(header),
        point_at_(point_at),
        before_(before),
        scale_(input.scale().cwiseProduct(header.scale)),
        offset_(input.scale().cwiseProduct(header.offset)) {}

  CloudFile run() {
    CloudFile file;
    file.format = header_.name() + unused(points_behind(input_, header_));
    file.unit = input_.unit;
    file.declared = header_.points;
    file.cloud.origin =
        choose_origin(header_.points, [&](std::size_t i) { return position(point_at_(i)); });
    read_points(file.cloud);
    file.dropped = header_.points - file.cloud.size();
    check_not_empty(input_, file.cloud.size(), file.dropped);
    return file;
  }

 private:
  Eigen::Vector3d position(const LasPoint& point) const {
    const Eigen::Vector3d numbers(point.number[0], point.number[1], point.number[2]);
    return numbers.cwiseProduct(scale_) + offset_;
  }

  void read_points(PointCloud& cloud) const {
    cloud.positions.reserve(header_.points);
    cloud.intensities.reserve(header_.points);
    const bool has_colors = header_.color_offset().has_value();
    std::vector<std::array<float, 3>> colors;
    if (has_colors) colors.reserve(header_.points);
    Progress progress(input_.options, before_ + header_.points);
    float brightest = 0;
    float most_color = 0;
    for (std::size_t i = 0; i < header_.points; ++i) {
      progress.at(before_ + i);
      const LasPoint point = point_at_(i);
      const Eigen::Vector3d p = position(point);
      if (point.withheld || !is_usable(p)) continue;
      cloud.positions.emplace_back((p - cloud.origin).template cast<float>());
      cloud.intensities.push_back(point.intensity);
      brightest = std::max(brightest, cloud.intensities.back());
      if (has_colors) {
        colors.push_back({static_cast<float>(point.color[0]), static_cast<float>(point.color[1]),
                          static_cast<float>(point.color[2])});
        most_color = std::max({most_color, colors.back()[0], colors.back()[1], colors.back()[2]});
      }
    }
    if (brightest == 0) cloud.intensities = {};
    if (most_color > 0) cloud.colors = byte_colors(colors, ColorScale::guess_integer);
  }

  const Input& input_;
  const LasHeader& header_;
  const PointAt& point_at_;
  std::size_t before_;
  Eigen::Vector3d scale_;   // m
  Eigen::Vector3d offset_;  // m
};

void check_size(const Input& input, const LasHeader& header) {
  const std::size_t begin = std::min(header.points_offset, input.bytes.size());
  const std::size_t present = (input.bytes.size() - begin) / header.record_size;
  const bool uncounted = header.points == 0 && points_behind(input, header) > 0;
  if (present >= header.points && !uncounted) return;
  fail_at_byte(input, input.bytes.size(),
               uncounted
                   ? fmt::format("the header declares no points, but {} are there", present)
                   : fmt::format("the file ends after {} of {} points", present, header.points),
               "Download or copy it again; \"lasinfo -repair_counters\" (LAStools) makes the "
               "present points usable");
}

}  // namespace

CloudFile read_las(const Input& given) {
  const LasHeader header = read_las_header(given);
  const Input input = in_las_unit(given, header);
  if (header.compressed) {
    const std::unique_ptr<LasPoint[]> points = laz::read_points(input, header);
    return LasReader(
               input, header, [&](std::size_t i) { return points[i]; },
               laz::kDecodingShare * header.points)
        .run();
  }
  check_size(input, header);
  const std::byte* begin = input.bytes.data() + header.points_offset;
  return LasReader(input, header,
                   [&](std::size_t i) { return las_point(header, begin + i * header.record_size); })
      .run();
}

}  // namespace palpate::io
