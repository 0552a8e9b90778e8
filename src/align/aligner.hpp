#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "palpate/align/align.hpp"

namespace palpate::detail {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Poses = std::vector<Eigen::Isometry3d>;

/// A point of a source, to be matched with other surfaces.
struct AlignSample {
  Eigen::Vector3d position;  // world, where it roughly is
  Eigen::Vector3d normal;
};

/// A sample of one source that lies over a point of another.
struct Match {
  std::size_t from, to, sample;
  Eigen::Vector3d position;  // world
  double height;             // over the other's plane, m
  Vector6d row;  // of the height by size times a turn of `from` about the middle, and by its shift
  Vector6d doubt;  // change of the row if the normal of `from` replaces the other's
};

/// Range of sources that move: those before `begin` stay fixed, those from `end` on wait.
struct Moving {
  std::size_t begin, end;
};

/// Normal equations of the sources that move.
struct Equations {
  Eigen::MatrixXd information, doubt, scatter;
  Eigen::VectorXd slope;
};

/// Samples all sources, and finds their poses.
class Aligner {
 public:
  explicit Aligner(const std::vector<RoughSource>& sources);

  /// Aligns `source` with those before it, from several starts, and keeps the best result.
  /// @throws Error when it shares too little with them.
  void place(Poses& poses, std::size_t source) const;
  /// Refines poses from coarse to fine: while `reach` (m) is large, so are the heights that count.
  void refine(Poses& poses, Moving moving, double reach, std::size_t stride = 1) const;
  /// Fills in the fits: residuals within `reach`, overlap within R.
  void fill_fits(const Poses& poses, double reach, AlignedSource::Fit AlignedSource::*fit,
                 std::vector<AlignedSource>& results) const;
  /// Fills in the deviations. @throws Error when a source is left free to slide or turn.
  void fill_deviations(const Poses& poses, std::vector<AlignedSource>& results) const;
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double radius() const { return radius_; }

 private:
  void match(const Poses& poses, std::size_t from, std::size_t to, double reach, std::size_t stride,
             std::vector<Match>& found) const;
  std::vector<Match> matches(const Poses& poses, Moving moving, double reach,
                             std::size_t stride = 1) const;
  Equations equations(const std::vector<Match>& matches, Moving moving, double limit) const;
  double step(Poses& poses, Moving moving, double reach, std::size_t stride) const;
  void check_held(const Equations& e) const;

  const std::vector<RoughSource>& sources_;
  std::vector<std::vector<AlignSample>> samples_;
  std::vector<Eigen::Vector3d> middles_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double size_ = 0;    // rms distance from there, m
  double radius_ = 0;  // R, m
};

/// Median of the matches' absolute heights, m.
[[nodiscard]] double middle_height(const std::vector<Match>& matches);

}  // namespace palpate::detail
