#include "io/las.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/cloud_builder.hpp"
#include "io/las_header.hpp"
#include "io/laz.hpp"
#include "io/number.hpp"
#include "io/origin.hpp"
#include "io/progress.hpp"

namespace palpate::io {
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
                 "Fetch or copy it again; \"lasinfo -repair_counters\" (LAStools) lets the points "
                 "that are there be used");
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
