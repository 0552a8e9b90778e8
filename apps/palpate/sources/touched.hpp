#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/palpate/options/chosen_source.hpp"
#include "apps/palpate/sources/cloud_facts.hpp"
#include "apps/palpate/sources/feed_report.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

/// One source of a run. Points themselves live in the scene.
struct TouchedSource {
  CloudArgument argument;
  SourceOptions options;
  PrepareReport prepared;  ///< of a cloud
  SourceState state;       ///< of a depth image; of what lives, after the run

  // Of what stands still:
  bool depth_image = false;  ///< or an organised cloud that is felt as one
  std::string format;
  std::size_t declared = 0;
  std::size_t dropped = 0;
  double read_seconds = 0;
  UnitsGuess units;            ///< of a file that was read without --scale
  double prepare_seconds = 0;  ///< wall time of everything between reading and touching
  std::shared_ptr<const PointCloud> cloud;  ///< where it may have to be prepared again

  // Of what lives:
  std::unique_ptr<DepthCamera> camera;  ///< null: it stands still
  bool as_cloud = false;                ///< its frames are taken as clouds
  CameraModel lens;                     ///< of its first frame; of an organised cloud, too
  FeedReport feed;                      ///< after the run
};

/// What is touched: everything that is known of it before the first step.
struct Touched {
  std::vector<TouchedSource> sources;
  /// As prepared before the run; of a camera its first frame, where `explored` was asked for, and
  /// its pose then.
  Scene scene;
};

/// The names of all sources, for pictures and pages.
[[nodiscard]] std::string title_of(const Touched& touched);

/// Reads every cloud, prepares it and puts it into the scene; opens every camera and waits for its
/// first frame or, if the surface is to be `explored` before the run, prepares frames until one of
/// the first second shows a surface. Cameras keep the time of `clock`, which outlives them; null:
/// simulated time.
/// @throws UsageError when a pose names no source; Error as reading, opening and preparing do.
[[nodiscard]] Touched prepare_touched(const TouchOptions& options, bool explored,
                                      const Clock* clock = nullptr);

/// Puts into `scene` what is felt in the run: clouds as they were prepared, shared, with another
/// soft material (how hard the hardest points are may be known after preparation only); cameras
/// without a surface yet.
void fill_felt(Scene& scene, const Touched& touched, const SoftMaterial& soft);

/// Makes a camera's frame part of what is felt: by the depth filter or, where that is wanted, as a
/// cloud. @throws Error as Source::push() does, and when nothing that the filter could take is in
/// its range.
void push_frame(const TouchedSource& touched, Source& felt, const DepthFrame& frame,
                const StartTime& start);

}  // namespace palpate::app
