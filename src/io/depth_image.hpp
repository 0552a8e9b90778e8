#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/input.hpp"

namespace palpate::io {

/// Depths along the optical axis, row by row, in steps of options.depth_unit.
struct DepthImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::uint16_t largest = 65535;  ///< the format's largest value; it marks "no depth"
  std::vector<std::uint16_t> samples;
  std::string format;
};

/// Depth pixels as points of the camera's frame (see Pinhole), seen from zero. Left out and
/// counted as dropped: 0, 65535, the format's largest value and above, and whatever lies beyond
/// ten times the median depth: sensors that match patterns put false matches there, and a true
/// surface that far has too few and too coarse points to be touched.
/// @throws Error when options.intrinsics or depth_unit are absent or senseless.
[[nodiscard]] CloudFile cloud_of(const Input& input, const DepthImage& image);

/// The camera that options.intrinsics describes. @throws Error as above.
[[nodiscard]] Pinhole intrinsics_of(const Input& input, const DepthImage& image);

/// options.depth_unit, m. @throws Error as above.
[[nodiscard]] double unit_of(const Input& input);

/// Is it a depth rather than a mark for "nothing measured"?
[[nodiscard]] bool is_depth(const DepthImage& image, std::uint16_t sample);

/// @throws Error unless `pixels` 16-bit samples could come from `bytes` bytes that deflate packed.
void check_image_size(const Input& input, std::uint64_t width, std::uint64_t height);

/// Do the samples make a smoother picture with their bytes exchanged? Surfaces are smooth, and a
/// swapped image jumps from pixel to pixel by what should be its fine steps.
[[nodiscard]] bool looks_swapped(const DepthImage& image);

/// Exchanges the bytes of every sample.
void swap_bytes(DepthImage& image);

/// A binary PGM ("P5") with a largest value above 255: two bytes a pixel, the more significant
/// first, as its specification has it.
[[nodiscard]] DepthImage read_pgm(const Input& input);

/// A 16-bit grey PNG. @throws Error for any other PNG and for damaged ones.
[[nodiscard]] DepthImage read_png(const Input& input);

}  // namespace palpate::io
