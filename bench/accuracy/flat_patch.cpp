// Finds flat parts of a depth frame and fits planes to them.
#include "accuracy/flat_patch.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

// m, where flat parts are looked for; judgement: the range of depth cameras
constexpr double kNearest = 0.3, kFarthest = 2.5;
constexpr double kHalf = 0.06;     // m, of a patch; judgement
constexpr double kMeasured = 0.9;  // least share of pixels with a depth; judgement
constexpr double kDeviations = 4;  // scales; judgement: what is farther off is another surface
constexpr double kOnPlane = 0.97;  // least share that lies on it; judgement: 3 % may be outliers
constexpr double kSag = 5e-4;      // m, that it may bend by; judgement: below the noise of a patch

Vector3d ray(const CameraModel& camera, double u, double v) {
  const Pinhole& p = camera.pinhole;
  return {(u - p.cx) / p.fx, (v - p.cy) / p.fy, 1};
}

// A height over a patch: 1, x, y or with squares, by least squares without what is far off.
class Heights {
 public:
  explicit Heights(const Patch& patch) : patch_(&patch) {
    side_ = patch.normal.unitOrthogonal();
    other_ = patch.normal.cross(side_);
  }

  [[nodiscard]] Eigen::VectorXd terms(const PatchPixel& pixel, int count) const {
    const Vector3d way = pixel.at - patch_->center;
    const double x = way.dot(side_) / kHalf;
    const double y = way.dot(other_) / kHalf;
    Eigen::VectorXd all(6);
    all << 1, x, y, x * x, x * y, y * y;
    return all.head(count);
  }

  [[nodiscard]] double height(const PatchPixel& pixel) const {
    return patch_->normal.dot(pixel.at - patch_->center);
  }

  // Biweight, from the median on; its scale is left in `scale`.
  [[nodiscard]] Eigen::VectorXd fit(int count, double& scale) const {
    Eigen::VectorXd fitted = Eigen::VectorXd::Zero(count);
    std::vector<double> off;
    for (int round = 0; round < 10; ++round) {
      off.clear();
      for (const PatchPixel& p : patch_->pixels) {
        off.push_back(std::abs(height(p) - fitted.dot(terms(p, count))));
      }
      const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
      std::nth_element(off.begin(), middle, off.end());
      scale = std::max(1.483 * *middle, 1e-5);
      Eigen::MatrixXd normal = 1e-9 * Eigen::MatrixXd::Identity(count, count);
      Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
      for (const PatchPixel& p : patch_->pixels) {
        const Eigen::VectorXd t = terms(p, count);
        const double share = (height(p) - fitted.dot(t)) / (kDeviations * scale);
        if (std::abs(share) >= 1) continue;
        const double weight = (1 - share * share) * (1 - share * share);
        normal += weight * t * t.transpose();
        right += weight * height(p) * t;
      }
      fitted = normal.ldlt().solve(right);
    }
    return fitted;
  }

  [[nodiscard]] double share_within(double reach) const {
    const auto on = std::ranges::count_if(
        patch_->pixels, [&](const PatchPixel& p) { return std::abs(height(p)) < reach; });
    return static_cast<double>(on) / static_cast<double>(patch_->pixels.size());
  }

  // Puts the patch onto the fitted plane.
  void settle(Patch& patch, const Eigen::VectorXd& plane) const {
    patch.center += plane[0] * patch.normal;
    const Vector3d tilt = plane[1] / kHalf * side_ + plane[2] / kHalf * other_;
    patch.normal = (patch.normal - tilt).normalized();
  }

 private:
  const Patch* patch_;
  Vector3d side_, other_;
};

}  // namespace

Patch patch_at(const DepthFrame& frame, int u, int v, double z) {
  const CameraModel& camera = frame.camera;
  Patch patch{u, v, z * ray(camera, u, v), {}, {}};
  patch.normal = -patch.center.normalized();
  const int half = static_cast<int>(kHalf * camera.pinhole.fx / z);
  for (int y = v - half; y <= v + half; ++y) {
    for (int x = u - half; x <= u + half; ++x) {
      if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) return {};
      const auto number = static_cast<std::size_t>(y * camera.width + x);
      const double depth = frame.depth[number];
      if (depth > 0) patch.pixels.push_back({number, depth * ray(camera, x, y)});
    }
  }
  const double all = (2.0 * half + 1) * (2.0 * half + 1);
  return static_cast<double>(patch.pixels.size()) < kMeasured * all ? Patch{} : patch;
}

double settle_on_plane(Patch& patch) {
  double scale = 0;
  for (int round = 0; round < 3; ++round) {
    const Heights heights(patch);
    heights.settle(patch, heights.fit(3, scale));
  }
  return scale;
}

std::optional<Patch> flat_patch(const DepthFrame& frame, int u, int v) {
  const double z = frame.depth[static_cast<std::size_t>(v * frame.camera.width + u)];
  if (z < kNearest || z > kFarthest) return {};
  Patch patch = patch_at(frame, u, v, z);
  if (patch.pixels.empty()) return {};
  double scale = settle_on_plane(patch);
  const Heights heights(patch);
  const Eigen::VectorXd bent = heights.fit(6, scale);
  const bool flat = bent.tail(3).cwiseAbs().maxCoeff() < kSag;
  const double facing = -patch.normal.dot(patch.center.normalized());
  if (scale > kWorstNoise * z * z * facing) return {};
  if (!flat || heights.share_within(kDeviations * scale) < kOnPlane) return {};
  return patch;
}

}  // namespace palpate::accuracy
