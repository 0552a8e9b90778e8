#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>

#include "field/evaluate.hpp"
#include "palpate/scene/scene_field.hpp"
#include "scene/source_view.hpp"
#include "scene/tool_reach.hpp"

namespace palpate {

/// A cloud's surface may rise this fast and still take a resting proxy along, m/s (judgement).
inline constexpr double kFastestCloud = 0.5;

/// All sources of a scene as one field follows them: lists which layers count now, and reports to
/// the sources where the tool can be next. Real-time but for construction and destruction.
class FollowedSources {
 public:
  /// `name`: for reports of stalled fields. `scale`: metres that the tool goes for one of the hand.
  /// @throws Error when the scene has too many readers.
  FollowedSources(Scene& scene, const std::string& name, double scale);
  ~FollowedSources();
  FollowedSources(const FollowedSources&) = delete;
  FollowedSources& operator=(const FollowedSources&) = delete;

  /// Brings all sources to time `now`, s; where that is not finite, to that of the last call. True
  /// when a surface moved or changed; then the layers are listed again.
  bool advance(double now, const FieldOptions& options) noexcept;
  /// Lists the layers that count for a field with these options.
  void list(const FieldOptions& options) noexcept;

  /// Reports where the tool can be next to the sources. hip and proxy are finite, m; `felt`: how
  /// far around itself the tool feels, m.
  void report(const Eigen::Vector3d& hip, const Eigen::Vector3d& proxy, double felt) noexcept;

  [[nodiscard]] const ActiveLayers& layers() const noexcept { return layers_; }
  /// Did the last advance() that changed anything go on with the snapshots that were shown before?
  [[nodiscard]] bool same() const noexcept { return same_; }
  /// How far surfaces may have stepped in the last advance(), m.
  [[nodiscard]] double step() const noexcept { return step_; }
  [[nodiscard]] int sources() const noexcept { return static_cast<int>(sources_.size()); }
  [[nodiscard]] const SourceView& view(std::size_t source) const noexcept {
    return sources_[source].view;
  }

  /// What the last advance() found.
  [[nodiscard]] SceneField::Found found() const noexcept;

  /// One source, confident of it, no materials, no motion: every surface is the same.
  [[nodiscard]] bool plain() const noexcept;
  /// What the points of a patch are like at x (m, world).
  [[nodiscard]] Surface surface(const ImplicitSurface& surface, const Patch& patch,
                                const Eigen::Vector3d& x) const noexcept;
  /// Does any source have points in the ball that are not prepared yet?
  [[nodiscard]] bool misses(const Ball& ball) const noexcept;

 private:
  struct FollowedSource {
    FollowedSource(Source::Inside& source, const SourceOptions::SoftMaterial& its_soft,
                   const std::string& name);

    SourceView view;
    ReachTable* board;
    SourceOptions::SoftMaterial soft;
    const Snapshot* shown = nullptr;  // of the view
  };

  [[nodiscard]] bool same_snapshots() noexcept;

  std::shared_ptr<std::atomic<int>> fields_;  // of the scene
  std::deque<FollowedSource> sources_;
  ToolReach reach_;
  ActiveLayers layers_;
  double now_ = 0;   // s
  double step_ = 0;  // m
  bool same_ = true;
};

}  // namespace palpate
