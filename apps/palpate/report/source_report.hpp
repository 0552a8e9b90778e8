#pragma once

#include <string>

#include "apps/palpate/report/report.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"

namespace palpate::app {

/// Advice for a cloud that is on_a_line().
inline constexpr const char* kNoSurface =
    "all points are at one place or on a line, where no surface is";

/// Report on a source of a run; for a camera also on its frames.
[[nodiscard]] Report source_report(const LoadedSource& source);

/// The same of a camera.
[[nodiscard]] Report camera_report(const LoadedSource& source);

/// Reports how much of a cloud has low trust, where it is a hundredth or more.
void add_trust(Report& report, const Prepared::Report& prepared);

/// Adds the row "splats": how those of a file became `points`. `declared`: splats in the file,
/// `dropped`: those of them that are not finite.
void add_splats(Report& report, const SplatFacts& splats, std::size_t declared, std::size_t dropped,
                std::size_t points);

/// Adds the row "mesh": "of 12 triangles: felt as `points` points sampled from it, ...".
void add_mesh(Report& report, const MeshFacts& mesh, std::size_t points);

/// Adds the row "organised": "640 x 480 pixels, focal length 525 px, `processed`".
void add_organised(Report& report, const CameraModel& camera, const std::string& processed);

}  // namespace palpate::app
