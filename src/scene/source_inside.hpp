#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "palpate/scene/source.hpp"
#include "scene/handoff.hpp"
#include "scene/seams.hpp"
#include "scene/snapshot_builder.hpp"
#include "scene/tool_reach.hpp"

namespace palpate {

/// What a source is made of; its scene and the fields of that reach into it.
struct Source::Inside {
  void take_change();
  [[nodiscard]] bool room_for(bool clouds);
  void hand_over(const Source& source, std::shared_ptr<const Snapshot> snapshot);
  void note(const Snapshot& snapshot);
  void note(const SnapshotBuilder& made);
  void compare(const Source& source);

  std::string name;
  mutable std::mutex mutex;  // of what follows; whoever draws, and the preparing thread
  SourceOptions options;
  std::unique_ptr<SnapshotBuilder> changed;  // for the next push
  Eigen::Isometry3d pose;
  PrepareReport report;
  std::shared_ptr<const SurfacePoints> points;
  SourceState state;

  std::unique_ptr<SnapshotBuilder> builder;  // the preparing thread's
  std::vector<Reach> found;                  // likewise
  ReachTable reaches;
  std::shared_ptr<Seams> seams;  // of the scene
  std::size_t place = 0;         // in it
  Handoff<Snapshot> handoff;
};

}  // namespace palpate
