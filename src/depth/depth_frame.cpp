// Converts 16-bit depths to metres, and recovers the camera of an organised cloud from its points.
#include "palpate/depth/depth_frame.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "depth/input.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr std::uint16_t kTooFar = 65535;  // largest sample: some sensors' mark of too far

}  // namespace

void to_metres(std::span<const std::uint16_t> samples, double unit, std::span<float> depth) {
  if (!(unit > 0 && std::isfinite(unit))) {
    throw Error(fmt::format(
        "16-bit depth: invalid unit of {} m; give the metres per step, e.g. 0.001 for millimetres",
        unit));
  }
  if (samples.size() != depth.size()) {
    throw Error(fmt::format("16-bit depth: {} samples for {} depths; give the same number of both",
                            samples.size(), depth.size()));
  }
  std::ranges::transform(samples, depth.begin(), [unit](std::uint16_t sample) {
    return sample == kTooFar ? 0.0F : static_cast<float>(unit * sample);
  });
}

}  // namespace palpate

// The camera that saw an organised cloud: its lens and orientation, from points and their pixels.

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kClose = 0.05;  // rms of an image's points, pixels; real ones have 4e-3 at most
constexpr double kOutlying = 3;  // times the rms: such a point was moved (judgement)
// Share of points that are where they were seen, at least (judgement)
constexpr double kFewestKept = 0.99;
constexpr int kMostRounds = 10;  // of the fit (judgement)

// A point as the camera would see it.
struct Sight {
  Vector3d ray;  // from the camera, in the cloud's axes, m
  double u, v;   // its pixel
};

struct Lens {
  Matrix3d turn = Matrix3d::Identity();  // cloud's axes to the camera's
  Pinhole pinhole;
  double rms = std::numeric_limits<double>::infinity();  // pixels
};

// Least squares of y = slope x + offset.
struct Line {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;

  void add(double at, double value) {
    n += 1, x += at, y += value, xx += at * at, xy += at * value;
  }
  [[nodiscard]] double slope() const { return (n * xy - x * y) / (n * xx - x * x); }
  [[nodiscard]] double offset() const { return (y - slope() * x) / n; }
};

std::vector<Sight> sights_of(const PointCloud& cloud, const Vector3d& camera) {
  std::vector<Sight> sights;
  sights.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d ray = cloud.point(i) - camera;
    if (!(ray.squaredNorm() > 0)) continue;  // how some drivers mark what was not measured
    sights.push_back({ray, static_cast<double>(cloud.pixels[i] % cloud.width),
                      static_cast<double>(cloud.pixels[i] / cloud.width)});
  }
  return sights;
}

// Pixels are K R times rays, up to length: that product is the least eigenvector of these equations
// (direct linear transform), and taking it apart gives R.
Matrix3d turn_of(const std::vector<Sight>& sights, double size) {
  Matrix3d plain = Matrix3d::Zero();
  Matrix3d by_u = plain;
  Matrix3d by_v = plain;
  Matrix3d by_both = plain;
  Vector3d ahead = Vector3d::Zero();
  for (const Sight& s : sights) {
    const Vector3d ray = s.ray.normalized();
    const Matrix3d square = ray * ray.transpose();
    const double u = s.u / size - 0.5;
    const double v = s.v / size - 0.5;
    ahead += ray;
    plain += square;
    by_u += u * square;
    by_v += v * square;
    by_both += (u * u + v * v) * square;
  }
  const Matrix3d none = Matrix3d::Zero();
  Eigen::Matrix<double, 9, 9> equations;
  equations << plain, none, -by_u, none, plain, -by_v, -by_u, -by_v, by_both;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(equations);
  Matrix3d rows = Eigen::Map<const Matrix3d>(solver.eigenvectors().col(0).eval().data());
  if (rows.col(2).dot(ahead) < 0) rows = -rows;
  const Vector3d z = rows.col(2).normalized();
  const Vector3d y = (rows.col(1) - rows.col(1).dot(z) * z).normalized();
  Matrix3d turn;
  turn << y.cross(z).transpose(), y.transpose(), z.transpose();
  return turn;
}

// Squared distance between a point's projection and its pixel, pixels^2.
double squared_error(const Lens& lens, const Sight& s) {
  const Vector3d p = lens.turn * s.ray;
  if (!(p.z() > 0)) return std::numeric_limits<double>::infinity();
  const double u = lens.pinhole.fx * p.x() / p.z() + lens.pinhole.cx - s.u;
  const double v = lens.pinhole.fy * p.y() / p.z() + lens.pinhole.cy - s.v;
  return u * u + v * v;
}

Lens lens_of(const std::vector<Sight>& sights, const Matrix3d& turn) {
  Lens lens;
  lens.turn = turn;
  Line across;
  Line down;
  for (const Sight& s : sights) {
    const Vector3d p = turn * s.ray;
    if (!(p.z() > 0)) continue;
    across.add(p.x() / p.z(), s.u);
    down.add(p.y() / p.z(), s.v);
  }
  lens.pinhole = {across.slope(), down.slope(), across.offset(), down.offset()};
  if (!(lens.pinhole.fx > 0 && lens.pinhole.fy > 0)) return lens;  // a mirror, or too few points
  double sum = 0;
  for (const Sight& s : sights) {
    const double error = squared_error(lens, s);
    if (std::isfinite(error)) sum += error;
  }
  lens.rms = std::sqrt(sum / across.n);
  return lens;
}

// Most cameras look along an axis, and then their frame is to be exactly the cloud's.
Lens lens_of(const std::vector<Sight>& sights, double size) {
  const Matrix3d turn = turn_of(sights, size);
  const Matrix3d axes = turn.array().round();
  const Lens along = axes.isUnitary() ? lens_of(sights, axes) : Lens();
  if (along.rms <= kClose) return along;
  const Lens free = lens_of(sights, turn);
  return free.rms < along.rms ? free : along;
}

// Leaves out of `sights` what is not where the others are.
Lens fit(std::vector<Sight>& sights, double size) {
  const double fewest = kFewestKept * static_cast<double>(sights.size());
  Lens lens;
  for (int round = 0; round < kMostRounds; ++round) {
    lens = lens_of(sights, size);
    const double limit = std::max(kOutlying * lens.rms, kClose);
    const auto moved = [&](const Sight& s) { return squared_error(lens, s) > limit * limit; };
    if (std::erase_if(sights, moved) == 0 || static_cast<double>(sights.size()) < fewest) break;
  }
  return lens;
}

DepthFrame frame_of(const PointCloud& cloud, const std::vector<Sight>& sights, const Lens& lens,
                    const Vector3d& camera) {
  DepthFrame frame;
  frame.camera.width = static_cast<int>(cloud.width);
  frame.camera.height = static_cast<int>(cloud.height);
  frame.camera.pinhole = lens.pinhole;
  frame.depth.resize(cloud.width * cloud.height, 0);
  for (const Sight& s : sights) {
    const double pixel = s.v * static_cast<double>(cloud.width) + s.u;
    frame.depth[static_cast<std::size_t>(pixel)] = static_cast<float>(lens.turn.row(2).dot(s.ray));
  }
  if (lens.turn.isIdentity(0) && camera.isZero(0)) return frame;
  frame.T_world_sensor = Eigen::Translation3d(camera) * Eigen::Quaterniond(lens.turn.transpose());
  return frame;
}

bool is_organised(const PointCloud& cloud) {
  if (std::min(cloud.width, cloud.height) < depth::kFewestPixels) return false;
  if (cloud.pixels.size() != cloud.size()) return false;
  if (std::max(cloud.width, cloud.height) > depth::kMostPixels) return false;
  const std::size_t pixels = cloud.width * cloud.height;
  return std::ranges::all_of(cloud.pixels, [&](std::uint32_t pixel) { return pixel < pixels; });
}

}  // namespace

OrganisedFrame depth_frame_of(const PointCloud& cloud) {
  OrganisedFrame result;
  if (!is_organised(cloud)) {
    result.why_none = "its points do not form an image, or the image is too small";
    return result;
  }
  const auto size = static_cast<double>(std::max(cloud.width, cloud.height));
  result.residual = std::numeric_limits<double>::infinity();
  for (const Vector3d& camera : {cloud.viewpoint.value_or(Vector3d::Zero()), Vector3d(0, 0, 0)}) {
    std::vector<Sight> sights = sights_of(cloud, camera);
    const Lens lens = fit(sights, size);
    result.residual = std::min(result.residual, lens.rms);
    if (lens.rms <= kClose) {
      result.frame = frame_of(cloud, sights, lens, camera);
      return result;
    }
    if (camera.isZero(0)) break;
  }
  result.why_none = "no pinhole camera projects its points to their pixels";
  return result;
}

}  // namespace palpate
