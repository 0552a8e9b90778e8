#pragma once

#include <string>

#include "apps/palpate/report/report.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"

namespace palpate::app {

/// What a run knows of one of its sources and, of a camera, of what became of its frames.
[[nodiscard]] Report source_report(const LoadedSource& source);

/// That of a camera.
[[nodiscard]] Report camera_report(const LoadedSource& source);

/// Says how much of a cloud is no surface that its points agree on, where it is a hundredth or
/// more.
void add_trust(Report& report, const Prepared::Report& prepared);

/// "640 x 480 pixels of a camera of 525 px".
[[nodiscard]] std::string in_words(const CameraModel& camera);

/// The same as data.
[[nodiscard]] Json json_of(const CameraModel& camera);

}  // namespace palpate::app
