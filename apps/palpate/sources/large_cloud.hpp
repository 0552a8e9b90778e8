// Declares clouds that become a surface while they are touched.
#pragma once

#include <exception>
#include <memory>
#include <string>

#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::app {

/// Adds a source for a large cloud. The blocks at its middle are touchable at once; the rest
/// follows in the run.
const Source& add_on_demand(Scene& scene, const std::shared_ptr<const PointCloud>& cloud,
                            LoadedSource& result);

/// Adds a source for a store on disk that is too large for --cache: what is around the tools is
/// read in the run. False: it is none, or fits.
/// @throws Error as open_store() and OnDemand do, and where the run needs all of its points.
[[nodiscard]] bool add_store(Scene& scene, const LoadOptions& options, LoadedSource& result);

/// What is reported where a part of a cloud could not be read or prepared.
[[nodiscard]] std::string missing_part(const Source& source, const std::exception& error);

/// Reads what tools may need; reports on standard error what could not be read, and goes on.
bool advance(OnDemand& cloud, Source& source, double now);

/// Shows a source of a new run what was prepared so far, and what is missing. @return false:
/// nothing
[[nodiscard]] bool show_again(OnDemand& cloud, Source& source);

}  // namespace palpate::app
