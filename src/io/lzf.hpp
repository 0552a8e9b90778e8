#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace palpate::io {

/// Unpacks LZF, the compression of "DATA binary_compressed" in PCD files: a control byte below 32
/// announces that many + 1 bytes as they are; above, its upper three bits (7: plus the next byte)
/// hold a length - 2 and its lower five with the next byte a distance back - 1.
/// @return nothing when done; otherwise the offset in `packed` at which the data goes wrong
///   (reaches before the start, past the end, or leaves `unpacked` partly unfilled).
[[nodiscard]] std::optional<std::size_t> lzf_unpack(std::span<const std::byte> packed,
                                                    std::span<std::byte> unpacked);

/// A byte of LZF gives at most this many bytes: 264 from three.
inline constexpr std::size_t kLzfLargestRatio = 88;

}  // namespace palpate::io
