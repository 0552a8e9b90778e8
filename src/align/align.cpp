// Aligns sources and checks whether their overlap determines the poses.
#include "palpate/align/align.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "align/aligner.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

void Aligner::fill_fits(const Poses& poses, double reach, AlignedSource::Fit AlignedSource::*fit,
                        std::vector<AlignedSource>& results) const {
  const Moving all{0, sources_.size()};
  std::vector<std::vector<Match>> of(sources_.size());
  for (const Match& m : matches(poses, all, reach)) of[m.from].push_back(m);
  std::vector<std::vector<bool>> lies(sources_.size());
  for (std::size_t s = 0; s < sources_.size(); ++s) lies[s].resize(samples_[s].size());
  for (const Match& m : matches(poses, all, radius_)) lies[m.from][m.sample] = true;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const auto count = static_cast<double>(std::ranges::count(lies[s], true));
    results[s].*fit = {middle_height(of[s]), count / static_cast<double>(lies[s].size())};
  }
}

// Requires more information along each direction than errors of the normals alone produce: a
// plane with scattered normals seems to hold along itself, too.
void Aligner::check_held(const Equations& e) const {
  constexpr double kHeld = 2;  // times the information that scattered normals produce (judgement)
  const Index size = e.information.rows();
  const MatrixXd rounding = 1e-9 * e.information.trace() * MatrixXd::Identity(size, size);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> held(e.information, e.doubt + rounding);
  if (held.eigenvalues()(0) >= kHeld) return;
  const VectorXd loose = held.eigenvectors().col(0);
  std::size_t worst = 1;
  const auto part = [&](std::size_t s) -> Vector6d {
    return loose.segment<6>(6 * static_cast<Index>(s - 1));
  };
  for (std::size_t s = 2; s < sources_.size(); ++s) {
    if (part(s).norm() > part(worst).norm()) worst = s;
  }
  const bool turns = part(worst).head<3>().norm() > part(worst).tail<3>().norm();
  const Vector3d axis = (turns ? part(worst).head<3>() : part(worst).tail<3>()).normalized();
  throw Error(fmt::format(
      "the overlap of '{}' with the others leaves it free to {} ({:.2f}, {:.2f}, {:.2f}); add "
      "surfaces that face other directions, e.g. a box",
      sources_[worst].name, turns ? "turn about" : "slide along", axis.x(), axis.y(), axis.z()));
}

void Aligner::fill_deviations(const Poses& poses, std::vector<AlignedSource>& results) const {
  const Moving moving{1, sources_.size()};
  const std::vector<Match> found = matches(poses, moving, radius_);
  const Equations e = equations(found, moving, 0);
  check_held(e);
  const MatrixXd inverse = (e.information - e.doubt).inverse();
  const MatrixXd covariance = inverse * e.scatter * inverse;
  const auto largest = [](const Eigen::Matrix3d& m) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues()(2));
  };
  for (std::size_t s = 1; s < sources_.size(); ++s) {
    Vector3d shared = Vector3d::Zero();
    double count = 0;
    for (const Match& m : found) {
      if (m.from != s && m.to != s) continue;
      shared += m.position;
      ++count;
    }
    const Vector3d arm = (shared / count - middle_) / size_;
    Eigen::Matrix<double, 3, 6> shift = Eigen::Matrix<double, 3, 6>::Zero();
    for (int axis = 0; axis < 3; ++axis) shift.col(axis) = Vector3d::Unit(axis).cross(arm);
    shift.rightCols<3>().setIdentity();
    const Index own = 6 * static_cast<Index>(s - 1);
    const Matrix6d c = covariance.block<6, 6>(own, own);
    results[s].position_deviation = largest(shift * c * shift.transpose());
    results[s].turn_deviation = largest(c.topLeftCorner<3, 3>()) / size_;
  }
}

}  // namespace detail

std::vector<AlignedSource> align(const std::vector<RoughSource>& sources) {
  if (sources.size() < 2) {
    throw Error(fmt::format("align needs at least two sources, got {}", sources.size()));
  }
  const detail::Aligner aligner(sources);
  detail::Poses poses(sources.size(), Eigen::Isometry3d::Identity());
  std::vector<AlignedSource> results(sources.size());
  aligner.fill_fits(poses, aligner.size(), &AlignedSource::before, results);
  for (std::size_t s = 1; s < sources.size(); ++s) aligner.place(poses, s);
  aligner.refine(poses, {1, sources.size()}, aligner.radius());
  aligner.fill_deviations(poses, results);
  aligner.fill_fits(poses, aligner.radius(), &AlignedSource::after, results);
  for (std::size_t s = 0; s < sources.size(); ++s) results[s].T_aligned_rough = poses[s];
  return results;
}

}  // namespace palpate
