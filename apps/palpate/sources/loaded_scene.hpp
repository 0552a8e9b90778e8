#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/sources/cloud_facts.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/on_demand.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"
#include "session/length_unit.hpp"

namespace palpate::app {

/// Timing and frames of a camera during a run.
struct FeedReport {
  StreamState state;
  int width = 0;  ///< of the last frame, pixels
  int height = 0;
  bool simulated = false;          ///< in simulated time, where no frame is overtaken
  std::vector<double> prepare_ms;  ///< computing time of each frame's preparation, ms
  std::vector<double> latency_s;   ///< from each frame's stamp until its surface was felt, s
};

/// One source of a run. Points themselves live in the scene.
struct LoadedSource {
  SourcePlan plan;  ///< of a camera with the range of depths that its first frame requires
  Prepared::Report prepared;  ///< of a cloud
  Source::State state;        ///< of a depth image; of a stream, after the run

  // Files:
  bool depth_image = false;  ///< or an organised cloud that is felt as one
  std::string format;
  std::size_t declared = 0;
  std::size_t dropped = 0;
  std::optional<SplatFacts> splats = {};  ///< of a scene of splats
  std::optional<MeshFacts> mesh = {};     ///< of a file with faces
  double read_seconds = 0;
  FileUnit unit;                        ///< of a file
  session::UnitsGuess units;            ///< what is to be said of it
  double prepare_seconds = 0;           ///< wall time of everything between reading and touching
  std::unique_ptr<OnDemand> on_demand;  ///< of a large cloud whose blocks become ready in the run
  bool paged = false;                   ///< it is a store on disk, of which memory holds a part
  std::shared_ptr<const PointCloud> cloud;  ///< where it may have to be prepared again
  std::shared_ptr<const DepthFrame> image;  ///< the same of a depth image

  // Streams:
  std::unique_ptr<DepthCamera> camera;  ///< null: it stands still
  CameraModel lens;                     ///< of its first frame; of an organised cloud, too
  bool posed = false;                   ///< its frames store where it stands
  FeedReport feed;                      ///< after the run
};

/// The scene, and all that is measured of it before the first step.
struct LoadedScene {
  std::vector<LoadedSource> sources;
  /// Prepared surfaces; for cameras the first frame and its pose, if `explored` was requested.
  Scene scene;
};

/// The names of all sources, for pictures and pages.
[[nodiscard]] std::string title_of(const LoadedScene& loaded);

/// Are all sources in the axes of a camera's picture, x to the right and y down?
[[nodiscard]] bool in_picture_axes(const LoadedScene& loaded);

struct LoadOptions {
  bool explored = false;         ///< the surface has to be there before the run
  bool keep_clouds = false;      ///< they may have to be prepared again, or may be recorded
  bool recorded = false;         ///< they are, from the run's beginning
  bool on_demand = false;        ///< large clouds become whole in the run
  const Clock* clock = nullptr;  ///< of cameras, which it outlives; null: simulated time
};

/// Reads every cloud, prepares it and puts it into the scene; opens every camera and waits for its
/// first frame or, if the surface is to be explored before the run, prepares frames until one of
/// the first second shows a surface.
/// @throws Error as reading, opening and preparing do.
[[nodiscard]] LoadedScene load_sources(const std::vector<SourcePlan>& sources,
                                       const LoadOptions& options);

/// Makes the scene what a run begins with: clouds as they were prepared, with another soft material
/// (how hard the hardest points are may be measured after preparation only); cameras without a
/// surface.
void begin_run(LoadedScene& loaded, const SourceOptions::SoftMaterial& soft);

/// Makes a camera's frame part of its source in the scene: by the depth filter or, where that is
/// wanted, as a cloud.
/// @throws Error as Source::push() does, and when nothing that the filter could take is in its
/// range.
void push_frame(const LoadedSource& from, Source& to, const DepthFrame& frame,
                const Source::StartTime& start);

}  // namespace palpate::app
