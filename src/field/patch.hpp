// A patch: the points around the tool, gathered once and summed many times.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "field/eyes.hpp"
#include "field/facing.hpp"
#include "field/point_columns.hpp"
#include "field/selection.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// The points around a position, copied into columns relative to it: what the sums run over.
///
/// It holds every point whose support reaches into the ball (center, extra), so a sample anywhere
/// in that ball is exact, and stays so while the points move: advance() follows them. All memory is
/// taken by the constructor. When more points are near than it holds, every 2nd, 4th, ... of the
/// index's order is taken and weighs as much more.
class Patch {
 public:
  explicit Patch(std::size_t capacity);

  /// `layers` in the order of their sources. False when it has looked at `most_visits` cells and
  /// points and did not come to the end; then it covers nothing.
  bool gather(std::span<const ActiveLayer> layers, int sources, const Eigen::Vector3d& center,
              double extra, const GatherOptions& options = {}) noexcept;

  /// Moves what was gathered to where it is now. `layers`: the same as then; where their points
  /// change, their progress between what it was then and the `until` of then. False when they are
  /// others; then the patch covers nothing. Layers are compared by address: call clear() before
  /// others can come to the same one.
  bool advance(std::span<const ActiveLayer> layers) noexcept;

  /// Turns points to the tool where it is now and sorts them by how their segments meet.
  void face(const Stance& stance) noexcept;
  /// What is decided of the segments; holds from the next face() on.
  [[nodiscard]] Facing& sides() noexcept { return facing_; }
  [[nodiscard]] const Facing& sides() const noexcept { return facing_; }

  /// Gathers again at the same position after advance() was refused, and looks for points in those
  /// layers alone that are others. False as by gather().
  bool renew(std::span<const ActiveLayer> layers, int sources, int most_visits,
             const Stance* stance = nullptr) noexcept;

  /// Covers nothing until the next gather.
  void clear() noexcept {
    points_.ball.radius = -1;
    outdated_ = false;  // there is nothing to renew
  }

  [[nodiscard]] bool covers(const Ball& ball) const noexcept { return !outdated_ && reaches(ball); }
  /// Would it cover the ball, once renewed?
  [[nodiscard]] bool reaches(const Ball& ball) const noexcept {
    const double slack = extra() - ball.radius;
    return slack >= 0 && (ball.center - center()).squaredNorm() <= slack * slack;
  }
  /// Has advance() been refused since it was gathered?
  [[nodiscard]] bool outdated() const noexcept { return outdated_; }
  [[nodiscard]] const Eigen::Vector3d& center() const noexcept { return points_.ball.center; }
  /// How far from its centre positions are covered, m; below 0: none is.
  [[nodiscard]] double extra() const noexcept { return points_.ball.radius; }
  [[nodiscard]] std::size_t points() const noexcept { return points_.signs.size(); }
  /// What was chosen: 1 of how many points (stride()), and the work of that (visits()).
  [[nodiscard]] const Selection& selection() const noexcept { return points_.selection; }
  [[nodiscard]] bool thinned() const noexcept { return selection().stride() > 1; }
  [[nodiscard]] const Eyes& eyes() const noexcept { return eyes_; }
  [[nodiscard]] const PatchColumns& columns() const noexcept { return columns_.columns(); }

 private:
  void copy(std::span<const ActiveLayer> layers, int sources, bool whole) noexcept;
  bool turn(const Stance& stance) noexcept;

  GatheredPoints points_;
  PointColumns columns_;
  Eyes eyes_;
  Facing facing_;
  bool outdated_ = false;
};

}  // namespace palpate
