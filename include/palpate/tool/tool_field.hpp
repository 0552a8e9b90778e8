// A scene's surface as a whole tool meets it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/tool/tool.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "palpate/tool/tool_surface.hpp"

namespace palpate {

/// The scene as one servo sees it that holds a tool: near each group of the tool's samples, points
/// are gathered into a patch of their own, once a sample looks at them. All groups see the same
/// snapshots, and each decides by itself from which side it sees a surface that has two: fingers
/// can pinch a sheet. One thread uses it; up to 16 fields may look at one scene.
///
/// What a step looks at in the index is bounded for all groups together (kStepVisits); what is not
/// seen by then is solid, and holds the tool for that step. Sides are decided again for each group
/// that has moved, and each sample is a sum, so that a step takes longer with more of them
/// (docs/method.md 3.7).
class ToolField final : public ToolSurface {
 public:
  static constexpr std::size_t kGroupPoints = 768;  ///< room of a group's patch
  /// The most cells and points of the index that a step looks at.
  static constexpr int kStepVisits = 4 * SceneField::kStepVisits;

  /// `name`: for reports of stalled fields. `scale`: metres that the tool goes for one of the hand.
  /// @throws Error without a tool, when an option is out of range or is for a point alone
  /// (tool_radius, nearest_radius), and when the scene has too many readers.
  ToolField(Scene& scene, std::shared_ptr<const Tool> tool, const FieldOptions& options = {},
            const std::string& name = "a tool", double scale = 1);
  ~ToolField() override;
  ToolField(const ToolField&) = delete;
  ToolField& operator=(const ToolField&) = delete;

  /// Before each step: picks up new snapshots and brings the surface to time `now` (s). `proxy` is
  /// where the tool is, `hand` where the hand wants it; a proxy that has not begun is where the
  /// hand is. Reports to the sources where the tool can be next. Wait-free, allocation-free.
  void update(double now, const Pose& hand, const ToolProxy& proxy) noexcept;

  /// Makes another surface of the same points from the next update() on. Real-time. `checked`:
  /// check() has passed it.
  void change(const FieldOptions& checked) noexcept;
  /// @throws Error when an option is out of range or is for a point alone.
  static void check(const FieldOptions& options);

  [[nodiscard]] const Field& whole() const noexcept override;
  [[nodiscard]] int group_of(int sample) const noexcept override;
  [[nodiscard]] const Field& group(int number) const noexcept override;
  [[nodiscard]] double pushed_out() const noexcept override;
  void place(const Pose& tool) const noexcept override;
  void forget_sides() const noexcept override;
  [[nodiscard]] bool is_across(double deeper) const noexcept override;
  [[nodiscard]] double moved() const noexcept override;
  [[nodiscard]] bool serves(const Tool& tool) const noexcept override;

  /// What the last update() found. Real-time.
  [[nodiscard]] SceneField::Found found() const noexcept;

  /// Notes since the last update() began; tool_too_large is never among them.
  [[nodiscard]] FieldNote notes() const noexcept;
  /// Groups of samples, by the support radius of what was touched last.
  [[nodiscard]] int groups() const noexcept;
  /// Patches gathered since construction.
  [[nodiscard]] std::uint64_t gathers() const noexcept;
  /// Cells and points of the index that were looked at since construction.
  [[nodiscard]] std::uint64_t visits() const noexcept;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
