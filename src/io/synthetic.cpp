// Samples the surfaces of the synthetic clouds.
#include "palpate/io/synthetic.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/numbers.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
constexpr double kJitter = 0.2;  // share of the spacing (judgement)

constexpr std::array<SyntheticName, 7> kNames = {{
    {"bumps", "a 20 x 20 cm surface of rounded bumps, seen from above"},
    {"sheet", "a gently waved 20 x 15 cm sheet that can be touched from both sides"},
    {"sphere", "a closed ball of 12 cm"},
    {"torus", "a closed ring of 20 cm, 6 cm thick"},
    {"table", "a table-top with a ball and a box on it"},
    {"rabbit", "a closed rabbit of 20 cm, like a laser scan"},
    {"room", "a room of 4 x 3 m with furniture; point spacing is five times as large"},
}};

struct Oriented {
  Vector3d position;
  Vector3d normal;
};

struct Ellipsoid {
  Vector3d center;
  Vector3d axes;  // half lengths along the turned x, y, z, m
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();

  [[nodiscard]] bool contains(const Vector3d& x) const {
    const Vector3d local = turn.conjugate() * (x - center);
    return local.cwiseQuotient(axes).squaredNorm() < 1;
  }
};

// Collects points with noise along their normals.
class Builder {
 public:
  explicit Builder(const SyntheticOptions& options) : options_(options), random_(options.seed) {}

  // A point for about every spacing^2 of the rectangle [0, width] x [0, height].
  void patch(double width, double height, const std::function<Oriented(double, double)>& surface) {
    const int columns = count(width);
    const int rows = count(height);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double u = (i + 0.5 + kJitter * random_.normal()) * width / columns;
        const double v = (j + 0.5 + kJitter * random_.normal()) * height / rows;
        add(surface(u, v));
      }
    }
  }

  // A ball, or the part of it above `lowest` radii, on a golden spiral: even everywhere.
  void ball(const Vector3d& center, double radius, double lowest = -1) {
    const double area = 2 * kPi * radius * radius * (1 - lowest);
    const int points = std::max(8, static_cast<int>(area / (options_.spacing * options_.spacing)));
    for (int i = 0; i < points; ++i) {
      const double z = 1 - (1 - lowest) * (i + 0.5) / points;
      const double angle = i * kPi * (3 - std::sqrt(5.0));
      const double r = std::sqrt(1 - z * z);
      const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
      add({center + radius * direction, direction});
    }
  }

  // The part of an ellipsoid that is outside of others.
  void ellipsoid(const Ellipsoid& shape, const std::function<bool(const Vector3d&)>& hidden) {
    const Vector3d& a = shape.axes;
    const double mean = std::cbrt((std::pow(a.x() * a.y(), 1.6) + std::pow(a.x() * a.z(), 1.6) +
                                   std::pow(a.y() * a.z(), 1.6)) /
                                  3);  // Thomsen's area, to the power 1.6 / 3
    const double area = 4 * kPi * std::pow(mean, 3 / 1.6);
    const int points = std::max(8, static_cast<int>(area / (options_.spacing * options_.spacing)));
    for (int i = 0; i < points; ++i) {
      const double z = 1 - 2 * (i + 0.5) / points;
      const double angle = i * kPi * (3 - std::sqrt(5.0));
      const double r = std::sqrt(1 - z * z);
      const Vector3d unit(r * std::cos(angle), r * std::sin(angle), z);
      const Vector3d position = shape.center + shape.turn * a.cwiseProduct(unit);
      if (!hidden(position)) add({position, (shape.turn * unit.cwiseQuotient(a)).normalized()});
    }
  }

  // A closed curve's points, one for every spacing of its length.
  void loop(double length, const std::function<Oriented(double)>& curve) {
    const int points = count(length);
    for (int i = 0; i < points; ++i) {
      add(curve((i + kJitter * random_.normal()) / points));
    }
  }

  [[nodiscard]] int count(double length) const {
    return std::max(2, static_cast<int>(std::lround(length / options_.spacing)));
  }

  PointCloud take() { return std::move(cloud_); }

 private:
  void add(const Oriented& point) {
    const Vector3d position = point.position + options_.noise * random_.normal() * point.normal;
    cloud_.positions.push_back(position.cast<float>());
    cloud_.normals.push_back(point.normal.cast<float>().normalized());
  }

  SyntheticOptions options_;
  Random random_;
  PointCloud cloud_;
};

// A height z(x, y) with its slopes, over a rectangle around the origin.
struct Relief {
  double z = 0;
  double slope_x = 0;
  double slope_y = 0;
};

void add_relief(Builder& builder, double width, double height,
                const std::function<Relief(double, double)>& relief) {
  builder.patch(width, height, [&](double u, double v) {
    const double x = u - width / 2;
    const double y = v - height / 2;
    const Relief r = relief(x, y);
    return Oriented{{x, y, r.z}, Vector3d(-r.slope_x, -r.slope_y, 1).normalized()};
  });
}

PointCloud bumps(Builder builder) {
  constexpr double kHeight = 6e-3;
  constexpr double kWave = 2 * kPi / 0.05;
  add_relief(builder, 0.2, 0.2, [](double x, double y) {
    const double cx = std::cos(kWave * x);
    const double cy = std::cos(kWave * y);
    return Relief{kHeight * cx * cy, -kHeight * kWave * std::sin(kWave * x) * cy,
                  -kHeight * kWave * cx * std::sin(kWave * y)};
  });
  PointCloud cloud = builder.take();
  cloud.viewpoint = Vector3d(0, 0, 0.6);
  return cloud;
}

PointCloud sheet(Builder builder) {
  constexpr double kHeight = 8e-3;
  constexpr double kWave = 2 * kPi / 0.16;
  add_relief(builder, 0.2, 0.15, [](double x, double) {
    return Relief{kHeight * std::sin(kWave * x), kHeight * kWave * std::cos(kWave * x), 0};
  });
  PointCloud cloud = builder.take();
  cloud.viewpoint = Vector3d(0, 0, 0.6);
  return cloud;
}

PointCloud sphere(Builder builder) {
  builder.ball(Vector3d::Zero(), 0.06);
  return builder.take();
}

PointCloud torus(Builder builder) {
  constexpr double kRing = 0.07;
  constexpr double kTube = 0.03;
  const int rows = builder.count(2 * kPi * kTube);
  for (int row = 0; row < rows; ++row) {
    const double tube = 2 * kPi * row / rows;
    const double radius = kRing + kTube * std::cos(tube);
    builder.loop(2 * kPi * radius, [&](double turn) {
      const double angle = 2 * kPi * turn;
      const Vector3d out(std::cos(angle), std::sin(angle), 0);
      const Vector3d normal = std::cos(tube) * out + std::sin(tube) * Vector3d::UnitZ();
      return Oriented{kRing * out + kTube * normal, normal};
    });
  }
  return builder.take();
}

// The top of a box at `center`, turned about z, and the two sides that a camera at -y sees.
void add_box(Builder& builder, const Vector3d& center, const Vector3d& size, double turn) {
  const Eigen::AngleAxisd rotation(turn, Vector3d::UnitZ());
  const auto face = [&](const Vector3d& corner, const Vector3d& u, const Vector3d& v) {
    const Vector3d normal = rotation * u.cross(v).normalized();
    builder.patch(u.norm(), v.norm(), [&](double a, double b) {
      return Oriented{center + rotation * (corner + a * u.normalized() + b * v.normalized()),
                      normal};
    });
  };
  const Vector3d half = 0.5 * size;
  const Vector3d x(size.x(), 0, 0);
  const Vector3d y(0, size.y(), 0);
  const Vector3d z(0, 0, size.z());
  face({-half.x(), -half.y(), half.z()}, x, y);
  face(-half, x, z);
  face({-half.x(), half.y(), -half.z()}, -y, z);
}

PointCloud table(Builder builder) {
  add_relief(builder, 0.5, 0.36, [](double, double) { return Relief{}; });
  builder.ball({-0.12, 0.02, 0.05}, 0.06, -0.2);
  add_box(builder, {0.1, 0.05, 0.035}, {0.11, 0.07, 0.07}, 0.35);
  PointCloud cloud = builder.take();
  cloud.viewpoint = Vector3d(0, -0.45, 0.6);
  return cloud;
}

Eigen::Quaterniond leaning(double forward, double aside) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(aside, Vector3d::UnitX()) *
                            Eigen::AngleAxisd(forward, Vector3d::UnitY()));
}

// It sits on z = 0 and looks along +x.
PointCloud rabbit(Builder builder) {
  const std::array<Ellipsoid, 9> parts = {{
      {{-0.020, 0, 0.055}, {0.070, 0.050, 0.055}, leaning(-0.35, 0)},  // body
      {{0.035, 0, 0.060}, {0.038, 0.036, 0.050}, leaning(0.25, 0)},    // chest
      {{0.055, 0, 0.115}, {0.036, 0.028, 0.029}, leaning(0.30, 0)},    // head
      {{0.030, 0.016, 0.165}, {0.013, 0.008, 0.045}, leaning(-0.35, -0.2)},
      {{0.030, -0.016, 0.165}, {0.013, 0.008, 0.045}, leaning(-0.35, 0.2)},
      {{-0.010, 0.040, 0.030}, {0.045, 0.020, 0.030}},  // hind legs
      {{-0.010, -0.040, 0.030}, {0.045, 0.020, 0.030}},
      {{0.058, 0.018, 0.014}, {0.026, 0.012, 0.014}},  // paws
      {{-0.090, 0, 0.040}, {0.018, 0.018, 0.018}},     // tail
  }};
  for (const Ellipsoid& part : parts) {
    builder.ellipsoid(part, [&](const Vector3d& x) {
      return x.z() < 0 || std::ranges::any_of(parts, [&](const Ellipsoid& other) {
               return &other != &part && other.contains(x);
             });
    });
  }
  return builder.take();
}

// Floor and two walls, a table with a ball on it, a cupboard; seen from the free corner.
PointCloud room(const SyntheticOptions& options) {
  constexpr double kCoarser = 5;
  constexpr double kHeight = 2.4;
  SyntheticOptions coarse = options;
  coarse.spacing *= kCoarser;
  Builder builder(coarse);
  add_relief(builder, 4, 3, [](double, double) { return Relief{}; });
  builder.patch(4, kHeight, [](double u, double v) {
    return Oriented{{u - 2, 1.5, v}, -Vector3d::UnitY()};
  });
  builder.patch(3, kHeight, [](double u, double v) {
    return Oriented{{2, u - 1.5, v}, -Vector3d::UnitX()};
  });
  add_box(builder, {0.2, 0.4, 0.37}, {1.4, 0.8, 0.74}, 0.1);
  add_box(builder, {1.4, 1.1, 0.9}, {0.9, 0.5, 1.8}, 0);
  builder.ball({0.3, 0.4, 0.89}, 0.15);
  PointCloud cloud = builder.take();
  cloud.viewpoint = Vector3d(-1.8, -1.4, 1.6);
  return cloud;
}

void check(const SyntheticOptions& options) {
  if (!(options.spacing >= 1e-5 && options.spacing <= 0.02)) {
    throw Error(fmt::format("synthetic cloud: spacing {} m is out of range: give 1e-5 to 0.02 m",
                            options.spacing));
  }
  if (!(options.noise >= 0 && options.noise <= 0.02)) {
    throw Error(fmt::format("synthetic cloud: noise {} m is out of range: give 0 to 0.02 m",
                            options.noise));
  }
}

}  // namespace

std::span<const SyntheticName> synthetic_names() {
  return kNames;
}

PointCloud synthetic_cloud(std::string_view name, const SyntheticOptions& options) {
  check(options);
  const Builder builder(options);
  if (name == "bumps") return bumps(builder);
  if (name == "sheet") return sheet(builder);
  if (name == "sphere") return sphere(builder);
  if (name == "torus") return torus(builder);
  if (name == "table") return table(builder);
  if (name == "rabbit") return rabbit(builder);
  if (name == "room") return room(options);
  std::string choices;
  for (const SyntheticName& each : kNames) choices += fmt::format(" {}", each.name);
  throw Error(fmt::format("unknown synthetic cloud '{}': choose one of{}", name, choices));
}

}  // namespace palpate
