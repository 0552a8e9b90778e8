// Declares the decoders of a LAZ chunk's points.
#pragma once

#include <cstddef>
#include <span>

#include "io/formats.hpp"

namespace palpate::io::laz {

/// Decodes the points of one chunk, whose length sets how many there are. `chunk` holds a whole
/// record at least, unless there are no points.
/// @return the points before the bytes ended, or stopped making sense: all of them for a chunk
///   that is whole.
[[nodiscard]] std::size_t decode_points(const LasHeader& header, std::span<const std::byte> chunk,
                                        std::span<LasPoint> points);

/// Point formats 0 - 3 (LAZ's compressor 2).
[[nodiscard]] std::size_t decode_points_10(const LasHeader& header,
                                           std::span<const std::byte> chunk,
                                           std::span<LasPoint> points);

/// Point formats 6 - 8 (compressor 3).
[[nodiscard]] std::size_t decode_points_14(const LasHeader& header,
                                           std::span<const std::byte> chunk,
                                           std::span<LasPoint> points);

}  // namespace palpate::io::laz
