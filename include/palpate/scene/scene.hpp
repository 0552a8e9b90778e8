#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "palpate/scene/source.hpp"

namespace palpate {

/// The sources that are touched together. Knows no camera and owns no thread. Outlives every
/// SceneField made of it; sources are added before.
class Scene {
 public:
  static constexpr std::size_t kMaxSources = 8;

  /// Adds a source that something else will publish to.
  /// @throws Error when the name is taken or the scene is full.
  Source& add(std::string name, const SourceOptions& options = {});

  /// Adds a cloud that stands still, and prepares it here.
  /// @throws Error likewise, and as prepare() does.
  Source& add(std::string name, const PointCloud& cloud, const SourceOptions& options = {});

  [[nodiscard]] std::size_t size() const { return sources_.size(); }
  [[nodiscard]] Source& source(std::size_t i) { return sources_[i]; }
  [[nodiscard]] const Source& source(std::size_t i) const { return sources_[i]; }

 private:
  std::deque<Source> sources_;
};

}  // namespace palpate
