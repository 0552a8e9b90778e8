#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "palpate/depth/depth_frame.hpp"

namespace palpate {

struct ReadDepthOptions {
  CameraModel camera;        ///< its pinhole is needed; width and height 0: whatever the image has
  double depth_unit = 1e-3;  ///< metres a step of the image
  /// Values that mean "nothing measured", besides 0, 65535 and a PGM's largest.
  std::vector<std::uint16_t> invalid = {};
  bool swapped = false;  ///< the less significant byte comes first, against both formats' rules
};

/// Reads a 16-bit grey PNG or PGM (gzip around it too) as the image of a depth camera, whatever its
/// name says. Stamp, pose and colours stay for the caller to set.
/// @throws Error that names the file and a remedy: for anything else, for images that are cut or of
///   another size than options.camera says, and for such whose bytes look swapped and
///   options.swapped is not set.
[[nodiscard]] DepthFrame read_depth_frame(const std::filesystem::path& path,
                                          const ReadDepthOptions& options);

/// The same into a frame whose memory is used again. On an Error, `frame` is what it was.
void read_depth_frame(const std::filesystem::path& path, const ReadDepthOptions& options,
                      DepthFrame& frame);

/// The same for bytes in memory. `name` stands for the file in messages.
[[nodiscard]] DepthFrame read_depth_frame_bytes(std::span<const std::byte> bytes,
                                                const std::string& name,
                                                const ReadDepthOptions& options);

}  // namespace palpate
