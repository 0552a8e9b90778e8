// Reads points from arrays of numbers: .bin as KITTI has it, and what NumPy's .npy holds.
#include "io/arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io/formats.hpp"
#include "io/table.hpp"

namespace palpate::io {

CloudFile cloud_of_array(const Input& input, const Array& array, const std::string& format) {
  constexpr std::size_t kSample = 100;  // rows that show what the columns are (judgement)
  const std::size_t step = array.inner * size_of(array.type);  // from a point's number to its next
  const auto number = [&](std::size_t i, std::size_t k) {
    const std::size_t outer = i / array.inner * array.columns * step;
    const std::size_t at = array.begin + outer + i % array.inner * size_of(array.type) + k * step;
    return load_number(array.type, input.bytes.data() + at);
  };
  std::vector<FirstNumbers> first(std::min(array.points, kSample));
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t used = std::min(array.columns, first[i].size());
    for (std::size_t k = 0; k < used; ++k) first[i][k] = number(i, k);
  }
  const Roles roles = guess_roles(array.columns, first);
  CloudBuilder builder(input, roles.columns(), ColorScale::guess, array.points);
  Progress progress(input.options, array.points);
  Row row{};
  for (std::size_t i = 0; i < array.points; ++i) {
    for (std::size_t k = 0; k < roles.size(); ++k) row[index_of(*roles[k])] = number(i, k);
    builder.add(row);
    progress.at(i);
  }
  return builder.finish(format);
}

namespace {

constexpr std::size_t kLooked = 4096;  // numbers, to see in which groups they are (judgement)

// How much numbers differ from those `lag` behind them, on average, where both are finite.
double difference(const Input& input, const Array& numbers, std::size_t lag) {
  const std::size_t count = std::min(numbers.points, kLooked);
  const auto at = [&](std::size_t i) {
    return load_number(numbers.type,
                       input.bytes.data() + numbers.begin + i * size_of(numbers.type));
  };
  double sum = 0;
  double compared = 0;
  for (std::size_t i = 0; i + lag < count; ++i) {
    const double step = std::abs(at(i + lag) - at(i));
    if (!std::isfinite(step)) continue;
    sum += step;
    ++compared;
  }
  return compared > 0 ? sum / compared : std::numeric_limits<double>::infinity();
}

Array numbers_from(const Input& input, std::size_t begin, NumberType type) {
  return {.type = type, .begin = begin, .points = (input.bytes.size() - begin) / size_of(type)};
}

}  // namespace

std::size_t group_size(const Input& input, std::size_t begin, NumberType type) {
  constexpr double kAlike = 1.1;  // twice the group fits as well; judgement
  const Array numbers = numbers_from(input, begin, type);
  std::array<double, FirstNumbers{}.size() + 1> differences{};
  differences.fill(std::numeric_limits<double>::infinity());
  for (std::size_t wide = 3; wide < differences.size(); ++wide) {
    if (numbers.points % wide == 0) differences[wide] = difference(input, numbers, wide);
  }
  const double least = *std::ranges::min_element(differences);
  for (std::size_t wide = 3; wide < differences.size(); ++wide) {
    const bool divides = numbers.points > 0 && numbers.points % wide == 0;
    if (divides && !(differences[wide] > kAlike * least)) return wide;
  }
  return 0;
}

namespace {

// A float that may be a length in metres: 0, or at most the size of the Earth.
bool is_length(float value) {
  const float length = std::abs(value);
  return value == 0 || (length > 1e-20F && length < 1e7F);
}

// The first half of a double is 0 in round numbers, and anything in others; the second half is no
// length of absurd size.
bool are_doubles(const Input& input) {
  const std::size_t size = input.bytes.size();
  if (size % sizeof(double) != 0) return false;
  std::size_t odd = 0;
  const std::size_t count = std::min(size / sizeof(double), kLooked);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* const at = input.bytes.data() + i * sizeof(double);
    const auto first = load_as<float>(at);
    if (!is_length(load_as<float>(at + sizeof(float)))) return false;
    odd += first == 0 || !is_length(first) ? 1 : 0;
  }
  return 2 * odd > count;
}

[[noreturn]] void refuse_bin(const Input& input, std::size_t at) {
  const bool doubles = are_doubles(input);
  const std::size_t wide =
      group_size(input, 0, doubles ? NumberType::float64 : NumberType::float32);
  const std::size_t bytes = doubles ? sizeof(double) : sizeof(float);
  constexpr std::string_view kWhat =
      "not points of four floats, x y z and an intensity of 0 or more, as KITTI has them";
  if (wide == 0 || input.bytes.size() % bytes != 0) {
    fail_at_byte(input, at, kWhat,
                 "Save the points by numpy.save, as an array of N rows of x y z, or as PLY");
  }
  fail_at_byte(
      input, at, kWhat,
      fmt::format("If its points are {0} {1} each: python3 -c \"import numpy as np; "
                  "np.save('OUT.npy', np.fromfile('IN.bin', '<f{2}').reshape(-1, {0})[:, :3])\"",
                  wide, doubles ? "doubles" : "floats", bytes));
}

// Where numbers are not in groups of x y z intensity, coordinates come where intensities are to be.
// Whole numbers and doubles are floats of absurd sizes.
CloudFile read_kitti(const Input& input) {
  constexpr std::size_t kPoint = 16;  // bytes: four floats
  const std::size_t size = input.bytes.size();
  const auto is_right = [&](std::size_t at) {
    const auto value = load_as<float>(input.bytes.data() + at);
    return is_length(value) && (at % kPoint != kPoint - sizeof(float) || value >= 0);
  };
  std::size_t at = 0;
  while (at + sizeof(float) <= size && is_right(at)) at += sizeof(float);
  const Array numbers = numbers_from(input, 0, NumberType::float32);
  // Do neighbouring points differ less in other groups, by far? Scans go from point to point.
  const auto fits = [&](std::size_t wide) {
    return std::min(numbers.points, kLooked) > 8 * wide &&
           2 * difference(input, numbers, wide) < difference(input, numbers, 4);  // judgement
  };
  if (at < size || size % kPoint != 0 || fits(3) || fits(5) || fits(6) || fits(7)) {
    refuse_bin(input, at);
  }
  return cloud_of_array(input, {.points = size / kPoint, .columns = 4}, "KITTI's points");
}

}  // namespace

CloudFile read_array(const Input& input) {
  return input.text().starts_with("\x93NUMPY") ? read_npy(input) : read_kitti(input);
}

}  // namespace palpate::io
