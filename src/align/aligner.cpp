// Samples surfaces, matches them, and solves for the poses of sources.
#include "align/aligner.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "field/formulas.hpp"
#include "geometry/parallel.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate::detail {

using Eigen::Index;
using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

namespace {

constexpr std::size_t kSamples = 2000;  // of each source, up to twice as many (judgement)
constexpr std::size_t kStride = 8;   // one sample in so many is tried from all starts (judgement)
constexpr std::size_t kEnough = 30;  // samples or matches (judgement)
constexpr float kTrusted = 0.5f;     // confidence of a normal (judgement)
// Least cosine between normals of one surface: 45 degrees (docs/method.md 9)
constexpr double kAlike = 0.7071;
constexpr double kTukey = 4.685;  // sigmas: 95 % efficiency on Gaussian noise (docs/method.md 9)
// Sigma over the median of absolute values, on Gaussian noise: 1 / Phi^-1(3/4) (derived)
constexpr double kGaussian = 1.4826;
constexpr double kTurn = 10 * std::numbers::pi / 180;  // rad between starts (docs/method.md 9)
constexpr double kShrink = 0.7;  // of the reach, from step to step (judgement)

bool counts(const SurfacePoints& p, std::size_t i) {
  return newest(p.density_weights, p.end_density_weights)[i] > 0 &&
         newest(p.confidences, p.end_confidences)[i] >= kTrusted;
}

double weight(double height, double limit) {
  const double u = height / limit;
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

// Heights beyond `limit` do not count.
double score(const std::vector<Match>& matches, double limit) {
  double sum = 0;
  for (const Match& m : matches) sum += weight(m.height, limit);
  return sum;
}

Isometry3d turned(const Vector3d& turn, const Vector3d& about) {
  Isometry3d result = Isometry3d::Identity();
  if (turn.norm() > 0) {
    result.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  result.translation() = about - result.linear() * about;
  return result;
}

// Turns of the starts: none, and about the axes of a cube's faces and corners.
std::vector<Vector3d> turns() {
  std::vector<Vector3d> all = {Vector3d::Zero()};
  for (int i = 0; i < 27; ++i) {
    const Vector3d axis(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (axis.squaredNorm() == 1 || axis.squaredNorm() == 3) {
      all.push_back(kTurn * axis.normalized());
    }
  }
  return all;
}

}  // namespace

double middle_height(const std::vector<Match>& matches) {
  std::vector<float> heights;
  for (const Match& m : matches) heights.push_back(static_cast<float>(std::abs(m.height)));
  return median(heights);
}

Aligner::Aligner(const std::vector<RoughSource>& sources)
    : sources_(sources), samples_(sources.size()), middles_(sources.size(), Vector3d::Zero()) {
  double count = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const SurfacePoints& points = *sources[s].points;
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kSamples);
    for (std::size_t i = 0; i < points.size() && !points.normals.empty(); i += stride) {
      if (!counts(points, i)) continue;
      const Vector3d position = points.origin + points.grid.points()[i].cast<double>();
      samples_[s].push_back({position, points.normals[i].cast<double>()});
      middles_[s] += position;
      size_ += position.squaredNorm();
    }
    if (samples_[s].size() < kEnough) {
      throw Error(fmt::format("'{}' has {} points with a reliable normal; align needs at least {}",
                              sources[s].name, samples_[s].size(), kEnough));
    }
    middle_ += middles_[s];
    count += static_cast<double>(samples_[s].size());
    middles_[s] /= static_cast<double>(samples_[s].size());
    radius_ = std::max(radius_, points.radius);
  }
  middle_ /= count;
  size_ = std::sqrt(std::max(size_ / count - middle_.squaredNorm(), radius_ * radius_));
}

// The nearest point of a surface lies straight below a sample, except at the surface's rim: a
// sample more than R beside it lies over no surface.
void Aligner::match(const Poses& poses, std::size_t from, std::size_t to, double reach,
                    std::size_t stride, std::vector<Match>& found) const {
  const SurfacePoints& other = *sources_[to].points;
  const auto faces = [](const SurfacePoints& points) {
    return points.one_sided() && points.segments.empty();
  };
  const bool same_side = faces(*sources_[from].points) && faces(other);
  const Isometry3d into = poses[to].inverse() * poses[from];
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = 0; i < samples_[from].size(); i += stride) {
    const AlignSample& sample = samples_[from][i];
    const Vector3d position = into * sample.position - other.origin;
    other.grid.nearest(position.cast<float>(), 1, near);
    const std::size_t k = near.front().index;
    if (!counts(other, k)) continue;
    const Vector3d normal = other.normals[k].cast<double>();
    Vector3d own = into.linear() * sample.normal;
    if (!same_side && normal.dot(own) < 0) own = -own;
    const Vector3d offset = position - other.grid.points()[k].cast<double>();
    const double height = normal.dot(offset);
    const double beside = (offset - height * normal).norm();
    if (!(normal.dot(own) > kAlike) || std::abs(height) > reach ||
        beside > static_cast<double>(other.radii[k])) {
      continue;
    }
    Match m{from, to, i, poses[from] * sample.position, height, {}, {}};
    const Vector3d arm = (m.position - middle_) / size_;
    const Vector3d n = poses[to].linear() * normal;
    const Vector3d d = n - poses[to].linear() * own;
    m.row << arm.cross(n), n;
    m.doubt << arm.cross(d), d;
    found.push_back(m);
  }
}

std::vector<Match> Aligner::matches(const Poses& poses, Moving moving, double reach,
                                    std::size_t stride) const {
  std::vector<Match> found;
  for (std::size_t from = 0; from < moving.end; ++from) {
    for (std::size_t to = 0; to < moving.end; ++to) {
      if (from == to || std::max(from, to) < moving.begin) continue;
      match(poses, from, to, reach, stride, found);
    }
  }
  return found;
}

// Heights beyond `limit` do not count, or beyond what the measured noise makes if that is more.
Equations Aligner::equations(const std::vector<Match>& matches, Moving moving, double limit) const {
  const Index size = 6 * static_cast<Index>(moving.end);
  const MatrixXd zero = MatrixXd::Zero(size, size);
  Equations e{zero, zero, zero, VectorXd::Zero(size)};
  limit = std::max({limit, kTukey * kGaussian * middle_height(matches), 1e-9 * size_});
  // Residuals within one part of the scene err together; a part is a quarter of its size.
  std::map<std::array<int, 3>, VectorXd> parts;
  for (const Match& m : matches) {
    const double w = weight(m.height, limit);
    const Index a = 6 * static_cast<Index>(m.from);
    const Index b = 6 * static_cast<Index>(m.to);
    const auto add = [&](MatrixXd& matrix, const Vector6d& row, double factor) {
      const Matrix6d square = factor * row * row.transpose();
      matrix.block<6, 6>(a, a) += square;
      matrix.block<6, 6>(b, b) += square;
      matrix.block<6, 6>(a, b) -= square;
      matrix.block<6, 6>(b, a) -= square;
    };
    add(e.information, m.row, w);
    add(e.doubt, m.doubt, w / 2);
    const Vector3d cell = (4 * (m.position - middle_) / size_).array().floor();
    VectorXd& part =
        parts.try_emplace({int(cell.x()), int(cell.y()), int(cell.z())}, zero.col(0)).first->second;
    part.segment<6>(a) += w * m.height * m.row;
    part.segment<6>(b) -= w * m.height * m.row;
  }
  for (const auto& [cell, part] : parts) {
    e.slope += part;
    e.scatter += part * part.transpose();
  }
  const Index kept = 6 * static_cast<Index>(moving.end - moving.begin);
  const auto last = [&](const MatrixXd& m) -> MatrixXd { return m.bottomRightCorner(kept, kept); };
  return {last(e.information), last(e.doubt), last(e.scatter), e.slope.tail(kept)};
}

// Makes one step of the fit; returns how far the sources moved, m.
double Aligner::step(Poses& poses, Moving moving, double reach, std::size_t stride) const {
  const Equations e =
      equations(matches(poses, moving, reach, stride), moving, reach > radius_ ? reach : 0);
  const VectorXd x = -e.information.ldlt().solve(e.slope);
  if (!x.allFinite()) return 0;
  for (std::size_t s = moving.begin; s < moving.end; ++s) {
    const Vector6d own = x.segment<6>(6 * static_cast<Index>(s - moving.begin));
    poses[s] =
        Eigen::Translation3d(own.tail<3>()) * turned(own.head<3>() / size_, middle_) * poses[s];
  }
  return x.norm();
}

void Aligner::refine(Poses& poses, Moving moving, double reach, std::size_t stride) const {
  constexpr int kFine = 20;  // steps at R (judgement)
  for (int fine = 0; fine < kFine; fine += reach <= radius_ ? 1 : 0) {
    const double moved = step(poses, moving, reach, stride);
    if (reach <= radius_ && moved < 1e-3 * radius_) break;
    reach = std::max(radius_, kShrink * reach);
  }
}

void Aligner::place(Poses& poses, std::size_t source) const {
  const std::vector<Vector3d> around = turns();
  std::vector<Poses> found(around.size(), poses);
  std::vector<std::vector<Match>> lie(found.size());
  const Moving moving{source, source + 1};
  parallel_each(found.size(), 1, [&](std::size_t i) {
    found[i][source] = turned(around[i], middles_[source]);
    refine(found[i], moving, size_, kStride);
    lie[i] = matches(found[i], moving, radius_);
  });
  // The measured noise is that of the best fit: R is wider where the noise has long waves.
  double noise = radius_;
  for (const auto& m : lie) {
    if (m.size() >= kEnough) noise = std::min(noise, kTukey * kGaussian * middle_height(m));
  }
  std::vector<double> scores;
  for (const auto& m : lie) scores.push_back(score(m, std::max(noise, 1e-9 * size_)));
  poses = found[static_cast<std::size_t>(std::ranges::max_element(scores) - scores.begin())];
  refine(poses, moving, radius_);
  const std::size_t shared = matches(poses, moving, radius_).size();
  if (shared >= kEnough) return;
  throw Error(
      fmt::format("'{}' does not overlap the sources before it ({} common points); correct its "
                  "rough pose, or make their views overlap",
                  sources_[source].name, shared));
}

}  // namespace palpate::detail
