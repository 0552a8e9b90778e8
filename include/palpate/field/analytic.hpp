// Fields of exact shapes, for simulated scenes and tests.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "palpate/field/field.hpp"

namespace palpate {

/// A solid defined by its exact signed distance. The fields that the proxy is tested on to
/// machine precision; also good as a wall or a floor beside scanned clouds.
class AnalyticField : public Field {
 public:
  /// A distance to a shape and its gradient, in the shape's own frame.
  struct Distance {
    double value = 0;                                     ///< m; negative inside
    Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();  ///< unit; any one where several are true
  };

  /// Options that all analytic fields share.
  struct Options {
    Eigen::Isometry3d T_world_shape = Eigen::Isometry3d::Identity();  ///< pose of the shape's frame
    double step_length = 0.01;        ///< the value of Sample::radius everywhere, m
    double resolution = 2e-5;         ///< Field::Traits::resolution, m
    double tool_radius = 0;           ///< radius of the proxy's ball: pushes the surface out, m
    double reanchor_reach = 0;        ///< Field::Traits::reanchor_reach and step, m
    Surface surface = {.source = 0};  ///< the same everywhere
  };

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override;
  [[nodiscard]] Surface surface(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] Traits traits() const noexcept override;

  [[nodiscard]] const Options& options() const noexcept { return options_; }

  /// Moves the shape; the revision grows.
  void set_pose(const Eigen::Isometry3d& T_world_shape) noexcept;
  void set_surface(const Surface& surface) noexcept { options_.surface = surface; }

 protected:
  /// @throws Error when an option is not finite or out of its range.
  explicit AnalyticField(const Options& options);

 private:
  [[nodiscard]] virtual Distance distance(const Eigen::Vector3d& x) const noexcept = 0;

  Options options_;
  Eigen::Isometry3d T_shape_world_;
  std::uint64_t revision_ = 0;
};

/// The half-space z <= 0.
class PlaneField final : public AnalyticField {
 public:
  explicit PlaneField(const AnalyticField::Options& options = {});

 private:
  [[nodiscard]] Distance distance(const Eigen::Vector3d& x) const noexcept override;
};

/// A ball around the origin.
class SphereField final : public AnalyticField {
 public:
  /// @throws Error unless radius (m) > 0.
  explicit SphereField(double radius, const AnalyticField::Options& options = {});

 private:
  [[nodiscard]] Distance distance(const Eigen::Vector3d& x) const noexcept override;
  double radius_;
};

/// A box around the origin, its edges along the axes.
class BoxField final : public AnalyticField {
 public:
  /// @throws Error unless every edge length (m) > 0.
  explicit BoxField(const Eigen::Vector3d& size, const AnalyticField::Options& options = {});

 private:
  [[nodiscard]] Distance distance(const Eigen::Vector3d& x) const noexcept override;
  Eigen::Vector3d half_;
};

/// A torus around the z axis: a tube of radius `tube` around a circle of radius `ring`.
class TorusField final : public AnalyticField {
 public:
  /// @throws Error unless 0 < tube < ring (m).
  TorusField(double ring, double tube, const AnalyticField::Options& options = {});

 private:
  [[nodiscard]] Distance distance(const Eigen::Vector3d& x) const noexcept override;
  double ring_;
  double tube_;
};

/// Several fields at once: the smallest value counts, with sharp creases where they meet.
/// The parts are not owned and outlive the union.
class UnionField final : public Field {
 public:
  /// @throws Error when there is no part, or a part is null.
  explicit UnionField(std::vector<const Field*> parts);

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override;
  /// The surface of the nearest part; `source` is its index.
  [[nodiscard]] Surface surface(const Eigen::Vector3d& x) const noexcept override;
  /// The finest resolution, the longest reach, the sum of the revisions.
  [[nodiscard]] Traits traits() const noexcept override;
  void begin_step() const noexcept override;
  [[nodiscard]] int points_summed() const noexcept override;
  void end_step(const Eigen::Vector3d& proxy,
                const Eigen::Vector3d& normal) const noexcept override;

 private:
  [[nodiscard]] std::size_t nearest(const Eigen::Vector3d& x, Sample& sample) const noexcept;
  std::vector<const Field*> parts_;
};

}  // namespace palpate
