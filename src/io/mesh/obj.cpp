// Reads the faces, vertices and normals of Wavefront OBJ files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh/mesh.hpp"
#include "io/text_scanner.hpp"
#include "io/units/file_unit.hpp"

namespace palpate::io {
namespace {

struct Counts {
  std::size_t vertices = 0;
  std::size_t normals = 0;
  std::size_t faces = 0;
  std::size_t first_normal = 0;  // byte offset of the first "vn" line
};

// "fo" is what the first versions of the format call a face.
bool is_face(std::string_view word) {
  return word == "f" || word == "fo";
}

Counts count_lines(const Input& input) {
  Counts counts;
  TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::size_t begin = scanner.offset();
    std::string_view line = scanner.next_line();
    const std::string_view word = take_word(line);
    if (word == "v") ++counts.vertices;
    if (is_face(word)) ++counts.faces;
    if (word == "vn" && counts.normals++ == 0) counts.first_normal = begin;
  }
  return counts;
}

class ObjReader {
 public:
  /// `joined`: the same with each line on one line, at the same offsets.
  ObjReader(const Input& input, const Input& joined)
      : input_(input),
        joined_(joined),
        counts_(count_lines(joined)),
        vertices_(joined),
        normals_(joined, counts_.first_normal) {}

  CloudFile run() {
    const bool normals = counts_.normals == counts_.vertices && counts_.normals > 0;
    Progress progress(input_.options, input_.bytes.size());
    std::optional<CloudBuilder> builder;
    for (std::size_t i = 0; i < counts_.vertices; ++i) {
      Row row{};
      const std::size_t numbers = read_line(vertices_, "v", 7, values_);
      const bool colors = numbers >= 6;
      if (!builder) {
        builder.emplace(input_, Columns{.normals = normals, .colors = colors}, mesh_.color_scale,
                        counts_.vertices);
        mesh_.columns.colors = colors;
      }
      set(row, Role::x);
      if (colors) std::copy_n(values_.begin() + 3, 3, row.begin() + index_of(Role::red));
      if (normals) {
        read_line(normals_, "vn", 3, values_);
        set(row, Role::normal_x);
      }
      builder->add(row);
      if (counts_.faces > 0) mesh_.vertices.push_back(mesh_vertex(row));
      progress.at(vertices_.offset());
    }
    if (!builder)
      fail(input_, "this OBJ file has no vertices (lines \"v x y z\")", "Export it again");
    CloudFile file = builder->finish("OBJ");
    if (counts_.faces > 0) read_faces();
    return choose_cloud(input_, mesh_, std::move(file));
  }

 private:
  using Values = std::array<double, 7>;

  void set(Row& row, Role first) const {
    std::copy_n(values_.begin(), 3, row.begin() + index_of(first));
  }

  // The numbers of the next line that starts with `word`, which is known to exist.
  std::size_t read_line(TextScanner& scanner, std::string_view word, std::size_t most,
                        Values& values) const {
    std::size_t begin = 0;
    std::string_view line;
    do {
      begin = scanner.offset();
      line = scanner.next_line();
    } while (take_word(line) != word);
    std::size_t count = 0;
    for (; count < most; ++count) {
      const std::string_view cell = take_word(line);
      if (cell.empty() || cell[0] == '#') break;
      const std::optional<double> number = parse_number(cell);
      if (!number) wrong(begin, fmt::format("\"{}\" is not a number", excerpt(cell)));
      values[count] = *number;
    }
    if (count < 3) wrong(begin, fmt::format("{} numbers after \"{}\" instead of 3", count, word));
    return count;
  }

  void read_faces() {
    TextScanner scanner(joined_);
    Progress progress(input_.options, input_.bytes.size());
    std::size_t before = 0;  // vertices, from which negative numbers count back
    while (!scanner.at_end()) {
      const std::size_t begin = scanner.offset();
      std::string_view line = scanner.next_line();
      const std::string_view word = take_word(line);
      if (word == "v") ++before;
      if (is_face(word)) read_face(begin, line, before);
      progress.at(scanner.offset());
    }
  }

  // Corners as "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal".
  void read_face(std::size_t begin, std::string_view line, std::size_t before) {
    for (std::string_view cell = take_word(line); !cell.empty() && cell[0] != '#';
         cell = take_word(line)) {
      const std::string_view vertex = cell.substr(0, cell.find('/'));
      const bool back = vertex.starts_with('-');
      const std::optional<std::size_t> number = parse_count(vertex.substr(back ? 1 : 0));
      const std::size_t most = back ? before : counts_.vertices;
      if (!number || *number < 1 || *number > most) {
        wrong(begin,
              fmt::format("a face has vertex \"{}\", but there are {}", excerpt(vertex), most));
      }
      mesh_.add_corner(back ? before - *number : *number - 1);
    }
    mesh_.close_face();
  }

  [[noreturn]] void wrong(std::size_t offset, std::string_view what) const {
    fail_at_line(input_, offset, what, "Correct this line, or export the file again");
  }

  const Input& input_;
  const Input& joined_;
  Counts counts_;
  TextScanner vertices_;
  TextScanner normals_;
  Values values_{};
  Mesh mesh_{.color_scale = ColorScale::guess, .has_unit = false};
};

// The text with blanks instead of each backslash before a line's end, and of that end, but not in
// comments; nothing if there is none.
std::string join_lines(std::string_view text) {
  std::string joined;
  for (std::size_t at = text.find('\\'); at < text.size(); at = text.find('\\', at + 1)) {
    const std::size_t next = text.find_first_not_of("\r\n", at + 1);
    const std::size_t length = text.substr(at + 1).starts_with("\r\n") ? 3 : 2;
    const std::size_t begin = text.find_last_of("\r\n", at) + 1;  // of its line; npos + 1 is 0
    if (next == at + 1 || text.substr(begin, at - begin).find('#') != std::string_view::npos)
      continue;
    if (joined.empty()) joined = text;
    std::fill_n(joined.begin() + static_cast<std::ptrdiff_t>(at),
                std::min(length, text.size() - at), ' ');
  }
  return joined;
}

}  // namespace

CloudFile read_obj(const Input& given) {
  const Input input = in_unit_of_comments(given, given.text(), "#");
  const std::string joined = join_lines(input.text());
  if (joined.empty()) return ObjReader(input, input).run();
  const Input lines{std::as_bytes(std::span(joined)), input.name, input.options};
  return ObjReader(input, lines).run();
}

}  // namespace palpate::io
