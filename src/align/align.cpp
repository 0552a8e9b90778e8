#include "palpate/align/align.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "geometry/parallel.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Poses = std::vector<Isometry3d>;

constexpr std::size_t kSamples = 2000;  // of each source, up to twice as many
constexpr std::size_t kStride = 8;      // samples are tried from all starts, one in so many
constexpr std::size_t kEnough = 30;     // samples or matches
constexpr float kTrusted = 0.5f;        // confidence of a normal
constexpr double kAlike = 0.7071;       // cosine between normals of one surface
constexpr double kTukey = 4.685;        // sigmas: 95 % as sharp as least squares on Gaussian noise
constexpr double kGaussian = 1.4826;    // sigma over the median of absolute values
constexpr double kTurn = 10 * std::numbers::pi / 180;  // that starts are apart
constexpr double kShrink = 0.7;                        // reach, from step to step

struct Sample {
  Vector3d place;  // world, where it roughly is
  Vector3d normal;
};

// A sample of one source that lies over a point of another.
struct Match {
  std::size_t from, to, sample;
  Vector3d place;  // world
  double height;   // over the other's plane, m
  Vector6d row;  // of the height by a turn about the middle (times its size) and a shift of `from`
  Vector6d doubt;  // what the row changes by with the normal of `from` in the other's stead
};

// Of sources in their order: those before `begin` stay, those before `end` move, others wait.
struct Moving {
  std::size_t begin, end;
};

// Normal equations of what moves.
struct Equations {
  MatrixXd information, doubt, scatter;
  VectorXd slope;
};

template <class Column>
const Column& newest(const Column& start, const Column& end) {
  return end.empty() ? start : end;
}

bool counts(const SurfacePoints& p, std::size_t i) {
  return newest(p.density_weights, p.end_density_weights)[i] > 0 &&
         newest(p.confidences, p.end_confidences)[i] >= kTrusted;
}

double weight(double height, double limit) {
  const double u = height / limit;
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

double middle_height(const std::vector<Match>& matches) {
  std::vector<float> heights;
  for (const Match& m : matches) heights.push_back(static_cast<float>(std::abs(m.height)));
  return median(heights);
}

Isometry3d turned(const Vector3d& turn, const Vector3d& about) {
  Isometry3d result = Isometry3d::Identity();
  if (turn.norm() > 0) {
    result.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  result.translation() = about - result.linear() * about;
  return result;
}

// Not at all, about the axes of a cube's faces, and of its corners.
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

class Aligner {
 public:
  explicit Aligner(const std::vector<RoughSource>& sources);

  void place(Poses& poses, std::size_t source) const;
  void refine(Poses& poses, Moving moving, double reach, std::size_t stride = 1) const;
  void tell_fits(const Poses& poses, double reach, Fit AlignedSource::*fit,
                 std::vector<AlignedSource>& results) const;
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
  std::vector<std::vector<Sample>> samples_;
  std::vector<Vector3d> middles_;
  Vector3d middle_ = Vector3d::Zero();
  double size_ = 0;    // rms distance from there, m
  double radius_ = 0;  // R, m
};

Aligner::Aligner(const std::vector<RoughSource>& sources)
    : sources_(sources), samples_(sources.size()), middles_(sources.size(), Vector3d::Zero()) {
  double count = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const SurfacePoints& points = *sources[s].points;
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kSamples);
    for (std::size_t i = 0; i < points.size() && !points.normals.empty(); i += stride) {
      if (!counts(points, i)) continue;
      const Vector3d place = points.origin + points.grid.points()[i].cast<double>();
      samples_[s].push_back({place, points.normals[i].cast<double>()});
      middles_[s] += place;
      size_ += place.squaredNorm();
    }
    if (samples_[s].size() < kEnough) {
      throw Error(
          fmt::format("'{}' has {} points with a normal that can be trusted; aligning takes "
                      "{} at least",
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

// The nearest place of a surface is straight below a point, except at the surface's rim: what is
// beside its foot by more than R is over no surface.
void Aligner::match(const Poses& poses, std::size_t from, std::size_t to, double reach,
                    std::size_t stride, std::vector<Match>& found) const {
  const SurfacePoints& other = *sources_[to].points;
  const bool same_side = sources_[from].points->one_sided && other.one_sided;
  const Isometry3d into = poses[to].inverse() * poses[from];
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = 0; i < samples_[from].size(); i += stride) {
    const Sample& sample = samples_[from][i];
    const Vector3d place = into * sample.place - other.origin;
    other.grid.nearest(place.cast<float>(), 1, near);
    const std::size_t k = near.front().index;
    if (!counts(other, k)) continue;
    const Vector3d normal = other.normals[k].cast<double>();
    Vector3d own = into.linear() * sample.normal;
    if (!same_side && normal.dot(own) < 0) own = -own;
    const Vector3d way = place - other.grid.points()[k].cast<double>();
    const double height = normal.dot(way);
    const double beside = (way - height * normal).norm();
    if (!(normal.dot(own) > kAlike) || std::abs(height) > reach ||
        beside > static_cast<double>(other.radii[k])) {
      continue;
    }
    Match m{from, to, i, poses[from] * sample.place, height, {}, {}};
    const Vector3d arm = (m.place - middle_) / size_;
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

// Heights beyond `limit` count nothing, nor those far out of the noise that is measured.
Equations Aligner::equations(const std::vector<Match>& matches, Moving moving, double limit) const {
  const Index size = 6 * static_cast<Index>(moving.end);
  const MatrixXd zero = MatrixXd::Zero(size, size);
  Equations e{zero, zero, zero, VectorXd::Zero(size)};
  limit = std::max({limit, kTukey * kGaussian * middle_height(matches), 1e-9 * size_});
  // What is left over in one part of the scene errs together: four parts to its size.
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
    const Vector3d cell = (4 * (m.place - middle_) / size_).array().floor();
    VectorXd& part =
        parts.try_emplace({int(cell.x()), int(cell.y()), int(cell.z())}, VectorXd::Zero(size))
            .first->second;
    part.segment<6>(a) += w * m.height * m.row;
    part.segment<6>(b) -= w * m.height * m.row;
  }
  for (const auto& [cell, part] : parts) {
    e.slope += part;
    e.scatter += part * part.transpose();
  }
  const Index kept = 6 * static_cast<Index>(moving.end - moving.begin);
  for (MatrixXd* m : {&e.information, &e.doubt, &e.scatter}) {
    *m = m->bottomRightCorner(kept, kept).eval();
  }
  e.slope = e.slope.tail(kept).eval();
  return e;
}

// How far it moved, m.
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

// From coarse to fine: where `reach` is large, so are heights that count.
void Aligner::refine(Poses& poses, Moving moving, double reach, std::size_t stride) const {
  constexpr int kFine = 20;  // steps, at R
  for (int fine = 0; fine < kFine; fine += reach <= radius_ ? 1 : 0) {
    const double moved = step(poses, moving, reach, stride);
    if (reach <= radius_ && moved < 1e-3 * radius_) break;
    reach = std::max(radius_, kShrink * reach);
  }
}

double Aligner::score(const Poses& poses, Moving moving) const {
  double sum = 0;
  for (const Match& m : matches(poses, moving, radius_)) sum += weight(m.height, radius_);
  return sum;
}

// Beside those before it: the best of all that came of its starts.
void Aligner::place(Poses& poses, std::size_t source) const {
  const std::vector<Vector3d> around = turns();
  const std::vector<Isometry3d>& starts = sources_[source].starts;
  std::vector<Poses> found(starts.size() * around.size(), poses);
  std::vector<double> scores(found.size());
  const Moving moving{source, source + 1};
  detail::parallel_ranges(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      found[i][source] =
          starts[i / around.size()] * turned(around[i % around.size()], middles_[source]);
      refine(found[i], moving, size_, kStride);
      scores[i] = score(found[i], moving);
    }
  });
  poses = found[static_cast<std::size_t>(std::ranges::max_element(scores) - scores.begin())];
  refine(poses, moving, radius_);
  const std::size_t shared = matches(poses, moving, radius_).size();
  if (shared >= kEnough) return;
  throw Error(
      fmt::format("'{}' shares no surface with those before it ({} points in all); its "
                  "rough pose may be too far off, or they see nothing together",
                  sources_[source].name, shared));
}

void Aligner::tell_fits(const Poses& poses, double reach, Fit AlignedSource::*fit,
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

// What is known of a direction has to be more than errors of the normals feign: a plane whose
// normals scatter seems to hold along itself, too.
void Aligner::check_held(const Equations& e) const {
  constexpr double kHeld = 2;  // as much again as is feigned
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
      "what '{}' shares with the others leaves it free to {} ({:.2f}, {:.2f}, "
      "{:.2f}); let them see more that faces different ways, such as a box",
      sources_[worst].name, turns ? "turn about" : "slide along", axis.x(), axis.y(), axis.z()));
}

void Aligner::tell_deviations(const Poses& poses, std::vector<AlignedSource>& results) const {
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
      shared += m.place;
      ++count;
    }
    const Vector3d arm = (shared / count - middle_) / size_;
    Eigen::Matrix<double, 3, 6> shift = Eigen::Matrix<double, 3, 6>::Zero();
    for (int axis = 0; axis < 3; ++axis) shift.col(axis) = Vector3d::Unit(axis).cross(arm);
    shift.rightCols<3>().setIdentity();
    const Index own = 6 * static_cast<Index>(s - 1);
    const Matrix6d c = covariance.block<6, 6>(own, own);
    results[s].place_deviation = largest(shift * c * shift.transpose());
    results[s].turn_deviation = largest(c.topLeftCorner<3, 3>()) / size_;
  }
}

}  // namespace

std::vector<AlignedSource> align(const std::vector<RoughSource>& sources) {
  if (sources.size() < 2) {
    throw Error(fmt::format("aligning takes two sources at least, not {}", sources.size()));
  }
  const Aligner aligner(sources);
  Poses poses(sources.size(), Isometry3d::Identity());
  std::vector<AlignedSource> results(sources.size());
  aligner.tell_fits(poses, aligner.size(), &AlignedSource::before, results);
  for (std::size_t s = 1; s < sources.size(); ++s) aligner.place(poses, s);
  aligner.refine(poses, {1, sources.size()}, aligner.radius());
  aligner.tell_deviations(poses, results);
  aligner.tell_fits(poses, aligner.radius(), &AlignedSource::after, results);
  for (std::size_t s = 0; s < sources.size(); ++s) results[s].T_aligned_rough = poses[s];
  return results;
}

}  // namespace palpate
