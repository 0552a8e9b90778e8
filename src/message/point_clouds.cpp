// Converts between PointCloud2 messages and PointClouds.
#include "message/point_clouds.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "io/cloud_builder.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"

namespace palpate::message {
namespace {

using io::NumberType;
using io::Role;

constexpr const char* kName = "PointCloud2";
constexpr std::array kTypes{NumberType::int8,    NumberType::uint8,  NumberType::int16,
                            NumberType::uint16,  NumberType::int32,  NumberType::uint32,
                            NumberType::float32, NumberType::float64};

// Column of a point: the number at `offset` is its `role` or, without one, its packed colour.
struct Column {
  std::optional<Role> role;
  NumberType type = NumberType::float32;
  std::size_t offset = 0;
};

bool packs_color(const PointField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.datatype >= 5 &&
         field.datatype <= 7;
}

Column column_of(const PointCloud2& message, const PointField& field, std::optional<Role> role) {
  if (field.datatype == 0 || field.datatype > kTypes.size()) {
    throw Error(fmt::format("{}: field '{}' has the unknown datatype {}", kName,
                            io::excerpt(field.name), field.datatype));
  }
  const NumberType type = kTypes[field.datatype - 1U];
  if (field.offset > message.point_step || message.point_step - field.offset < io::size_of(type)) {
    throw Error(fmt::format("{}: field '{}' at byte {} lies outside points of {} bytes", kName,
                            io::excerpt(field.name), field.offset, message.point_step));
  }
  return {role, type, field.offset};
}

std::vector<Column> columns_of(const PointCloud2& message, io::Columns& optional) {
  std::vector<Column> columns;
  io::Roles roles;
  bool packed = false;
  for (const PointField& field : message.fields) {
    const bool is_color = !packed && packs_color(field);
    packed = packed || is_color;
    roles.add(is_color ? std::nullopt : io::role_of(field.name));
    const std::optional<Role> role = roles[roles.size() - 1];
    if (role || is_color) columns.push_back(column_of(message, field, role));
  }
  if (!roles.has_point()) throw Error(fmt::format("{}: its fields lack x, y or z", kName));
  optional = roles.columns();
  optional.colors = optional.colors || packed;
  return columns;
}

// Bytes from a row to the next. Some writers of one row leave that out, as nothing follows it.
std::size_t row_step_of(const PointCloud2& message) {
  const std::size_t row = static_cast<std::size_t>(message.width) * message.point_step;
  return message.row_step == 0 && message.height == 1 ? row : message.row_step;
}

void check_layout(const PointCloud2& message) {
  const std::size_t row = static_cast<std::size_t>(message.width) * message.point_step;
  const std::size_t step = row_step_of(message);
  const bool fits = message.point_step > 0 && step >= row &&
                    (message.height == 0 || step <= message.data.size() / message.height);
  if (fits && (step > 0 || message.height <= 1)) return;
  throw Error(fmt::format("{}: {} x {} points of {} bytes, {} a row, in {} bytes", kName,
                          message.width, message.height, message.point_step, message.row_step,
                          message.data.size()));
}

void set(io::Row& row, const Column& column, const std::byte* point, std::endian order) {
  if (column.role) {
    row[index_of(*column.role)] = io::load_number(column.type, point + column.offset, order);
    return;
  }
  const auto color = io::load_as<std::uint32_t>(point + column.offset, order);
  row[index_of(Role::red)] = (color >> 16U) & 255U;
  row[index_of(Role::green)] = (color >> 8U) & 255U;
  row[index_of(Role::blue)] = color & 255U;
}

}  // namespace

PointCloud cloud_of(const PointCloud2& message) {
  if (message.width == 0 || message.height == 0) return {};
  check_layout(message);
  io::Columns optional;
  const std::vector<Column> columns = columns_of(message, optional);
  const ReadOptions options;
  const io::Input input{{}, kName, options};
  io::CloudBuilder builder(input, optional, io::ColorScale::byte,
                           static_cast<std::size_t>(message.width) * message.height);
  if (message.height > 1) builder.organise(message.width, message.height);
  const std::endian order = message.is_bigendian ? std::endian::big : std::endian::little;
  const auto* bytes = reinterpret_cast<const std::byte*>(message.data.data());
  const std::size_t row_step = row_step_of(message);
  io::Row row{};
  for (std::size_t v = 0; v < message.height; ++v) {
    for (std::size_t u = 0; u < message.width; ++u) {
      const std::byte* point = bytes + v * row_step + u * message.point_step;
      for (const Column& column : columns) set(row, column, point, order);
      builder.add(row);
    }
  }
  if (builder.size() == 0) return {};
  PointCloud cloud = builder.finish(kName).cloud;
  cloud.viewpoint = Eigen::Vector3d::Zero();
  return cloud;
}

PointCloud2 message_of(const PointCloud& cloud) {
  const bool normals = !cloud.normals.empty();
  PointCloud2 message;
  constexpr std::array<const char*, 6> kFields{"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  for (std::uint32_t i = 0; i < (normals ? 6U : 3U); ++i)
    message.fields.push_back({kFields[i], 4 * i, 7, 1});
  message.width = static_cast<std::uint32_t>(cloud.size());
  message.point_step = 4 * static_cast<std::uint32_t>(message.fields.size());
  message.row_step = message.width * message.point_step;
  message.is_dense = true;
  message.data.resize(message.row_step);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f point = cloud.point(i).cast<float>();
    std::uint8_t* to = message.data.data() + i * message.point_step;
    std::memcpy(to, point.data(), 12);
    if (normals) std::memcpy(to + 12, cloud.normals[i].data(), 12);
  }
  return message;
}

}  // namespace palpate::message
