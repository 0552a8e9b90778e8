// Makes COPC files.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "io/laz/laz_file.hpp"
#include "io/laz_encoder.hpp"
#include "io/laz_survey.hpp"

namespace palpate {

inline constexpr std::size_t kCopcInfo =
    375 + 54;  // the record's contents, in a file of version 1.4

struct CopcEntry {
  std::array<std::int32_t, 4> key;  // level, x, y, z
  std::uint64_t place;
  std::int32_t bytes;
  std::int32_t points;
};

inline void append_copc_page(std::string& bytes, std::span<const CopcEntry> entries) {
  for (const CopcEntry& entry : entries) {
    for (const std::int32_t number : entry.key) append(bytes, number);
    append(bytes, entry.place);
    append(bytes, entry.bytes);
    append(bytes, entry.points);
  }
}

/// A file of five chunks under a root, whose last two are listed on a page of their own. `change`
/// may spoil the entries.
inline std::string copc_bytes(const std::function<void(std::vector<CopcEntry>&)>& change = {},
                              int format = 7) {
  std::string record(54 + 160, '\0');
  record.replace(2, 4, "copc");
  overwrite<std::uint16_t>(record, 18, 1);
  overwrite<std::uint16_t>(record, 20, 160);
  const double octree[] = {10, 20, 30, 64, 2};
  for (std::size_t i = 0; i < 5; ++i) overwrite(record, 54 + 8 * i, octree[i]);
  const std::string las = survey_of({.format = format, .points = 2000});
  std::string bytes = laz_of(las, {.chunk = 400, .record = record});
  const ReadOptions options;
  const io::Input input{std::as_bytes(std::span(bytes)), "a.copc.laz", options};
  const auto chunks = io::laz::read_chunk_table(input, io::read_las_header(input));
  const std::array<std::int32_t, 4> keys[] = {
      {0, 0, 0, 0}, {1, 0, 1, 1}, {1, 1, 0, 0}, {2, 2, 1, 0}, {3, 5, 3, 1}};
  std::vector<CopcEntry> entries;
  for (std::size_t i = 0; i < 5; ++i) {
    entries.push_back({keys[i], chunks[i].offset, static_cast<std::int32_t>(chunks[i].bytes),
                       static_cast<std::int32_t>(chunks[i].points)});
  }
  entries.push_back({{1, 1, 1, 1}, 0, 0, 0});  // a node without points
  entries.push_back({{2, 2, 1, 0}, bytes.size(), 64, -1});
  std::swap(entries[3], entries[5]);
  std::swap(entries[4], entries[6]);  // now root, two, empty, page; the page's two
  if (change) change(entries);
  append_copc_page(bytes, std::span(entries).subspan(5));
  overwrite<std::uint64_t>(bytes, kCopcInfo + 40, bytes.size());
  overwrite<std::uint64_t>(bytes, kCopcInfo + 48, 32 * 5);
  append_copc_page(bytes, std::span(entries).first(5));
  return bytes;
}

}  // namespace palpate
