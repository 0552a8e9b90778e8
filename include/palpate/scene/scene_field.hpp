#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "palpate/field/field.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate {

/// What update() and the samples since then ran into, as bits.
enum class FieldNote : std::uint32_t {
  none = 0,
  thinned = 1u << 0,          ///< more points than the patch holds: every 2nd, 4th, ... was taken.
                              ///< Remedy: a smaller radius or a larger voxel
  no_surface = 1u << 1,       ///< no source has a surface now
  time_not_finite = 1u << 2,  ///< update() kept the time of the last one
  other_kernel = 1u << 3,     ///< points were prepared for another kernel than FieldOptions::kernel
  tool_too_large = 1u << 4,   ///< tool_radius is above 0.3 R here, or would bring a metaball's
                              ///< surface further than 0.85 R from its points, so it counts for
                              ///< less. Remedy: PrepareOptions::minimum_radius = tool_radius / 0.3
  work_spent = 1u << 5,       ///< a step had looked at kStepVisits; what it had not seen was solid
  behind = 1u << 6,      ///< the proxy is behind what a camera sees, on the side that no camera
                         ///< saw: that holds it from the front alone
  not_loaded = 1u << 7,  ///< the proxy is where a cloud has points that are not prepared yet: there
                         ///< is no surface so far (OnDemand)
};

[[nodiscard]] constexpr FieldNote operator|(FieldNote a, FieldNote b) noexcept {
  return static_cast<FieldNote>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr bool has(FieldNote notes, FieldNote bit) noexcept {
  return (static_cast<std::uint32_t>(notes) & static_cast<std::uint32_t>(bit)) != 0;
}

/// What follows a hand and is nowhere until it has begun: Proxy.
template <class T>
concept FollowsHand = requires(const T& follower) {
  { follower.has_begun() } -> std::same_as<bool>;
  { follower.position() } -> std::same_as<const Eigen::Vector3d&>;
};

/// The scene as one servo sees it: points near the tool, gathered into a contiguous patch, made
/// into an implicit surface. One thread uses it; up to 16 fields may look at one
/// scene.
class SceneField final : public Field {
 public:
  static constexpr std::size_t kPatchPoints = 2048;  ///< room of a patch
  /// The most cells and points of the index that update() looks at, and again a proxy's step.
  static constexpr int kStepVisits = 40960;

  /// What an update() found of each source, beside the time and what it was given.
  struct Found {
    std::array<std::uint64_t, Scene::kMaxSources> publications{};  ///< taken last; 0: none yet
    std::array<double, Scene::kMaxSources> least_radii{};          ///< of all supports, m
  };

  /// `name`: for reports of stalled fields. `scale`: metres that the tool goes for one of
  /// the hand (Workspace::scale), which bounds how fast it can be.
  /// @throws Error when an option is out of range or the scene has too many readers.
  explicit SceneField(Scene& scene, const FieldOptions& options = {},
                      const std::string& name = "a field", double scale = 1);
  ~SceneField() override;
  SceneField(const SceneField&) = delete;
  SceneField& operator=(const SceneField&) = delete;

  /// Picks up new snapshots, brings the surface to time `now` (s) and gathers the points around
  /// the proxy and its path to the hand (m, world). A proxy that has not begun is where the hand
  /// is. Reports to the sources where the tool can be next. Wait-free, allocation-free.
  template <FollowsHand Follower>
  void update(double now, const Eigen::Vector3d& hip, const Follower& proxy) noexcept {
    update_from(now, hip, proxy.has_begun() ? proxy.position() : hip);
  }
  /// The same where a surface is looked at without a proxy: from `place`, m, world.
  void update_from(double now, const Eigen::Vector3d& hip, const Eigen::Vector3d& place) noexcept;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override;
  [[nodiscard]] Surface surface(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] Traits traits() const noexcept override;

  /// Makes another surface of the same points from the next update() on. Real-time. `checked`:
  /// check() has passed it. How the force changes with it is for a Guard to soften.
  void change(const FieldOptions& checked) noexcept;

  void begin_step() const noexcept override;
  [[nodiscard]] int points_summed() const noexcept override;
  void end_step(const Eigen::Vector3d& proxy,
                const Eigen::Vector3d& normal) const noexcept override;

  [[nodiscard]] const FieldOptions& options() const noexcept { return options_; }

  /// What the last update() found. Real-time.
  [[nodiscard]] Found found() const noexcept;

  /// Notes since the last update() began.
  [[nodiscard]] FieldNote notes() const noexcept;
  /// Points in the patch around the proxy.
  [[nodiscard]] std::size_t patch_points() const noexcept;
  /// Patches gathered since construction.
  [[nodiscard]] std::uint64_t gathers() const noexcept;
  /// Cells and points of the index that were looked at since construction.
  [[nodiscard]] std::uint64_t visits() const noexcept;

 private:
  struct State;
  FieldOptions options_;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
