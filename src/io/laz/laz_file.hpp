// Declares what leads to the chunks of a LAZ file.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/formats.hpp"

namespace palpate::io::laz {

/// Some points of a file, compressed by themselves.
struct Chunk {
  std::size_t offset = 0;  ///< bytes from the start of the file
  std::size_t bytes = 0;
  std::size_t first = 0;  ///< its first point among those of the file
  std::size_t points = 0;
};

/// Points of each chunk but the last; nothing: the chunk table stores it of each.
/// @throws Error for compressors, versions and point formats that are not read.
[[nodiscard]] std::optional<std::size_t> read_chunk_size(const Input& input,
                                                         const LasHeader& header);

/// False where so few bytes cannot be one or more chunks of so many points.
[[nodiscard]] bool can_hold(const LasHeader& header, std::size_t bytes, std::size_t points);

/// Refuses a chunk, which `what` names, of whose points fewer than `points` could be decoded.
void require_whole(const Input& input, std::size_t offset, std::string_view what,
                   std::size_t decoded, std::size_t points);

/// The chunks in the order of their points, all of them within the file. There are no more points
/// than their bytes can hold.
/// @throws Error that names the byte of what is wrong.
[[nodiscard]] std::vector<Chunk> read_chunk_table(const Input& input, const LasHeader& header);

/// The same of a file that is not in memory: `head` is what lies before its points.
[[nodiscard]] std::vector<Chunk> read_chunk_table(const Input& head, const LasHeader& header,
                                                  const Parts& file);

}  // namespace palpate::io::laz
