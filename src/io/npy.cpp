// Reads NumPy's .npy: which axis of an array the numbers of a point lie along, and what to make of
// arrays that are no points.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/arrays.hpp"
#include "io/formats.hpp"
#include "io/table.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kSaveAgain = "Save it again with numpy.save";

// What follows a key in the header, a dictionary in Python's words.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = std::min(header.find(key), header.size());
  return trim(header.substr(std::min(at + key.size(), header.size())));
}

// "(900, 3)"
std::vector<std::size_t> shape_of(std::string_view text) {
  std::vector<std::size_t> shape;
  text = text.substr(0, text.find(')'));
  text.remove_prefix(text.starts_with('(') ? 1 : 0);
  while (const auto cell = take_cell(text, ",")) {
    if (const auto number = parse_count(*cell)) shape.push_back(*number);
  }
  return shape;
}

struct NpyHeader {
  std::string_view type;           // of its elements, in Python's words: "'<f4'"
  std::string_view sizes;          // its shape, in Python's words
  std::vector<std::size_t> shape;  // of more than two axes without those of one
  bool fortran = false;            // the first axis is the innermost one

  // "'<f4'": the order of bytes, a letter, and a number of bytes.
  [[nodiscard]] std::optional<NumberType> number() const {
    const bool plain = type.size() > 4 && type[0] == '\'' && type[4] == '\'' && type[1] != '>';
    return plain ? number_type(type.substr(2, 1), parse_count(type.substr(3, 1)).value_or(0))
                 : std::nullopt;
  }
};

bool holds_point(std::size_t numbers) {
  return numbers >= 3 && numbers <= FirstNumbers{}.size();
}

// Is it a table whose columns are more than a point has, or a picture? Pictures are not so narrow.
bool is_table(std::size_t rows, std::size_t columns) {
  constexpr std::size_t kNarrow = 32;  // columns; judgement
  constexpr std::size_t kLong = 4;     // times as many rows as columns; judgement
  return columns > 3 && ((columns <= kNarrow && columns <= rows) || columns < rows / kLong);
}

// The axis along which the numbers of a point lie: the last one of 3 to 9, or of a table; else the
// only one of 3, as channels come first, or of 4. In two axes, the first one of 3 to 9.
std::optional<std::size_t> axis_of_points(std::span<const std::size_t> shape) {
  if (shape.size() < 2) return {};
  const std::size_t last = shape.size() - 1;
  const bool flat = shape.size() == 2;
  if (holds_point(shape[last]) || (flat && is_table(shape[0], shape[1]))) return last;
  if (flat && holds_point(shape[0])) return 0;
  for (const std::size_t wanted : {3U, 4U}) {
    const auto found = std::ranges::find(shape, wanted);
    if (std::ranges::count(shape, wanted) == 1) {
      return static_cast<std::size_t>(found - shape.begin());
    }
  }
  return {};
}

// A picture of red, green and blue has three numbers a pixel, too.
bool is_picture(const NpyHeader& header) {
  const bool bytes = header.type.substr(0, 6).find("u1'") != std::string_view::npos;
  return bytes && header.shape.size() > 1 &&
         (header.shape.size() > 2 || !axis_of_points(header.shape));
}

// The command that makes rows of points of an array `a`, by Python's words.
std::string saved(std::string_view rows) {
  return fmt::format(
      "python3 -c \"import numpy as np; a = np.load('IN.npy'); np.save('OUT.npy', {})\"", rows);
}

// "[('x', '<f4'), ('xyz', '<f4', (3,)), ('name', '<U8')]"
struct NpyField {
  std::string_view name;
  bool number = false;  // a single one
  bool point = false;   // three of them
};

std::vector<NpyField> fields_of(std::string_view type) {
  std::vector<NpyField> fields;
  for (std::size_t at = type.find("('"); at != std::string_view::npos;) {
    const std::size_t next = type.find("('", at + 2);
    const std::string_view text = type.substr(at + 2, next - at - 2);
    const std::size_t end = std::min(text.find('\''), text.size());
    const std::string_view rest = text.substr(end);  // "', '<f4')"
    const bool numbers =
        rest.size() > 6 && std::string_view("fiu").find(rest[5]) != std::string_view::npos;
    const bool shaped = rest.find('(') != std::string_view::npos;
    fields.push_back({text.substr(0, end), numbers && !shaped,
                      numbers && rest.find("(3,)") != std::string_view::npos});
    at = next;
  }
  return fields;
}

// May it stand in a command as it is?
bool is_plain_name(std::string_view name) {
  return std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

// The fields x, y and z, whatever they are called; else the first three. Nothing: it has no point.
std::string mend_fields(std::string_view type) {
  if (type.find('[', 1) != std::string_view::npos) return {};  // fields of fields
  std::vector<NpyField> fields = fields_of(type);
  std::erase_if(fields, [](const NpyField& field) { return !is_plain_name(field.name); });
  const auto point = std::ranges::find_if(fields, &NpyField::point);
  if (point != fields.end()) {
    return fmt::format("a['{}'].reshape(-1, 3).astype('<f8')", point->name);
  }
  std::erase_if(fields, [](const NpyField& field) { return !field.number; });
  if (fields.size() < 3) return {};
  std::array<std::string_view, 3> names{fields[0].name, fields[1].name, fields[2].name};
  for (const auto& role : {role_of, fallback_role_of}) {
    std::array<std::string_view, 3> found;
    for (const NpyField& field : fields) {
      const auto meant = role(lower_case(field.name));
      if (meant && index_of(*meant) < 3) found[index_of(*meant)] = field.name;
    }
    if (std::ranges::any_of(found, &std::string_view::empty)) continue;
    names = found;
    break;
  }
  return fmt::format(
      "np.stack([a[k] for k in ('{}', '{}', '{}')], -1).reshape(-1, 3)"
      ".astype('<f8')",
      names[0], names[1], names[2]);
}

// Depths in rows, or several pictures of them.
[[noreturn]] void refuse_npy_image(const Input& input, const NpyHeader& header) {
  const std::size_t axes = header.shape.size();
  const bool floats = header.type.substr(0, 4).find('f') != std::string_view::npos;
  std::string first;
  for (std::size_t k = 2; k < axes; ++k) first += "[0]";
  fail(input,
       fmt::format("no cloud, but pictures or one, {} numbers wide: 'shape': {}",
                   header.shape.back(), excerpt(header.sizes)),
       fmt::format(
           "If these are depths in {}, make a 16-bit PGM of {}: python3 -c \"import numpy as np; "
           "a = np.load('IN.npy').squeeze(){}; a = np.nan_to_num({} * a, posinf=0)"
           ".clip(0, 65534).round().astype('>u2'); "
           "open('OUT.pgm', 'wb').write(b'P5 %d %d 65535\\n' % a.shape[::-1] + a.tobytes())\"",
           floats ? "metres" : "millimetres", axes > 2 ? "the first" : "them", first,
           floats ? "1000.0" : "1.0"));
}

NpyHeader npy_header_of(std::string_view text) {
  NpyHeader header{value_of(text.substr(0, text.find(", 'fortran_order'")), "'descr':"),
                   value_of(text, "'shape':"),
                   {},
                   value_of(text, "'fortran_order':").starts_with("True")};
  header.shape = shape_of(header.sizes);
  if (header.shape.size() < 3) return header;
  std::erase(header.shape, 1U);
  if (header.shape.size() == 1) header.shape.insert(header.shape.begin(), 1);  // one point
  return header;
}

double product(std::span<const std::size_t> sizes) {
  double result = 1;
  for (const std::size_t size : sizes) result *= static_cast<double>(size);
  return result;
}

std::string format_of(std::span<const std::size_t> shape, std::size_t axis) {
  const std::size_t columns = shape[axis];
  std::string format = "NumPy array";
  const bool either = shape.size() == 2 && shape[0] == 3 && holds_point(shape[1]);
  if (axis + 1 < shape.size()) format += fmt::format(", its axis of {} taken for x y z", columns);
  if (either) format += ", its rows taken for points: save a.T if they are its columns";
  const bool known = columns != 5 && columns != 8 && columns <= FirstNumbers{}.size();
  if (!known) format += fmt::format(", the first 3 of {} columns", columns);
  return format;
}

// Says what an array is instead of points, or what to make of it.
[[noreturn]] void refuse_npy(const Input& input, const NpyHeader& header, std::size_t begin) {
  const std::vector<std::size_t>& shape = header.shape;
  const std::string what =
      fmt::format("'descr': {}, 'shape': {}", excerpt(header.type), excerpt(header.sizes));
  const std::string mended = header.type.starts_with('[') ? mend_fields(header.type) : "";
  if (!mended.empty()) {
    fail(input, "an array of fields, not of rows of x y z: " + what,
         "Make rows of them: " + saved(mended));
  }
  const char kind = header.type.size() > 2 ? header.type[2] : '?';
  if (std::string_view("fiu").find(kind) == std::string_view::npos) {
    fail(input, "no array of rows of x y z in numbers: " + what,
         "Save the points alone by numpy.save, as an array of N rows of x y z");
  }
  if (shape.size() > 1 && !axis_of_points(shape)) {
    if (*std::ranges::min_element(shape) > 2) refuse_npy_image(input, header);
    fail(input, "no array of rows of x y z: " + what, "A cloud needs three numbers a point");
  }
  const std::optional<NumberType> number = header.number();
  if (!number) {
    fail(input, "numbers of a kind that is not read: " + what,
         "Save them as doubles: " + saved("a.astype('<f8')"));
  }
  const std::size_t wide = group_size(input, begin, *number);
  fail(input, "one row of numbers, not rows of x y z: " + what,
       wide == 0 ? "Save the points by numpy.save, as an array of N rows of x y z"
                 : fmt::format("If a point has {0} of them: {1}", wide,
                               saved(fmt::format("a.reshape(-1, {})", wide))));
}

}  // namespace

CloudFile read_npy(const Input& input) {
  constexpr std::size_t kSize = 8;  // bytes before the header's size, which has 2 in version 1
  const std::string_view text = input.text();
  const std::size_t wide = text.size() > 6 && text[6] == 1 ? 2 : 4;
  std::size_t size = text.size();
  if (size >= kSize + wide) {
    const std::byte* at = input.bytes.data() + kSize;
    size = wide == 2 ? load_as<std::uint16_t>(at) : load_as<std::uint32_t>(at);
  }
  const std::size_t begin = kSize + wide + size;
  if (begin > text.size()) fail(input, "the file ends within its header", kSaveAgain);
  const NpyHeader header = npy_header_of(text.substr(kSize + wide, size));
  if (is_picture(header)) {
    fail(input, fmt::format("a picture of bytes, not a cloud: 'shape': {}", excerpt(header.sizes)),
         "Give the camera's depths, or the points");
  }
  const std::optional<NumberType> number = header.number();
  const std::optional<std::size_t> axis = axis_of_points(header.shape);
  if (!number || !axis) refuse_npy(input, header, begin);
  const std::span<const std::size_t> shape(header.shape);
  const std::size_t columns = shape[*axis];
  const std::size_t present = (text.size() - begin) / size_of(*number) / columns;
  const double before = product(shape.first(*axis));
  const double behind = product(shape.subspan(*axis + 1));
  if (static_cast<double>(present) < before * behind) {
    fail_at_byte(input, text.size(),
                 fmt::format("the file ends after {} of {:.0f} points", present, before * behind),
                 kSaveAgain);
  }
  const auto points = static_cast<std::size_t>(before * behind);  // as many as bytes are there for
  const double inner = header.fortran ? before : behind;
  return cloud_of_array(input,
                        {.type = *number,
                         .begin = begin,
                         .points = points,
                         .columns = columns,
                         .inner = std::max<std::size_t>(static_cast<std::size_t>(inner), 1)},
                        format_of(shape, *axis) + unused(present - points));
}

}  // namespace palpate::io
