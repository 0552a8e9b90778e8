// Reads the vertices of PLY files as points, or as splats where that is what they are.
#include <algorithm>
#include <string>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/ply_rows.hpp"
#include "io/splats.hpp"

namespace palpate::io {
namespace {

struct VertexColumns {
  Roles roles;  // one a property
  ColorScale color_scale = ColorScale::byte;
};

VertexColumns columns_of(const PlyElement& element) {
  VertexColumns result;
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

CloudFile read_vertices(const Input& input, const PlyHeader& header, const PlyElement& element,
                        const VertexColumns& columns) {
  CloudBuilder builder(input, columns.roles.columns(), columns.color_scale,
                       most_rows(input, header, element));
  PlyTable table{&element, {}, std::vector<double>(kRoleCount, 0), {}};
  for (std::size_t k = 0; k < columns.roles.size(); ++k) {
    const std::optional<Role> role = columns.roles[k];
    table.places.push_back(role ? std::optional(index_of(*role)) : std::nullopt);
  }
  table.take = [&](std::span<const double> values) {
    Row row;
    std::ranges::copy(values, row.begin());
    builder.add(row);
  };
  read_ply_rows(input, header, {&table, 1});
  return builder.finish(std::string(name_of(header.encoding)));
}

}  // namespace

CloudFile read_ply(const Input& input) {
  const PlyHeader header = read_ply_header(input);
  if (holds_splats(header)) return shell_file(input, read_splat_ply);
  for (const PlyElement& element : header.elements) {
    const VertexColumns columns = columns_of(element);
    if (columns.roles.has_point()) return read_vertices(input, header, element, columns);
  }
  fail(input, "no element of this PLY file has the properties x, y and z",
       "Export it again with its vertices");
}

}  // namespace palpate::io
