#pragma once

#include <string>

#include "apps/palpate/options/source_options.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::app {

/// Is this file, by its name or its first bytes, an image?
[[nodiscard]] bool is_depth_image(const std::string& path);

/// May this file be an organised cloud? Of one whose header cannot be seen before it is read, yes.
[[nodiscard]] bool may_be_organised(const std::string& path);

/// Reads a depth image as one frame of a camera.
/// @throws Error as read_depth_frame() does, and when no intrinsics are given.
[[nodiscard]] DepthFrame load_depth_image(const std::string& path, const ReadingOptions& options);

}  // namespace palpate::app
