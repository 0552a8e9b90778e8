// Reads points from arrays of numbers: NumPy's .npy, and .bin as KITTI has it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "io/formats.hpp"
#include "io/table.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kSaveAgain = "Save it again with numpy.save";

// The number in a row and a column is `row_step` * row + `column_step` * column bytes behind
// `begin`.
struct Array {
  NumberType type = NumberType::float32;
  std::size_t begin = 0;
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::size_t row_step = 0;
  std::size_t column_step = 0;
};

CloudFile cloud_of_array(const Input& input, const Array& array, const std::string& format) {
  constexpr std::size_t kSample = 100;  // rows that show what the columns are (judgement)
  const auto number = [&](std::size_t i, std::size_t k) {
    const std::size_t at = array.begin + i * array.row_step + k * array.column_step;
    return load_number(array.type, input.bytes.data() + at);
  };
  std::vector<FirstNumbers> first(std::min(array.rows, kSample));
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t used = std::min(array.columns, first[i].size());
    for (std::size_t k = 0; k < used; ++k) first[i][k] = number(i, k);
  }
  const Roles roles = guess_roles(array.columns, first);
  CloudBuilder builder(input, roles.columns(), ColorScale::guess, array.rows);
  Progress progress(input.options, array.rows);
  Row row{};
  for (std::size_t i = 0; i < array.rows; ++i) {
    for (std::size_t k = 0; k < roles.size(); ++k) row[index_of(*roles[k])] = number(i, k);
    builder.add(row);
    progress.at(i);
  }
  return builder.finish(format);
}

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

// What to make of an array `a` so that it holds rows of points; nothing where it does.
std::string_view mend(std::string_view type, bool is_number, std::span<const std::size_t> shape) {
  if (type.starts_with('[')) return "np.stack([a[k] for k in 'xyz'], -1)";  // fields
  if (!is_number) return "a.astype('<f8')";
  if (shape.size() != 2) return "a.reshape(-1, 3)";
  const bool across = shape[1] > FirstNumbers{}.size() && shape[1] > shape[0];
  return shape[1] < 3 || across ? "a.T" : "";
}

CloudFile read_npy(const Input& input) {
  constexpr std::size_t kSize = 8;  // bytes before the header's size, which has 2 in version 1
  const std::string_view text = input.text();
  const std::size_t wide = text.size() > 6 && text[6] == 1 ? 2 : 4;
  std::size_t size = text.size();
  if (size >= kSize + wide) {
    const std::byte* at = input.bytes.data() + kSize;
    size = wide == 2 ? load_as<std::uint16_t>(at) : load_as<std::uint32_t>(at);
  }
  Array array{.begin = kSize + wide + size};
  if (array.begin > text.size()) fail(input, "the file ends within its header", kSaveAgain);
  const std::string_view header = text.substr(kSize + wide, size);
  const std::string_view type = value_of(header, "'descr':");
  // "'<f4'": the order of bytes, a letter, and a number of bytes.
  const bool plain = type.size() > 4 && type[0] == '\'' && type[4] == '\'' && type[1] != '>';
  const auto number =
      plain ? number_type(type.substr(2, 1), parse_count(type.substr(3, 1)).value_or(0))
            : std::nullopt;
  const std::string_view sizes = value_of(header, "'shape':");
  const std::vector<std::size_t> shape = shape_of(sizes);
  if (const std::string_view mended = mend(type, number.has_value(), shape); !mended.empty()) {
    fail(input,
         fmt::format("no array of rows of x y z in numbers: 'descr': {}, 'shape': {}",
                     excerpt(type), excerpt(sizes)),
         fmt::format("Make it one: python3 -c \"import numpy as np; a = np.load('IN.npy'); "
                     "np.save('OUT.npy', {})\"",
                     mended));
  }
  std::tie(array.type, array.rows, array.columns) = std::tuple(*number, shape[0], shape[1]);
  const std::size_t present = (text.size() - array.begin) / size_of(array.type) / array.columns;
  if (present < array.rows) {
    fail_at_byte(input, text.size(),
                 fmt::format("the file ends after {} of {} rows", present, array.rows), kSaveAgain);
  }
  const bool fortran = value_of(header, "'fortran_order':").starts_with("True");
  array.row_step = size_of(array.type) * (fortran ? 1 : array.columns);
  array.column_step = size_of(array.type) * (fortran ? array.rows : 1);
  return cloud_of_array(input, array, "NumPy array" + unused(present - array.rows));
}

// Do neighbouring points differ less in groups of `wide` numbers? Scans go from point to point.
bool lies_in_groups_of(std::size_t wide, std::span<const std::byte> bytes) {
  constexpr std::size_t kNumbers = 4096;  // that are looked at (judgement)
  const std::size_t count = std::min(bytes.size() / sizeof(float), kNumbers);
  const auto difference = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < count; ++i) {
      const auto a = load_as<float>(bytes.data() + i * sizeof(float));
      sum += std::abs(
          static_cast<double>(load_as<float>(bytes.data() + (i + lag) * sizeof(float)) - a));
    }
    return sum / static_cast<double>(std::max<std::size_t>(count - lag, 1));
  };
  return count > 8 * wide && 2 * difference(wide) < difference(4);  // by far; judgement
}

// Where numbers are not in groups of x y z intensity, coordinates come where intensities are to be.
// Whole numbers and doubles are floats of absurd sizes.
CloudFile read_kitti(const Input& input) {
  constexpr std::size_t kPoint = 16;  // bytes: four floats
  const std::size_t size = input.bytes.size();
  const auto is_right = [&](std::size_t at) {
    const auto value = load_as<float>(input.bytes.data() + at);
    const float length = std::abs(value);
    const bool is_length = value == 0 || (length > 1e-20F && length < 1e7F);  // m; the Earth
    return is_length && (at % kPoint != kPoint - sizeof(float) || value >= 0);
  };
  std::size_t at = 0;
  while (at + sizeof(float) <= size && is_right(at)) at += sizeof(float);
  const auto fits = [&](std::size_t wide) { return lies_in_groups_of(wide, input.bytes); };
  if (at < size || size % kPoint != 0 || fits(3) || fits(5) || fits(6)) {
    fail_at_byte(
        input, at,
        "not points of four floats, x y z and an intensity of 0 or more, as KITTI has them",
        "If its points are N floats: python3 -c \"import numpy as np; "
        "np.save('OUT.npy', np.fromfile('IN.bin', '<f4').reshape(-1, N)[:, :3])\"");
  }
  return cloud_of_array(
      input,
      {.rows = size / kPoint, .columns = 4, .row_step = kPoint, .column_step = sizeof(float)},
      "KITTI's points");
}

}  // namespace

CloudFile read_array(const Input& input) {
  return input.text().starts_with("\x93NUMPY") ? read_npy(input) : read_kitti(input);
}

}  // namespace palpate::io
