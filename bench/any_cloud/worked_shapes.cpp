// Distances to bodies as machines and nature work them.
#include "any_cloud/worked_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

Shape top_of(std::function<Distance(const Vector3d&)> height, double steepest) {
  const double scale = 1 / std::sqrt(1 + steepest * steepest);
  return [height = std::move(height), scale](const Vector3d& x) {
    const Distance h = height(x);
    return Distance{scale * (x.z() - h.value), scale * (Vector3d::UnitZ() - h.gradient)};
  };
}

Shape any_of(const std::vector<Shape>& shapes) {
  Shape all = shapes.front();
  for (std::size_t i = 1; i < shapes.size(); ++i) all = unite(all, shapes[i]);
  return all;
}

}  // namespace

Shape both(Shape a, Shape b) {
  return [a = std::move(a), b = std::move(b)](const Vector3d& x) {
    const Distance da = a(x);
    const Distance db = b(x);
    return da.value > db.value ? da : db;
  };
}

Shape relief(const Vector3d& half, double wavelength, double height) {
  const double k = kTurn / wavelength;
  const auto wave = [=](const Vector3d& x) {
    const double a = std::sin(k * x.x());
    const double b = std::sin(k * x.y());
    return Distance{half.z() + height * a * b,
                    height * k * Vector3d(std::cos(k * x.x()) * b, a * std::cos(k * x.y()), 0)};
  };
  const Vector3d tall(half.x(), half.y(), half.z() + height);
  return both(box(Vector3d(0, 0, height), 2 * tall), top_of(wave, height * k));
}

Shape saddle(const Vector3d& half, double height) {
  const double c = height / (half.x() * half.x());
  const auto bent = [=](const Vector3d& x) {
    const double a = std::clamp(x.x(), -half.x(), half.x());
    const double b = std::clamp(x.y(), -half.x(), half.x());
    return Distance{half.z() + c * (a * a - b * b), 2 * c * Vector3d(a, -b, 0)};
  };
  const Vector3d tall(half.x(), half.y(), half.z() + height);
  return both(box(Vector3d(0, 0, height), 2 * tall), top_of(bent, 3 * c * half.x()));
}

Shape thread(double radius, double length, double pitch, double depth) {
  const double scale = 1 / std::sqrt(1 + std::pow(2 * depth * kTurn / pitch, 2));
  const Shape winding = [=](const Vector3d& x) {
    const double away = std::hypot(x.x(), x.y());
    const double phase = kTurn * x.z() / pitch - std::atan2(x.y(), x.x());
    const Vector3d out = away > 0 ? Vector3d(x.x() / away, x.y() / away, 0) : Vector3d::UnitX();
    const Vector3d around = Vector3d::UnitZ().cross(out) / std::max(away, 0.5 * radius);
    const double slope = depth * std::cos(phase);
    return Distance{scale * (away - radius - depth * std::sin(phase)),
                    scale * (out - slope * (Vector3d::UnitZ() * (kTurn / pitch) - around))};
  };
  return both(winding, box(Vector3d::Zero(), Vector3d(4 * radius, 4 * radius, length)));
}

Shape comb(double tooth, int teeth, double height, double width) {
  const double length = (2 * teeth - 1) * tooth;
  std::vector<Shape> parts{box(Vector3d(0, 0, -4), Vector3d(length, width, 8))};
  for (int i = 0; i < teeth; ++i) {
    const double x = -0.5 * length + (2 * i + 0.5) * tooth;
    parts.push_back(box(Vector3d(x, 0, 0.5 * height - 1), Vector3d(tooth, width, height + 2)));
  }
  return any_of(parts);
}

Shape lattice(double pitch, double radius, int count) {
  const double half = 0.5 * pitch * (count - 1);
  std::vector<Shape> rods;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < count * count; ++i) {
      Vector3d middle;
      middle[(axis + 1) % 3] = i % count * pitch - half;
      middle[(axis + 2) % 3] = i / count * pitch - half;
      middle[axis] = 0;
      const Vector3d end = (half + 0.5 * pitch) * Vector3d::Unit(axis);
      rods.push_back(rod(middle - end, middle + end, radius));
    }
  }
  return any_of(rods);
}

Shape cup(double outer, double inner) {
  const Shape hollow = [=](const Vector3d& x) {
    const Distance d = ball(inner)(x);
    return Distance{-d.value, -d.gradient};
  };
  const Shape below = half_space(Vector3d(0, 0, 0.5 * inner), Vector3d::UnitZ());
  return both(both(ball(outer), hollow), below);
}

Shape spring(double radius, double wire, double pitch, double turns) {
  const double lean = std::atan(pitch / (kTurn * radius));
  const double scale = std::cos(lean);
  const Shape wound = [=](const Vector3d& x) {
    const double away = std::hypot(x.x(), x.y());
    const double angle = std::atan2(x.y(), x.x());
    const double most = 0.5 * turns;
    const double turn = std::clamp(std::round(x.z() / pitch - angle / kTurn), -most - 1, most + 1);
    const Vector3d out = away > 0 ? Vector3d(x.x() / away, x.y() / away, 0) : Vector3d::UnitX();
    const Vector3d around = Vector3d::UnitZ().cross(out) / std::max(away, 0.5 * radius);
    const double aside = away - radius;
    const double above = scale * (x.z() - pitch * (turn + angle / kTurn));
    const double norm = std::max(std::hypot(aside, above), 1e-12);
    const Vector3d slope = scale * (Vector3d::UnitZ() - pitch / kTurn * around);
    return Distance{0.9 * (norm - wire), 0.9 * (aside * out + above * slope) / norm};
  };
  const double tall = pitch * turns;
  return both(wound, box(Vector3d::Zero(), Vector3d(4 * radius, 4 * radius, tall)));
}

}  // namespace palpate::any_cloud
