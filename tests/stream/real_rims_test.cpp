// Checks how far the surface of a real depth image goes on beyond the last pixel of a thing.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Where something flat ends in front of what is farther away.
struct Rim {
  Vector3d end;     // the outer border of its last pixel
  Vector3d out;     // unit, along the plane, away from it
  Vector3d normal;  // unit, towards the camera
};

/// A pixel, and the way along its row or column to where the thing ends.
struct Place {
  int u;
  int v;
  int across;
  int down;

  [[nodiscard]] Place at(int ahead, int aside) const {
    return {u + ahead * across + aside * down, v + ahead * down + aside * across, across, down};
  }
};

double depth(const DepthFrame& frame, const Place& at) {
  return static_cast<double>(
      frame.depth[static_cast<std::size_t>(at.v) * frame.camera.width + at.u]);
}

Vector3d ray(const DepthFrame& frame, double u, double v) {
  const Pinhole& p = frame.camera.pinhole;
  return {(u - p.cx) / p.fx, (v - p.cy) / p.fy, 1};
}

/// The rim at a pixel's side, if what lies within 12 pixels of it is flat and what is beyond it
/// is 50 mm farther away.
std::optional<Rim> rim_at(const DepthFrame& frame, const Place& last) {
  constexpr int kShadow = 6;        // pixels beside a thing that the projector does not light
  constexpr double kFlat = 2.5e-3;  // m; steps of depth are 5 mm at 1.3 m
  const double z = depth(frame, last);
  if (!(z > 0.3 && z < 1.3)) return std::nullopt;
  for (int k = 1; k <= 12; ++k) {
    const double beyond = depth(frame, last.at(k, 0));
    if (!(beyond > z + 0.05) && !(beyond == 0 && k < kShadow)) return std::nullopt;
  }
  std::vector<Vector3d> points;
  Vector3d middle = Vector3d::Zero();
  for (int k = 0; k < 12; ++k) {
    for (int c = -6; c <= 6; ++c) {
      const Place at = last.at(-k, c);
      if (!(depth(frame, at) > 0)) continue;
      points.emplace_back(depth(frame, at) * ray(frame, at.u, at.v));
      middle += points.back();
    }
  }
  if (points.size() < 140) return std::nullopt;  // of 156
  middle /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - middle) * (p - middle).transpose();
  spread /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  Vector3d normal = axes.eigenvectors().col(0);
  if (normal.dot(middle) > 0) normal = -normal;
  if (axes.eigenvalues()[0] > kFlat * kFlat || -normal.dot(middle.normalized()) < 0.6) {
    return std::nullopt;
  }
  for (int c = -3; c <= 3; ++c) {
    const Place at = last.at(0, c);
    const Vector3d p = depth(frame, at) * ray(frame, at.u, at.v);
    if (std::abs(normal.dot(p - middle)) > 2 * kFlat) return std::nullopt;
  }
  const auto on_plane = [&](double ahead) -> Vector3d {
    const Vector3d way = ray(frame, last.u + ahead * last.across, last.v + ahead * last.down);
    return way * (normal.dot(middle) / normal.dot(way));
  };
  return Rim{on_plane(0.5), (on_plane(1) - on_plane(0)).normalized(), normal};
}

std::vector<Rim> rims_of(const DepthFrame& frame) {
  constexpr int kMargin = 24;  // pixels that rim_at() looks at, and more
  std::vector<Rim> rims;
  for (int v = kMargin; v < frame.camera.height - kMargin; ++v) {
    for (int u = kMargin; u < frame.camera.width - kMargin; ++u) {
      for (const auto& [across, down] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (const auto rim = rim_at(frame, {u, v, across, down})) rims.push_back(*rim);
      }
    }
  }
  return rims;
}

/// Is a hand held that pokes 5 mm deep, so far (m) beyond a rim?
bool is_held(SceneField& field, const Rim& rim, double beyond) {
  const Vector3d place = rim.end + beyond * rim.out;
  Proxy proxy({.stiffness = 500});
  Contact contact;
  for (int tick = 0; tick <= 170; ++tick) {
    const Vector3d hand = place + (0.012 - 1e-4 * tick) * rim.normal;
    field.update(10 + 1e-3 * tick, hand, proxy);
    contact = proxy.step(field, hand, 1e-3);
  }
  return contact.force.norm() > 0.5;  // N, of 2.5
}

TEST(RealRims, ThingsEndWithTheirLastPixel) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  for (const char* name :
       {"osd_test0.pcd", "osd_test7.pcd", "osd_test26.pcd", "milk_cartoon_all_small_clorox.pcd"}) {
    DepthFrame frame =
        *depth_frame_of(read_cloud(std::filesystem::path(data) / "pcl_tabletop" / name)).frame;
    frame.T_world_sensor = Eigen::Isometry3d::Identity();
    Scene scene;
    scene.add("camera").set(frame);
    SceneField field(scene);
    const std::vector<Rim> rims = rims_of(frame);
    ASSERT_GT(rims.size(), 40u) << name;
    std::vector<double> ends;
    int lost = 0;
    const std::size_t step = rims.size() / 40;
    for (std::size_t i = 0; i < rims.size(); i += step) {
      lost += is_held(field, rims[i], -2e-3) ? 0 : 1;
      double end = -2e-3;
      while (end < 0.02 && is_held(field, rims[i], end + 1e-3)) end += 1e-3;
      ends.push_back(end);
    }
    std::ranges::sort(ends);
    EXPECT_EQ(lost, 0) << name;
    EXPECT_LE(ends[ends.size() / 2], 3e-3) << name << ": median";
    EXPECT_LE(ends.back(), 8e-3) << name << ": worst";
    RecordProperty(name, fmt::format("{}: {:.0f} {:.0f} {:.0f} mm", ends.size(), 1e3 * ends.front(),
                                     1e3 * ends[ends.size() / 2], 1e3 * ends.back()));
  }
}

}  // namespace
}  // namespace palpate
