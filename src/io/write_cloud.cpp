// Writes clouds as PCD, PLY or XYZ.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "io/formats.hpp"
#include "io/input.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// Appends numbers as text with blanks between, or as little-endian bytes.
class RowWriter {
 public:
  RowWriter(std::string& out, bool ascii) : out_(out), ascii_(ascii) {}

  template <class T>
  void put(T value) {
    if (ascii_) {
      fmt::format_to(std::back_inserter(out_), "{} ", value);
      return;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    out_.append(bytes.data(), bytes.size());
  }

  void put(const Eigen::Vector3f& v) {
    for (const float x : {v.x(), v.y(), v.z()}) put(x);
  }

  void end_row() {
    if (ascii_) out_.back() = '\n';
  }

 private:
  std::string& out_;
  bool ascii_;
};

bool needs_double(const PointCloud& cloud) {
  return !cloud.origin.isZero(0);
}

void check_columns(const PointCloud& cloud) {
  const auto fits = [&](const auto& column) {
    return column.empty() || column.size() == cloud.size();
  };
  if (fits(cloud.normals) && fits(cloud.colors) && fits(cloud.intensities)) return;
  throw Error(fmt::format(
      "a cloud of {} points has {} normals, {} colours and {} intensities. Make "
      "each column empty or as long as positions.",
      cloud.size(), cloud.normals.size(), cloud.colors.size(), cloud.intensities.size()));
}

std::string ply_header(const PointCloud& cloud, bool ascii) {
  std::string text =
      fmt::format("ply\nformat {} 1.0\ncomment written by palpate\nelement vertex {}\n",
                  ascii ? "ascii" : "binary_little_endian", cloud.size());
  const auto add = [&](std::string_view type, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) text += fmt::format("property {} {}\n", type, name);
  };
  add(needs_double(cloud) ? "double" : "float", {"x", "y", "z"});
  if (!cloud.normals.empty()) add("float", {"nx", "ny", "nz"});
  if (!cloud.colors.empty()) add("uchar", {"red", "green", "blue"});
  if (!cloud.intensities.empty()) add("float", {"intensity"});
  return text + "end_header\n";
}

std::string pcd_viewpoint(const PointCloud& cloud) {
  if (!cloud.viewpoint) return "0 0 0 1 0 0 0";
  const Eigen::Vector3d& p = *cloud.viewpoint;
  // "0 0 0 1 0 0 0" means that nobody set it; a camera at zero, as drivers write it, has the
  // quaternion of its optical frame.
  return fmt::format("{} {} {} {}", p.x(), p.y(), p.z(), p.isZero(0) ? "0 1 0 0" : "1 0 0 0");
}

std::string pcd_header(const PointCloud& cloud, bool ascii) {
  std::string fields = "FIELDS x y z";
  std::string sizes = needs_double(cloud) ? "SIZE 8 8 8" : "SIZE 4 4 4";
  std::string types = "TYPE F F F";
  std::string counts = "COUNT 1 1 1";
  const auto add = [&](std::string_view name, char type) {
    fields += fmt::format(" {}", name);
    sizes += " 4";
    types += fmt::format(" {}", type);
    counts += " 1";
  };
  if (!cloud.normals.empty()) {
    for (const std::string_view name : {"normal_x", "normal_y", "normal_z"}) add(name, 'F');
  }
  if (!cloud.colors.empty()) add("rgb", 'U');
  if (!cloud.intensities.empty()) add("intensity", 'F');
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n{}\n{}\n{}\n{}\nWIDTH {}\n"
      "HEIGHT 1\nVIEWPOINT {}\nPOINTS {}\nDATA {}\n",
      fields, sizes, types, counts, cloud.size(), pcd_viewpoint(cloud), cloud.size(),
      ascii ? "ascii" : "binary");
}

void put_position(RowWriter& row, const PointCloud& cloud, std::size_t i) {
  if (!needs_double(cloud)) return row.put(cloud.positions[i]);
  const Eigen::Vector3d point = cloud.point(i);
  for (const double x : {point.x(), point.y(), point.z()}) row.put(x);
}

void put_color(RowWriter& row, const std::array<std::uint8_t, 3>& color, CloudFormat format) {
  if (format == CloudFormat::ply) {
    for (const std::uint8_t c : color) row.put(c);
    return;
  }
  row.put(static_cast<std::uint32_t>(color[0] << 16 | color[1] << 8 | color[2]));
}

}  // namespace

std::string encode_cloud(const PointCloud& cloud, CloudFormat format, const WriteOptions& options) {
  check_columns(cloud);
  std::string text = format == CloudFormat::ply ? ply_header(cloud, options.ascii)
                                                : pcd_header(cloud, options.ascii);
  RowWriter row(text, options.ascii);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    put_position(row, cloud, i);
    if (!cloud.normals.empty()) row.put(cloud.normals[i]);
    if (!cloud.colors.empty()) put_color(row, cloud.colors[i], format);
    if (!cloud.intensities.empty()) row.put(cloud.intensities[i]);
    row.end_row();
  }
  return text;
}

namespace {

CloudFormat format_of(const std::filesystem::path& path) {
  const std::string ending = io::extension(path.string());
  if (ending == ".ply") return CloudFormat::ply;
  if (ending == ".pcd") return CloudFormat::pcd;
  throw Error(fmt::format("{}: clouds are written as .ply or .pcd. Choose one of these extensions.",
                          path.string()));
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  throw Error(
      fmt::format("{}: cannot be written ({} bytes). Check that the folder exists and is writable, "
                  "and that the disk has space.",
                  path.string(), bytes.size()));
}

}  // namespace

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options) {
  const std::string bytes = encode_cloud(cloud, format_of(path), options);
  std::filesystem::path part = path;
  part += ".part";
  write_bytes(part, bytes);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw Error(
      fmt::format("{}: cannot be replaced ({}). Check that it is not a folder and is writable.",
                  path.string(), error.message()));
}

}  // namespace palpate
