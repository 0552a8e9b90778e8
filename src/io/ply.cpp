// Reads the vertices and faces of PLY files, as text or as bytes of either order.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

// The two ways to get the next number of an element; false at the end of the bytes.
class AsciiCursor {
 public:
  AsciiCursor(const Input& input, std::size_t offset) : scanner_(input, offset) {}
  bool next(NumberType, double& value) {
    const std::optional<double> number = scanner_.next_number();
    value = number.value_or(0);
    return number.has_value();
  }
  bool skip(NumberType, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (scanner_.next_token().empty()) return false;
    }
    return true;
  }
  [[nodiscard]] std::size_t offset() const { return scanner_.offset(); }
  static std::size_t least_size(NumberType) { return 2; }  // a digit and a space

 private:
  TextScanner scanner_;
};

class BinaryCursor {
 public:
  BinaryCursor(const Input& input, std::size_t offset, std::endian order)
      : bytes_(input.bytes), offset_(offset), order_(order) {}
  bool next(NumberType type, double& value) {
    if (bytes_.size() - offset_ < size_of(type)) return false;
    value = load_number(type, bytes_.data() + offset_, order_);
    offset_ += size_of(type);
    return true;
  }
  bool skip(NumberType type, std::size_t count) {
    if ((bytes_.size() - offset_) / size_of(type) < count) return false;
    offset_ += count * size_of(type);
    return true;
  }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  static std::size_t least_size(NumberType type) { return size_of(type); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t offset_;
  std::endian order_;
};

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

// The list of a face's corners.
bool is_corner_list(const PlyElement& element, const PlyProperty& property) {
  return element.name == "face" && property.list_count && !is_floating(property.type) &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool has_faces(const PlyElement& element) {
  return std::ranges::any_of(element.properties,
                             [&](const PlyProperty& p) { return is_corner_list(element, p); });
}

bool has_points(const PlyElement& element) {
  return columns_of(element).roles.has_point();
}

template <class Cursor>
class PlyReader {
 public:
  PlyReader(const Input& input, const PlyHeader& header, Cursor cursor)
      : input_(input), header_(header), cursor_(std::move(cursor)) {}

  CloudFile run(std::string format) {
    const auto& elements = header_.elements;
    const auto points = std::ranges::find_if(elements, has_points);
    const auto faces = std::ranges::find_if(elements, has_faces);
    if (points == elements.end()) {
      fail(input_, "no element of this PLY file has the properties x, y and z",
           "Export it again with its vertices");
    }
    vertices_ = points->count;
    has_faces_ = faces != elements.end();
    const auto last = has_faces_ ? std::max(points, faces) : points;
    CloudFile file;
    for (auto element = elements.begin(); element <= last; ++element) {
      if (element == points) {
        file = read_vertices(*element, format);
      } else {
        read_element(*element);
      }
    }
    return choose_cloud(input_, mesh_, std::move(file));
  }

 private:
  CloudFile read_vertices(const PlyElement& element, std::string format) {
    const VertexColumns columns = columns_of(element);
    const std::size_t room = (input_.bytes.size() - cursor_.offset() + 1) / least_row(element);
    CloudBuilder builder(input_, columns.roles.columns(), columns.color_scale,
                         std::min(element.count, room));
    mesh_.columns = columns.roles.columns();
    mesh_.color_scale = columns.color_scale;
    Progress progress(input_.options, input_.bytes.size());
    Row row{};
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!read_row(element, columns, row)) fail_cut(element, i);
      builder.add(row);
      if (has_faces_) mesh_.vertices.push_back(mesh_vertex(row));
      progress.at(cursor_.offset());
    }
    return builder.finish(std::move(format));
  }

  bool read_row(const PlyElement& element, const VertexColumns& columns, Row& row) {
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      double value = 0;
      if (property.list_count) {
        if (!skip_list(property)) return false;
      } else if (!columns.roles[k]) {
        if (!cursor_.skip(property.type, 1)) return false;
      } else if (cursor_.next(property.type, value)) {
        row[index_of(*columns.roles[k])] = value;
      } else {
        return false;
      }
    }
    return true;
  }

  // Takes the faces of an element and skips all else.
  void read_element(const PlyElement& element) {
    if (element.properties.empty()) return;
    Progress progress(input_.options, input_.bytes.size());
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        const bool there = is_corner_list(element, property) ? read_face(property)
                           : property.list_count             ? skip_list(property)
                                                             : cursor_.skip(property.type, 1);
        if (!there) fail_cut(element, i);
      }
      progress.at(cursor_.offset());
    }
  }

  bool read_face(const PlyProperty& property) {
    double length = 0;
    if (!read_length(property, length)) return false;
    for (double k = 0; k < length; ++k) {
      const std::size_t begin = cursor_.offset();
      double corner = 0;
      if (!cursor_.next(property.type, corner)) return false;
      if (!(corner >= 0 && corner < static_cast<double>(vertices_))) {
        fail_at_byte(input_, begin,
                     fmt::format("a face has vertex {}, but there are {}", corner, vertices_),
                     "The file is damaged: export it again");
      }
      mesh_.add_corner(static_cast<std::size_t>(corner));
    }
    mesh_.close_face();
    return true;
  }

  bool skip_list(const PlyProperty& property) {
    double length = 0;
    return read_length(property, length) &&
           cursor_.skip(property.type, static_cast<std::size_t>(length));
  }

  bool read_length(const PlyProperty& property, double& length) {
    const std::size_t begin = cursor_.offset();
    if (!cursor_.next(*property.list_count, length)) return false;
    if (length >= 0 && length <= 4294967295.0) return true;
    fail_at_byte(input_, begin, fmt::format("invalid list length {}", length),
                 "The file is damaged: export it again");
  }

  static std::size_t least_row(const PlyElement& element) {
    std::size_t size = 0;
    for (const PlyProperty& p : element.properties) {
      size += Cursor::least_size(p.list_count.value_or(p.type));
    }
    return size;
  }

  [[noreturn]] void fail_cut(const PlyElement& element, std::size_t present) const {
    fail_at_byte(input_, input_.bytes.size(),
                 fmt::format("the file ends after {} of {} rows of \"{}\"", present, element.count,
                             excerpt(element.name)),
                 fmt::format("Download or export it again; to use the {} rows that are present, "
                             "write \"element {} {}\" in its header",
                             present, excerpt(element.name), present));
  }

  const Input& input_;
  const PlyHeader& header_;
  Cursor cursor_;
  std::size_t vertices_ = 0;
  bool has_faces_ = false;
  Mesh mesh_;
};

}  // namespace

CloudFile read_ply(const Input& input) {
  const PlyHeader header = read_ply_header(input);
  if (header.encoding == PlyEncoding::ascii) {
    return PlyReader(input, header, AsciiCursor(input, header.size)).run("PLY, ascii");
  }
  const bool little = header.encoding == PlyEncoding::little_endian;
  const BinaryCursor cursor(input, header.size, little ? std::endian::little : std::endian::big);
  return PlyReader(input, header, cursor)
      .run(little ? "PLY, binary little endian" : "PLY, binary big endian");
}

}  // namespace palpate::io
