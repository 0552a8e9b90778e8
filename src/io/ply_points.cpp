// Reads the points of PLY files.
#include "io/ply_points.hpp"

#include <algorithm>
#include <string>

#include "io/text_scanner.hpp"

namespace palpate::io {

PlyVertices columns_of(const PlyElement& element) {
  PlyVertices result;
  Roles& roles = result.roles;
  for (const PlyProperty& property : element.properties) {
    roles.add(property.list_count ? std::nullopt : role_of(property.name));
    if (roles[roles.size() - 1] == Role::red && property.type != NumberType::uint8) {
      result.color_scale =
          is_floating(property.type) ? ColorScale::guess : ColorScale::guess_integer;
    }
  }
  return result;
}

const PlyElement& points_of(const Input& input, const PlyHeader& header) {
  const auto points = std::ranges::find_if(header.elements, [](const PlyElement& element) {
    return columns_of(element).roles.has_point();
  });
  if (points == header.elements.end()) {
    fail(input, "no element of this PLY file has the properties x, y and z",
         "Export it again with its vertices");
  }
  return *points;
}

PlyTable table_of_points(const PlyElement& element, const Roles& roles) {
  PlyTable table{.element = &element, .row = std::vector<double>(kRoleCount, 0)};
  for (std::size_t k = 0; k < roles.size(); ++k) {
    table.slots.push_back(roles[k] ? std::optional(index_of(*roles[k])) : std::nullopt);
  }
  return table;
}

CloudFile read_ply_points(const Input& input) {
  const PlyHeader header = read_ply_header(input);
  const PlyElement& points = points_of(input, header);
  const PlyVertices columns = columns_of(points);
  CloudBuilder builder(input, columns.roles.columns(), columns.color_scale,
                       most_rows(input, header, points));
  std::vector<PlyTable> tables{table_of_points(points, columns.roles)};
  tables.front().take = [&](std::span<const double> values) {
    Row row;
    std::ranges::copy(values, row.begin());
    builder.add(row);
  };
  const std::string over = unused(read_ply_rows(input, header, tables));
  return builder.finish(std::string(name_of(header.encoding)) + over);
}

}  // namespace palpate::io
