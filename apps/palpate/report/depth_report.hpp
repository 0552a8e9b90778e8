#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/sources/touched.hpp"

namespace palpate::app {

/// What a run knows of a camera and of what became of its frames, for a person.
void print_camera(const TouchedSource& source, const Style& style, std::FILE* out);

/// The same as data: SI units, named in the keys.
[[nodiscard]] nlohmann::ordered_json json_camera(const TouchedSource& source);

/// "640 x 480 pixels of a camera of 525 px".
[[nodiscard]] std::string in_words(const CameraModel& camera);

/// The same as data.
[[nodiscard]] nlohmann::ordered_json json_of(const CameraModel& camera);

/// What it knows of a depth image or organised cloud, which is filtered as a camera's frame is.
void print_depth_image(const TouchedSource& source, const Style& style, std::FILE* out);

[[nodiscard]] nlohmann::ordered_json json_depth_image(const TouchedSource& source);

}  // namespace palpate::app
