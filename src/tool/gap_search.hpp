// Which samples of a tool are near the surface, and what keeps them out of it.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/tool/tool.hpp"
#include "palpate/tool/tool_surface.hpp"
#include "tool/constraint_list.hpp"

namespace palpate {

/// What one look at the surface found.
struct Look {
  double margin = 0;     ///< m: all samples with a smaller gap have a constraint
  double clearance = 0;  ///< m that the tool can move before anything has to be looked at again
  double deepest = 0;    ///< least gap, m; 0: none is below it
  bool unknown = false;  ///< a sample is in what is solid and says nothing of where it ends
};

/// Looks for the samples near a surface. Gaps are bounds for later: on an odometer that counts how
/// far any sample has moved at most, a sample far from the surface is not looked at before it can
/// have come near, nor is a whole branch of the tree.
class GapSearch {
 public:
  explicit GapSearch(std::shared_ptr<const Tool> tool);

  /// Forgets all gaps: the surface has changed, or the tool was put elsewhere.
  void forget() noexcept;
  /// Begins a step of the tool on a surface, into which a relief is carved. After a kilometre all
  /// gaps are forgotten.
  void begin(const ToolSurface& surface, const Texture& texture, const Pose& pose) noexcept;
  /// No sample has moved farther than this, m.
  void move(double farthest) noexcept { odometer_ += farthest; }

  /// Adds a constraint for every sample whose gap is below `margin` (m). Where there are more than
  /// the list holds, the margin becomes smaller.
  [[nodiscard]] Look look(const ToolSurface& surface, const Pose& pose, const Metric& metric,
                          double margin, ConstraintList& constraints) noexcept;

  /// The gap of one sample at x (m, world); 1 in the free, -1 in the solid where nothing is known.
  [[nodiscard]] double gap(const Field& field, const Tool::Point& sample,
                           const Eigen::Vector3d& x) noexcept;
  /// Does a sample at x (m, world) still see the surface whose normal was this, so near that looks
  /// lead it out?
  [[nodiscard]] bool sees_still(const Field& field, const Tool::Point& sample,
                                const Eigen::Vector3d& x, const Eigen::Vector3d& normal) noexcept;
  /// The share of `path` (m) after which a sample at x (m, world) is free; it was solid a little
  /// before. 0: no such place. Takes kMostRises evaluations at most.
  [[nodiscard]] double rise(const Field& field, const Tool::Point& sample, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& path) noexcept;
  static constexpr int kMostRises = 64 + 1 + 12;  ///< steps, their end, and halvings of one

  [[nodiscard]] bool is_free(const Field& field, const Ball& ball) noexcept;
  /// Is the tool in free air at a pose? Only balls are tested: false, too, where that is not
  /// certain.
  [[nodiscard]] bool is_free_at(const Field& field, const Pose& pose) noexcept;

  /// A sample that is near the surface.
  struct Nearest {
    double gap = 0;                                      ///< m
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, world
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< zero: no sample was looked at
  };
  /// The nearest one of each group in the last look of this step.
  [[nodiscard]] std::span<const Nearest, ToolSurface::kMostGroups> nearest() const noexcept {
    return nearest_;
  }
  /// R where it was last sampled, m.
  [[nodiscard]] double radius() const noexcept { return radius_; }
  [[nodiscard]] int evaluations() const noexcept { return evaluations_; }

 private:
  // What a look goes through its tree with.
  struct Walk {
    const ToolSurface& surface;
    const Pose& pose;
    const Metric& metric;
    ConstraintList& constraints;
    Look found;
  };

  [[nodiscard]] bool is_free_below(const Field& field, const Pose& pose,
                                   std::int32_t index) noexcept;
  [[nodiscard]] const Field& field_of(const ToolSurface& surface,
                                      const Tool::Node& node) const noexcept;
  void visit(Walk& walk, std::int32_t index) noexcept;
  [[nodiscard]] bool passes(Walk& walk, std::int32_t index) noexcept;
  void look_at(Walk& walk, std::uint32_t index) noexcept;
  void meet(Walk& walk, std::uint32_t index, int group, const Nearest& found) noexcept;
  void constrain(Walk& walk, Constraint constraint, double gap) const noexcept;

  std::shared_ptr<const Tool> tool_;
  std::vector<double> sample_bounds_;  // on the odometer, m
  std::vector<double> node_bounds_;
  std::vector<double> node_asked_;  // up to where a ball that was not free is not asked again
  double odometer_ = 0;             // m
  double radius_ = 0;
  bool radius_known_ = false;  // said by the surface
  // ToolSurface::pushed_out(). A ball is held where the value is what it stands out by beyond that:
  // the first-order distance has another gradient where the normal turns.
  double pushed_out_ = 0;
  Texture texture_;
  int evaluations_ = 0;
  std::array<Nearest, ToolSurface::kMostGroups> nearest_;
};

}  // namespace palpate
