// Reads the triangles of STL files, as text or as bytes.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh/mesh.hpp"
#include "io/text_scanner.hpp"
#include "io/units/file_unit.hpp"

namespace palpate::io {
namespace {

// Bytes, all from the format.
constexpr std::size_t kComment = 80;         // before the count
constexpr std::size_t kHead = kComment + 4;  // before the first triangle
constexpr std::size_t kTriangle = 50;        // normal, three corners, two bytes of attributes
constexpr std::size_t kFirstCorner = 12;     // of a triangle, behind its normal
constexpr std::size_t kCorner = 12;          // three floats

std::size_t count_of(const Input& input) {
  return load_as<std::uint32_t>(input.bytes.data() + kComment);
}

bool has_binary_size(const Input& input) {
  const std::size_t size = input.bytes.size();
  return size > kHead && size == kHead + kTriangle * count_of(input);
}

bool starts_as_text(const Input& input) {
  TextScanner scanner(input);
  const std::string_view word = scanner.next_token();  // any length: this may be no text at all
  return word.size() == 5 && lower_case(word) == "solid";
}

CloudFile read_binary(const Input& input) {
  const std::size_t size = input.bytes.size();
  if (size < kHead || (size - kHead) / kTriangle < count_of(input)) {
    fail_at_byte(input, size,
                 size < kHead ? "the file ends inside its STL header of 84 bytes"
                              : fmt::format("the file ends after {} of {} triangles",
                                            (size - kHead) / kTriangle, count_of(input)),
                 "Download or export it again");
  }
  Mesh mesh{.has_unit = false};
  const std::size_t count = count_of(input);
  mesh.vertices.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* at = input.bytes.data() + kHead + i * kTriangle + kFirstCorner;
    for (int corner = 0; corner < 3; ++corner, at += kCorner) {
      mesh.add_corner(mesh.vertices.size());
      mesh.vertices.push_back(MeshVertex::Zero());
      for (int axis = 0; axis < 3; ++axis) {
        mesh.vertices.back()[axis] = static_cast<double>(load_as<float>(at + 4 * axis));
      }
    }
    mesh.close_face();
  }
  return sample_faces(input, mesh, "STL, binary" + unused((size - kHead) / kTriangle - count));
}

class StlTextReader {
 public:
  explicit StlTextReader(const Input& input) : input_(input), scanner_(input) {}

  CloudFile run() {
    Progress progress(input_.options, input_.bytes.size());
    while (!scanner_.at_end()) {
      begin_ = scanner_.offset();
      std::string_view line = scanner_.next_line();
      take(lower_case(take_word(line)), line);
      progress.at(scanner_.offset());
    }
    if (open_ > 0) {
      fail(input_, "the file ends inside a face", "Download or export it again");
    }
    if (!ended_) {
      fail(input_,
           fmt::format("the file ends without \"endsolid\" after {} faces", mesh_.ends.size()),
           "Download or export it again; to use the faces that are present, write endsolid below "
           "them");
    }
    return sample_faces(input_, mesh_, "STL, ascii");
  }

 private:
  void take(const std::string& word, std::string_view line) {
    if (word == "vertex") return add_vertex(line);
    if (word == "endloop") return close_loop();
    if (word == "solid" || word == "endsolid") ended_ = word == "endsolid";
    const auto ignored = {"", "solid", "facet", "outer", "endfacet", "endsolid", "color"};
    if (std::ranges::find(ignored, word) != ignored.end()) return;
    wrong(fmt::format("unknown word \"{}\" in an STL file", excerpt(word)));
  }

  void add_vertex(std::string_view line) {
    MeshVertex vertex = MeshVertex::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view cell = take_word(line);
      const std::optional<double> number = parse_number(cell);
      if (!number) wrong(fmt::format("\"{}\" is not a number", excerpt(cell)));
      vertex[axis] = *number;
    }
    mesh_.add_corner(mesh_.vertices.size());
    mesh_.vertices.push_back(vertex);
    ++open_;
  }

  void close_loop() {
    if (open_ < 3) wrong(fmt::format("a face of {} corners", open_));
    mesh_.close_face();
    open_ = 0;
  }

  [[noreturn]] void wrong(std::string_view what) const {
    fail_at_line(input_, begin_, what, "Correct this line, or export the file again");
  }

  const Input& input_;
  TextScanner scanner_;
  std::size_t begin_ = 0;  // of the line
  std::size_t open_ = 0;   // corners of the face that has not ended yet
  bool ended_ = false;     // the solid
  Mesh mesh_{.has_unit = false};
};

}  // namespace

bool is_stl(const Input& input) {
  return has_binary_size(input) || starts_as_text(input) || extension(input.name) == ".stl";
}

CloudFile read_stl(const Input& given) {
  const std::string_view head = given.text().substr(0, kComment);
  const Input input = in_unit_of_comments(
      given, head.substr(0, head.find_first_of(std::string_view("\0\r\n", 3))), "");
  if (!has_binary_size(input) && starts_as_text(input)) return StlTextReader(input).run();
  return read_binary(input);
}

}  // namespace palpate::io
