// Reads E57 files: the scans of laser scanners, placed by the file's poses.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "io/cloud_builder.hpp"
#include "io/e57/contents.hpp"
#include "io/e57/packets.hpp"
#include "io/e57/pages.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"

namespace palpate::io {
namespace {

using E57Name = std::pair<std::string_view, Role>;

constexpr E57Name kCartesian[] = {
    {"cartesianX", Role::x}, {"cartesianY", Role::y}, {"cartesianZ", Role::z}};
// Range, azimuth and elevation are kept as x, y and z until a point is made of them.
constexpr E57Name kSpherical[] = {
    {"sphericalRange", Role::x}, {"sphericalAzimuth", Role::y}, {"sphericalElevation", Role::z}};
constexpr E57Name kOthers[] = {{"normalX", Role::normal_x},   {"normalY", Role::normal_y},
                               {"normalZ", Role::normal_z},   {"colorRed", Role::red},
                               {"colorGreen", Role::green},   {"colorBlue", Role::blue},
                               {"intensity", Role::intensity}};

std::optional<Role> role_in(std::span<const E57Name> names, const E57Field& field) {
  const auto found = std::ranges::find(names, field.name, &E57Name::first);
  const bool usable = found != names.end() && field.kind != E57Field::Kind::skipped;
  return usable ? std::optional{found->second} : std::nullopt;
}

Roles roles_in(const E57Scan& scan, std::span<const E57Name> coordinates) {
  Roles roles;
  for (const E57Field& field : scan.fields) {
    const std::optional<Role> coordinate = role_in(coordinates, field);
    roles.add(coordinate ? coordinate : role_in(kOthers, field));
  }
  return roles;
}

bool has_field(const E57Scan& scan, std::string_view name) {
  return std::ranges::find(scan.fields, name, &E57Field::name) != scan.fields.end();
}

// Did a scanner see all points from the scan's origin? Programs that join or thin scans write one
// without a grid, whose origin may be anywhere.
bool seen_from_origin(const E57Scan& scan) {
  return has_field(scan, "sphericalRange") ||
         (has_field(scan, "rowIndex") && has_field(scan, "columnIndex")) ||
         !scan.T_file_scan.linear().isIdentity();
}

// Decides which columns of a scan become points, and how.
struct E57Layout {
  Roles roles;  // one a field
  bool spherical = false;
  std::vector<std::size_t> used{};  // fields with a role, and the one that marks invalid points
  std::optional<std::size_t> invalid{};  // its index in `used`
};

E57Layout layout_of(const Input& input, const E57Scan& scan) {
  E57Layout result{roles_in(scan, kCartesian)};
  if (!result.roles.has_point()) result = {roles_in(scan, kSpherical), true};
  if (!result.roles.has_point()) {
    fail(input, fmt::format("scan \"{}\" has no coordinates", excerpt(scan.name)),
         "Export it again with cartesianX, Y and Z");
  }
  const std::string_view state =
      result.spherical ? "sphericalInvalidState" : "cartesianInvalidState";
  for (std::size_t k = 0; k < scan.fields.size(); ++k) {
    const E57Field& field = scan.fields[k];
    const bool marks =
        !result.invalid && field.name == state && field.kind != E57Field::Kind::skipped;
    if (marks) result.invalid = result.used.size();
    if (marks || result.roles[k]) result.used.push_back(k);
  }
  return result;
}

// Makes rows of a scan's columns.
class E57ScanReader {
 public:
  // @throws Error when the scan lacks coordinates, or its bytes cannot hold its points.
  E57ScanReader(const Input& input, E57Pages& pages, const E57Scan& scan)
      : scan_(scan), layout_(layout_of(input, scan)), packets_(input, pages, scan, layout_.used) {}

  [[nodiscard]] const E57Scan& scan() const { return scan_; }
  [[nodiscard]] Columns columns() const { return layout_.roles.columns(); }
  [[nodiscard]] std::uint64_t bytes() const { return packets_.bytes(); }

  // `before`: points of the scans before, for the progress.
  void run(CloudBuilder& builder, Progress& progress, std::size_t before) {
    std::size_t done = 0;
    while (const std::size_t count = packets_.next()) {
      for (std::size_t i = 0; i < count; ++i) builder.add(row(i));
      done += count;
      progress.at(before + done);
    }
  }

 private:
  // `column`: an index in `used`.
  [[nodiscard]] double value(std::size_t column, Role role, std::size_t i) const {
    const double number = packets_.values(column)[i];
    if (role != Role::red && role != Role::green && role != Role::blue) return number;
    const E57Field& field = scan_.fields[layout_.used[column]];
    return 255 * (number - field.black) / (field.white - field.black);
  }

  [[nodiscard]] Row row(std::size_t i) const {
    Row row{};
    for (std::size_t k = 0; k < layout_.used.size(); ++k) {
      const std::optional<Role> role = layout_.roles[layout_.used[k]];
      if (role) row[index_of(*role)] = value(k, *role, i);
    }
    Eigen::Map<Eigen::Vector3d> point(row.data() + index_of(Role::x));
    if (layout_.spherical) point = cartesian(point);
    point = scan_.T_file_scan * Eigen::Vector3d(point);
    // The builder drops and counts what is no number.
    if (layout_.invalid && packets_.values(*layout_.invalid)[i] != 0) row[0] = kNoNumber;
    Eigen::Map<Eigen::Vector3d> normal(row.data() + index_of(Role::normal_x));
    normal = scan_.T_file_scan.linear() * Eigen::Vector3d(normal);
    return row;
  }

  static constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

  static Eigen::Vector3d cartesian(const Eigen::Vector3d& v) {
    const double across = v[0] * std::cos(v[2]);
    return {across * std::cos(v[1]), across * std::sin(v[1]), v[0] * std::sin(v[2])};
  }

  const E57Scan& scan_;
  E57Layout layout_;
  E57Packets packets_;
};

// The scan that the input's name selects, otherwise all that hold points.
std::vector<const E57Scan*> choose_scans(const Input& input, const E57Contents& contents) {
  std::vector<const E57Scan*> chosen;
  const std::size_t count = contents.scans.size();
  if (const auto number = split_scan(input.name).number) {
    if (*number < 1 || *number > count) {
      fail(input, fmt::format("there are {} scans", count), "Give the number of one of them");
    }
    chosen.push_back(&contents.scans[*number - 1]);
  } else {
    for (const E57Scan& scan : contents.scans) chosen.push_back(&scan);
  }
  std::erase_if(chosen, [](const E57Scan* scan) { return scan->points == 0; });
  if (chosen.empty()) {
    fail(input, fmt::format("no scan holds points ({} images)", contents.images),
         "Export it again with its points");
  }
  return chosen;
}

std::string format_name(const std::vector<const E57Scan*>& chosen, const E57Contents& contents) {
  if (chosen.size() > 1) return fmt::format("E57, {} scans joined", chosen.size());
  const std::string& name = chosen.front()->name;
  const std::string shown = name.empty() ? "" : fmt::format(" \"{}\"", excerpt(name));
  const auto number = chosen.front() - contents.scans.data() + 1;
  if (contents.scans.size() == 1) return "E57";
  return fmt::format("E57, scan {} of {}{}", number, contents.scans.size(), shown);
}

// A column is kept where every scan has it.
Columns common_columns(const std::vector<E57ScanReader>& scans) {
  Columns common{true, true, true};
  for (const E57ScanReader& scan : scans) {
    const Columns its = scan.columns();
    common.normals = common.normals && its.normals;
    common.colors = common.colors && its.colors;
    common.intensities = common.intensities && its.intensities;
  }
  return common;
}

}  // namespace

CloudFile read_e57(const Input& input) {
  E57Pages pages(input);
  const E57Contents contents = read_e57_contents(input, pages);
  const std::vector<const E57Scan*> chosen = choose_scans(input, contents);
  std::vector<E57ScanReader> scans;
  std::uint64_t bytes = 0;
  for (const E57Scan* scan : chosen) {
    scans.emplace_back(input, pages, *scan);
    bytes += scans.back().bytes();
    if (bytes > pages.size()) {
      fail(input, "the points of two scans lie at the same place", "Export the file again");
    }
  }
  std::uint64_t points = 0;  // no overflow: each scan's bytes hold its points
  for (const E57Scan* scan : chosen) points += scan->points;
  CloudBuilder builder(input, common_columns(scans), ColorScale::byte, std::min(points, bytes));
  Progress progress(input.options, points);
  std::size_t before = 0;
  for (E57ScanReader& scan : scans) {
    scan.run(builder, progress, before);
    before += scan.scan().points;
  }
  CloudFile file = builder.finish(format_name(chosen, contents));
  const E57Scan& first = *chosen.front();
  const Eigen::Vector3d stand = input.scale().cwiseProduct(first.T_file_scan.translation());
  if (chosen.size() == 1 && seen_from_origin(first) && is_usable(stand))
    file.cloud.viewpoint = stand;
  return file;
}

std::vector<std::size_t> e57_scans_with_points(const Input& input) {
  E57Pages pages(input);
  const E57Contents contents = read_e57_contents(input, pages);
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < contents.scans.size(); ++i) {
    if (contents.scans[i].points > 0) numbers.push_back(i + 1);
  }
  return numbers;
}

}  // namespace palpate::io
