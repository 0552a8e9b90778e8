// Makes triangles of a depth image and finds those that a straight way meets.
#include "rivals/frame_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::rivals {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Triangle = FrameMesh::Triangle;

constexpr double kSkin = 1e-6;     // m; judgement: 0.0005 N, far above rounding
constexpr double kSlack = 1e-7;    // m behind a triangle that still count as before it; judgement
constexpr double kSide = 1e-9;     // share of a triangle beyond its sides; judgement: rounding
constexpr double kPixels = 1e-6;   // pixels; judgement: rounding of projections
constexpr double kNearest = 0.01;  // m before the sensor; judgement: nothing is measured nearer
constexpr std::uint8_t kFirst = 1, kSecond = 2, kFalling = 4;

// Twice the triangle's area long.
Vector3d area_normal(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a);
}

Vector2d project(const Pinhole& p, const Vector3d& x) {
  return {p.fx * x.x() / x.z() + p.cx, p.fy * x.y() / x.z() + p.cy};
}

}  // namespace

// A straight way, and the first triangle that it has met so far.
struct FrameMesh::Way {
  Vector3d from, to;
  std::span<const Triangle> except;
  double share = std::numeric_limits<double>::infinity();
  Met<Triangle> met;

  void meet(const Triangle& triangle, const Vector3d& a, const Vector3d& b, const Vector3d& c);
};

FrameMesh::FrameMesh(const DepthFrame& frame, double jump)
    : width_(frame.camera.width),
      height_(frame.camera.height),
      jump_(jump / frame.camera.pinhole.fx),
      pinhole_(frame.camera.pinhole),
      vertices_(frame.depth.size(), Vector3d::Zero()),
      cells_(frame.depth.size(), 0) {
  std::size_t i = 0;
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u, ++i) {
      const double z = frame.depth[i];
      if (!(z > 0)) continue;
      vertices_[i] =
          z * Vector3d((u - pinhole_.cx) / pinhole_.fx, (v - pinhole_.cy) / pinhole_.fy, 1);
    }
  }
  for (int v = 0; v + 1 < height_; ++v) {
    for (int u = 0; u + 1 < width_; ++u) {
      const int corner = v * width_ + u;
      cells_[static_cast<std::size_t>(corner)] = divide(corner);
    }
  }
}

void FrameMesh::come_from(const FrameMesh& before) {
  begins_ = vertices_;
  share_ = 0;
  if (before.vertices() != vertices()) return;
  for (int i = 0; i < vertices(); ++i) {
    if (measured(i) && before.measured(i)) begins_[static_cast<std::size_t>(i)] = before.at(i);
  }
}

bool FrameMesh::joined(int a, int b, int c) const {
  const auto [low, high] = std::minmax({at(a).z(), at(b).z(), at(c).z()});
  return low > 0 && high - low <= jump_ * low;
}

std::uint8_t FrameMesh::divide(int corner) const {
  const int a = corner, b = a + 1, c = a + width_, d = c + 1;
  // Without one corner there is one triangle, of the other three.
  const bool falling = !measured(b) || !measured(c) ? true
                       : !measured(a) || !measured(d)
                           ? false
                           : (at(a) - at(d)).squaredNorm() <= (at(b) - at(c)).squaredNorm();
  const bool first = falling ? joined(a, d, b) : joined(a, c, b);
  const bool second = falling ? joined(a, c, d) : joined(b, c, d);
  return static_cast<std::uint8_t>((first ? kFirst : 0) | (second ? kSecond : 0) |
                                   (falling ? kFalling : 0));
}

int FrameMesh::triangles_in(int column, int row, std::array<Triangle, 2>& found) const {
  const int a = row * width_ + column, b = a + 1, c = a + width_, d = c + 1;
  const std::uint8_t cell = cells_[static_cast<std::size_t>(a)];
  const bool falling = (cell & kFalling) != 0;
  int n = 0;
  if ((cell & kFirst) != 0) found[n++] = falling ? Triangle{a, d, b} : Triangle{a, c, b};
  if ((cell & kSecond) != 0) found[n++] = falling ? Triangle{a, c, d} : Triangle{b, c, d};
  return n;
}

Vector3d FrameMesh::normal(const Triangle& t) const {
  return area_normal(at(t[0]), at(t[1]), at(t[2])).normalized();
}

void FrameMesh::triangles_at(int vertex, std::vector<Triangle>& found) const {
  found.clear();
  const int u = vertex % width_;
  const int v = vertex / width_;
  std::array<Triangle, 2> some;
  for (int row = std::max(v - 1, 0); row <= std::min(v, height_ - 2); ++row) {
    for (int column = std::max(u - 1, 0); column <= std::min(u, width_ - 2); ++column) {
      const int n = triangles_in(column, row, some);
      for (int i = 0; i < n; ++i) {
        if (std::ranges::count(some[i], vertex) > 0) found.push_back(some[i]);
      }
    }
  }
}

Vector3d FrameMesh::vertex_normal(int vertex) const {
  const int u = vertex % width_;
  const int v = vertex / width_;
  Vector3d sum = Vector3d::Zero();
  std::array<Triangle, 2> some;
  for (int row = std::max(v - 1, 0); row <= std::min(v, height_ - 2); ++row) {
    for (int column = std::max(u - 1, 0); column <= std::min(u, width_ - 2); ++column) {
      const int n = triangles_in(column, row, some);
      for (int i = 0; i < n; ++i) {
        const Triangle& t = some[i];
        if (std::ranges::count(t, vertex) > 0) sum += area_normal(at(t[0]), at(t[1]), at(t[2]));
      }
    }
  }
  return sum.normalized();
}

Vector3d FrameMesh::smooth_normal(const Triangle& t, const Vector3d& place) const {
  const Vector3d n = area_normal(at(t[0]), at(t[1]), at(t[2]));
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3d a = at(t[(i + 1) % 3]);
    const Vector3d b = at(t[(i + 2) % 3]);
    const double share = std::clamp(n.dot((b - a).cross(place - a)) / n.squaredNorm(), 0.0, 1.0);
    sum += share * vertex_normal(t[i]);
  }
  return sum.normalized();
}

void FrameMesh::Way::meet(const Triangle& triangle, const Vector3d& a, const Vector3d& b,
                          const Vector3d& c) {
  const Vector3d n = area_normal(a, b, c);
  const double length = n.norm();
  const double before = n.dot(from - a);
  const double after = n.dot(to - a);
  if (before < -kSlack * length || after >= 0 || after >= before) return;
  const double at = std::max(before, 0.0) / (std::max(before, 0.0) - after);
  if (at >= share) return;
  const Vector3d x = from + at * (to - from);
  const double least = -kSide * length * length;
  if (n.dot((b - a).cross(x - a)) < least || n.dot((c - b).cross(x - b)) < least ||
      n.dot((a - c).cross(x - c)) < least) {
    return;
  }
  for (const Triangle& other : except) {
    if (other == triangle) return;
  }
  share = at;
  const double way = std::max(before - kSkin * length, 0.0) / (before - after);
  met = {triangle, n / length, x, from + way * (to - from)};
}

void FrameMesh::meet(int column, int row, Way& way) const {
  std::array<Triangle, 2> some;
  const int n = triangles_in(column, row, some);
  for (int i = 0; i < n; ++i) {
    way.meet(some[i], at(some[i][0]), at(some[i][1]), at(some[i][2]));
  }
}

// A straight way is straight in the image, too: its columns are taken in turn, and of each the
// squares that the way passes.
std::optional<Met<Triangle>> FrameMesh::first_met(const Vector3d& from, const Vector3d& to,
                                                  std::span<const Triangle> except) const {
  if (from.z() < kNearest || to.z() < kNearest) return std::nullopt;
  const Vector2d begin = project(pinhole_, from);
  const Vector2d way = project(pinhole_, to) - begin;
  const double last = width_ - 2;
  const auto column_of = [&](double u) {
    return static_cast<int>(std::clamp(std::floor(u), 0.0, last));
  };
  const int low = column_of(std::min(begin.x(), begin.x() + way.x()) - kPixels);
  const int high = column_of(std::max(begin.x(), begin.x() + way.x()) + kPixels);
  const bool back = way.x() < 0;
  Way found{.from = from, .to = to, .except = except, .met = {}};
  for (int k = 0; k <= high - low; ++k) {
    const int column = back ? high - k : low + k;
    double first = 0, second = 1;
    if (std::abs(way.x()) > kPixels) {
      first = std::clamp((column - kPixels - begin.x()) / way.x(), 0.0, 1.0);
      second = std::clamp((column + 1 + kPixels - begin.x()) / way.x(), 0.0, 1.0);
    }
    const double at_first = begin.y() + first * way.y();
    const double at_second = begin.y() + second * way.y();
    const double up = std::min(at_first, at_second);
    const double down = std::max(at_first, at_second);
    const int bottom = static_cast<int>(std::min(std::floor(down + kPixels), height_ - 2.0));
    for (int row = static_cast<int>(std::max(std::floor(up - kPixels), 0.0)); row <= bottom;
         ++row) {
      meet(column, row, found);
    }
    if (std::isfinite(found.share)) return found.met;
  }
  return std::nullopt;
}

}  // namespace palpate::rivals
