// Reads the vertices and faces of PLY files as a cloud, or as splats where that is what they are.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh/mesh.hpp"
#include "io/ply_points.hpp"
#include "io/ply_rows.hpp"
#include "io/splats/splats.hpp"
#include "io/units/file_unit.hpp"

namespace palpate::io {
namespace {

// Is it the list of a face's corners?
bool is_corner_list(const PlyProperty& property) {
  return property.list_count && !is_floating(property.type) &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

// Strips are those of the Stanford scanning repository: each corner makes a triangle with the two
// before it, and -1 ends a strip.
bool is_strips(const PlyElement& element) {
  return element.name == "tristrips";
}

bool has_faces(const PlyElement& element) {
  return (element.name == "face" || is_strips(element)) &&
         std::ranges::any_of(element.properties, is_corner_list);
}

PlyTable table_of_faces(const PlyElement& element) {
  PlyTable table{.element = &element};
  table.slots.resize(element.properties.size());
  const auto list = std::ranges::find_if(element.properties, is_corner_list);
  table.list = static_cast<std::size_t>(list - element.properties.begin());
  return table;
}

std::size_t corner_of(const Input& input, const PlyTable& table, std::size_t vertices,
                      double corner) {
  if (!(corner >= 0 && corner < static_cast<double>(vertices))) {
    fail_at_byte(input, table.list_begin,
                 fmt::format("a face has vertex {}, but there are {}", corner, vertices),
                 "The file is damaged: export it again");
  }
  return static_cast<std::size_t>(corner);
}

void add_face(const Input& input, const PlyTable& table, std::size_t vertices, Mesh& mesh) {
  for (const double corner : table.items) {
    mesh.add_corner(corner_of(input, table, vertices, corner));
  }
  mesh.close_face();
}

// Every other triangle of a strip is reversed. Those with a corner twice only lead on.
void add_strips(const Input& input, const PlyTable& table, std::size_t vertices, Mesh& mesh) {
  std::array<std::size_t, 2> last{};
  std::size_t length = 0;
  for (const double item : table.items) {
    if (item == -1) {
      length = 0;
      continue;
    }
    const std::size_t corner = corner_of(input, table, vertices, item);
    const bool is_face = length > 1 && last[0] != last[1] && last[0] != corner && last[1] != corner;
    const std::size_t odd = length % 2;
    if (is_face) mesh.add_triangle(last[odd], last[1 - odd], corner);
    last = {last[1], corner};
    ++length;
  }
}

// `faces`: null where the file has none.
CloudFile read_points(const Input& input, const PlyHeader& header, const PlyElement& points,
                      const PlyElement* faces) {
  const PlyVertices columns = columns_of(points);
  CloudBuilder builder(input, columns.roles.columns(), columns.color_scale,
                       most_rows(input, header, points));
  Mesh mesh{.columns = columns.roles.columns(), .color_scale = columns.color_scale};
  // Tables are in the file's order from the start, since the faces' `take` refers to its own index.
  const bool faces_first = faces && faces < &points;
  std::vector<PlyTable> tables(faces ? 2 : 1);
  PlyTable& vertex_table = tables[faces_first ? 1 : 0];
  vertex_table = table_of_points(points, columns.roles);
  vertex_table.take = [&](std::span<const double> values) {
    Row row;
    std::ranges::copy(values, row.begin());
    builder.add(row);
    if (faces) mesh.vertices.push_back(mesh_vertex(row));
  };
  if (faces) {
    PlyTable& face_table = tables[faces_first ? 0 : 1];
    face_table = table_of_faces(*faces);
    face_table.take = [&](std::span<const double>) {
      (is_strips(*faces) ? add_strips : add_face)(input, face_table, points.count, mesh);
    };
  }
  const std::string over = unused(read_ply_rows(input, header, tables));
  return choose_cloud(input, mesh, builder.finish(std::string(name_of(header.encoding)) + over));
}

}  // namespace

CloudFile read_ply(const Input& given) {
  const PlyHeader header = read_ply_header(given);
  const std::string_view lines = given.text().substr(0, header.size);
  const Input input = in_unit_of_comments(given, lines, "comment");
  if (holds_splats(header)) return shell_file(input, read_splat_ply);
  const PlyElement& points = points_of(input, header);
  const auto faces = std::ranges::find_if(header.elements, has_faces);
  const bool has_mesh = faces != header.elements.end() && &*faces != &points;
  return read_points(input, header, points, has_mesh ? &*faces : nullptr);
}

}  // namespace palpate::io
