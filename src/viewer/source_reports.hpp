#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/viewer/viewer_options.hpp"
#include "viewer/text_messages.hpp"

namespace palpate::viewer {

/// How every source of `scene` fares at `now` (s, on the snapshots' clock). Takes milliseconds; any
/// thread but a servo's.
[[nodiscard]] std::vector<SourceReport> source_reports(const Scene& scene,
                                                       std::span<const ViewerStream> streams,
                                                       const Eigen::Vector3d& origin, double now);

}  // namespace palpate::viewer
