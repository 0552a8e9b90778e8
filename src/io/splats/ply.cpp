// Reads splats from PLY files, as trained or compressed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/formats.hpp"
#include "io/ply_rows.hpp"
#include "io/splats/splats.hpp"

namespace palpate::io {
namespace {

// Properties of a splat, in the order in which they are taken.
constexpr std::string_view kTrained[] = {"x",      "y",       "z",       "f_dc_0",  "f_dc_1",
                                         "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                                         "rot_0",  "rot_1",   "rot_2",   "rot_3"};
constexpr std::size_t kThirdScale = 9;
constexpr std::string_view kPacked[] = {"packed_position", "packed_rotation", "packed_scale",
                                        "packed_color"};
constexpr std::string_view kChunk[] = {
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
constexpr std::size_t kNecessary = 12;  // of a chunk's: those of colours may be missing
using Chunk = std::array<double, std::size(kChunk)>;
constexpr std::size_t kChunkSize = 256;  // splats (format)

bool has_all(const PlyElement& element, std::span<const std::string_view> names) {
  return std::ranges::all_of(names, [&](std::string_view name) {
    return std::ranges::find(element.properties, name, &PlyProperty::name) !=
           element.properties.end();
  });
}

bool is_trained(const PlyElement& element) {
  constexpr std::string_view kTelling[] = {"x", "y", "z", "opacity", "scale_0", "rot_0", "rot_3"};
  return has_all(element, kTelling);
}

bool is_packed(const PlyElement& element) {
  return has_all(element, kPacked);
}

bool is_chunk(const PlyElement& element) {
  return has_all(element, std::span(kChunk).first(kNecessary));
}

Splat trained_splat(std::span<const double> row) {
  Splat splat;
  const auto number = [&](std::size_t k) { return static_cast<float>(row[k]); };
  splat.position = {number(0), number(1), number(2)};
  splat.color = color_of({row[3], row[4], row[5]});
  splat.opacity = static_cast<float>(1 / (1 + std::exp(-row[6])));
  for (int k = 0; k < 3; ++k) splat.sigma[k] = std::exp(number(7 + static_cast<std::size_t>(k)));
  splat.rotation = {number(10), number(11), number(12), number(13)};
  return splat;
}

SplatFile read_trained(const Input& input, const PlyHeader& header, const PlyElement& element) {
  SplatFile rows{.format = std::string(name_of(header.encoding))};
  rows.splats.reserve(most_rows(input, header, element));
  PlyTable table = table_of(element, kTrained);
  table.row[kThirdScale] = -std::numeric_limits<double>::infinity();  // a flat splat has none
  table.take = [&](std::span<const double> row) { rows.add(trained_splat(row), input.unit.plan); };
  rows.format += unused(read_ply_rows(input, header, {&table, 1}));
  return rows;
}

// `bits` of a word from bit `from` up, as 0 to 1.
double share_of(std::uint32_t word, int from, int bits) {
  const std::uint32_t mask = (1U << bits) - 1;
  return static_cast<double>(word >> from & mask) / mask;
}

// Three numbers in 11, 10 and 11 bits, from `chunk[at]` to `chunk[at + 3]` and so on.
Eigen::Vector3f unpack_vector(std::uint32_t word, const Chunk& chunk, std::size_t at) {
  const double shares[] = {share_of(word, 21, 11), share_of(word, 11, 10), share_of(word, 0, 11)};
  Eigen::Vector3f vector;
  for (std::size_t k = 0; k < 3; ++k) {
    const double least = chunk[at + k];
    const double most = chunk[at + 3 + k];
    vector[static_cast<Eigen::Index>(k)] = static_cast<float>(least + shares[k] * (most - least));
  }
  return vector;
}

Splat packed_splat(std::span<const double> row, const Chunk& chunk) {
  std::array<std::uint32_t, 4> words;
  std::ranges::transform(row, words.begin(), [](double value) {
    return value >= 0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0U;
  });
  Splat splat;
  splat.position = unpack_vector(words[0], chunk, 0);
  splat.sigma = unpack_vector(words[2], chunk, 6).array().exp();
  Eigen::Vector3f others;
  for (int k = 0; k < 3; ++k) {
    others[k] =
        static_cast<float>((share_of(words[1], 20 - 10 * k, 10) - 0.5) * std::numbers::sqrt2);
  }
  const Eigen::Vector4f turn = with_largest(words[1] >> 30, others);  // w x y z
  splat.rotation = {turn[0], turn[1], turn[2], turn[3]};
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = share_of(words[3], 24 - 8 * static_cast<int>(k), 8);
    const double value = chunk[12 + k] + share * (chunk[15 + k] - chunk[12 + k]);
    splat.color[k] = byte_of(value);
  }
  splat.opacity = static_cast<float>(share_of(words[3], 0, 8));
  return splat;
}

void check_chunks(const Input& input, const PlyElement& chunks, const PlyElement& splats) {
  if (splats.count / kChunkSize + (splats.count % kChunkSize != 0 ? 1 : 0) == chunks.count) return;
  fail(input, fmt::format("{} chunks for {} splats; a chunk holds 256", chunks.count, splats.count),
       "The file is damaged: export it again");
}

SplatFile read_packed(const Input& input, const PlyHeader& header, const PlyElement& chunk_element,
                      const PlyElement& element) {
  check_chunks(input, chunk_element, element);
  SplatFile rows{.format = fmt::format("{}, compressed", name_of(header.encoding))};
  std::vector<Chunk> chunks;
  std::size_t done = 0;
  PlyTable tables[] = {table_of(chunk_element, kChunk), table_of(element, kPacked)};
  std::fill(tables[0].row.begin() + 15, tables[0].row.end(), 1);  // colours that have no bounds
  tables[0].take = [&](std::span<const double> row) {
    std::ranges::copy(row, chunks.emplace_back().begin());
  };
  tables[1].take = [&](std::span<const double> row) {
    rows.add(packed_splat(row, chunks[done++ / kChunkSize]), input.unit.plan);
  };
  rows.splats.reserve(most_rows(input, header, element));
  rows.format += unused(read_ply_rows(input, header, tables));
  return rows;
}

}  // namespace

bool holds_splats(const PlyHeader& header) {
  return std::ranges::any_of(header.elements, [](const PlyElement& element) {
    return is_trained(element) || is_packed(element);
  });
}

SplatFile read_splat_ply(const Input& input) {
  const PlyHeader header = read_ply_header(input);
  const auto trained = std::ranges::find_if(header.elements, is_trained);
  if (trained != header.elements.end()) return read_trained(input, header, *trained);
  const auto packed = std::ranges::find_if(header.elements, is_packed);
  if (packed == header.elements.end()) {
    fail(input, "no element of this PLY file holds splats", "Export it again with its splats");
  }
  const auto chunk = std::find_if(header.elements.begin(), packed, is_chunk);
  if (chunk == packed) {
    fail(input, "its packed splats come without an element \"chunk\" before them",
         "The file is damaged: export it again");
  }
  return read_packed(input, header, *chunk, *packed);
}

}  // namespace palpate::io
