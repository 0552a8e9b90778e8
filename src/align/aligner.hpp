#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "palpate/align/align.hpp"

namespace palpate::detail {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Poses = std::vector<Eigen::Isometry3d>;

/// A point that is looked for on other surfaces.
struct AlignSample {
  Eigen::Vector3d place;  // world, where it roughly is
  Eigen::Vector3d normal;
};

/// A sample of one source that lies over a point of another.
struct Match {
  std::size_t from, to, sample;
  Eigen::Vector3d place;  // world
  double height;          // over the other's plane, m
  Vector6d row;  // of the height by a turn about the middle (times its size) and a shift of `from`
  Vector6d doubt;  // what the row changes by with the normal of `from` in the other's stead
};

/// Range of sources that move: those before `begin` stay fixed, those from `end` on wait.
struct Moving {
  std::size_t begin, end;
};

/// Normal equations of what moves.
struct Equations {
  Eigen::MatrixXd information, doubt, scatter;
  Eigen::VectorXd slope;
};

/// Samples of all sources, and what they tell of poses.
class Aligner {
 public:
  explicit Aligner(const std::vector<RoughSource>& sources);

  /// Beside those before it: the best of what comes of several turns.
  /// @throws Error when that shares too little.
  void place(Poses& poses, std::size_t source) const;
  /// From coarse to fine: where `reach` (m) is large, so are heights that count.
  void refine(Poses& poses, Moving moving, double reach, std::size_t stride = 1) const;
  /// Residuals within `reach`, overlap within R.
  void tell_fits(const Poses& poses, double reach, AlignedSource::Fit AlignedSource::*fit,
                 std::vector<AlignedSource>& results) const;
  /// @throws Error when something is left free to slide or turn.
  void tell_deviations(const Poses& poses, std::vector<AlignedSource>& results) const;
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double radius() const { return radius_; }

 private:
  void match(const Poses& poses, std::size_t from, std::size_t to, double reach, std::size_t stride,
             std::vector<Match>& found) const;
  std::vector<Match> matches(const Poses& poses, Moving moving, double reach,
                             std::size_t stride = 1) const;
  Equations equations(const std::vector<Match>& matches, Moving moving, double limit) const;
  double step(Poses& poses, Moving moving, double reach, std::size_t stride) const;
  double score(const Poses& poses, Moving moving) const;
  void check_held(const Equations& e) const;

  const std::vector<RoughSource>& sources_;
  std::vector<std::vector<AlignSample>> samples_;
  std::vector<Eigen::Vector3d> middles_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double size_ = 0;    // rms distance from there, m
  double radius_ = 0;  // R, m
};

/// Median of what matches are off by, m.
[[nodiscard]] double middle_height(const std::vector<Match>& matches);

}  // namespace palpate::detail
