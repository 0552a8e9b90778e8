#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>

#include "palpate/scene/source.hpp"

namespace palpate {

class Seams;

/// The sources that are touched together. Depends on no camera and owns no thread. Outlives every
/// SceneField made of it; sources are added before the first of them.
class Scene {
 public:
  static constexpr std::size_t kMaxSources = 8;  // judgement: arrays are this long

  /// Adds a source that something else will publish to.
  /// @throws Error when the name is taken, the scene is full, or a SceneField looks at it: that
  /// would never see the new source.
  Source& add(std::string name, const SourceOptions& options = {});

  /// Adds a static cloud, and prepares it here.
  /// @throws Error as above, and as prepare() does.
  Source& add(std::string name, const PointCloud& cloud, const SourceOptions& options = {});

  [[nodiscard]] std::size_t size() const { return sources_.size(); }
  [[nodiscard]] Source& source(std::size_t i) { return sources_[i]; }
  [[nodiscard]] const Source& source(std::size_t i) const { return sources_[i]; }

  /// State of the i-th source with its disagreement with the others. Takes milliseconds; any
  /// thread but a servo's.
  [[nodiscard]] Source::State state(std::size_t i) const;

 private:
  friend class FollowedSources;

  std::deque<Source> sources_;
  std::shared_ptr<Seams> seams_;
  std::shared_ptr<std::atomic<int>> fields_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace palpate
