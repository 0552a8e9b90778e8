#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

enum class PcdEncoding { ascii, binary, compressed };

struct PcdField {
  std::string name;
  NumberType type = NumberType::float32;
  std::size_t count = 1;   ///< numbers a point
  std::size_t offset = 0;  ///< bytes from the start of a point
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t point_size = 0;  ///< bytes of a binary point
  std::size_t width = 0;
  std::size_t height = 1;
  std::size_t points = 0;
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  ///< position, quaternion w x y z
  PcdEncoding encoding = PcdEncoding::ascii;
  std::size_t size = 0;  ///< bytes up to the data

  [[nodiscard]] bool organised() const { return height > 1; }
};

/// @throws Error that names the line of what is wrong.
[[nodiscard]] PcdHeader read_pcd_header(const Input& input);

/// Unpacks LZF, the compression of "DATA binary_compressed" in PCD files: a control byte below 32
/// announces that many + 1 bytes as they are; above, its upper three bits (7: plus the next byte)
/// hold a length - 2 and its lower five with the next byte a distance back - 1.
/// @return nothing when done; otherwise the offset in `packed` at which the data goes wrong
///   (reaches before the start, past the end, or leaves `unpacked` partly unfilled).
[[nodiscard]] std::optional<std::size_t> lzf_unpack(std::span<const std::byte> packed,
                                                    std::span<std::byte> unpacked);

/// A byte of LZF gives at most this many bytes: 264 from three.
inline constexpr std::size_t kLzfLargestRatio = 88;

/// PCD 0.5 - 0.7: ascii, binary and binary_compressed; organised or not. Kept of a point: normal,
/// colour ("rgb", "rgba": 0x00rrggbb in the bits of a float or an integer) and intensity. The
/// viewpoint is kept when the cloud is organised or the file sets one.
[[nodiscard]] CloudFile read_pcd(const Input& input);

}  // namespace palpate::io
