// Checks that a hand finds no hole in surfaces of clouds.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Points of a sheet in z = 0 that are off their places by up to a tenth of the spacing.
class Sheet {
 public:
  /// Adds [x0, x1) x [y0, y1), `spacing` apart, m.
  void add(double x0, double x1, double y0, double y1, double spacing) {
    for (double x = x0 + spacing / 2; x < x1; x += spacing) {
      for (double y = y0 + spacing / 2; y < y1; y += spacing) {
        cloud_.positions.push_back(
            Vector3d(x + spacing * off(), y + spacing * off(), 0).cast<float>());
      }
    }
  }

  /// Adds points within `size` of the origin.
  void add_cluster(int count, double size) {
    for (int i = 0; i < count; ++i) {
      cloud_.positions.push_back((10 * size * Vector3d(off(), off(), 0.1 * off())).cast<float>());
    }
  }

  [[nodiscard]] const PointCloud& cloud() const { return cloud_; }

 private:
  double off() { return off_(random_); }

  std::mt19937 random_{1};
  std::uniform_real_distribution<double> off_{-0.1, 0.1};
  PointCloud cloud_;
};

/// Does a hand that moves from `from` to `to` end in contact?
bool stops(SceneField& field, const Vector3d& from, const Vector3d& to) {
  constexpr int kSteps = 20;
  Proxy proxy;
  Contact contact;
  for (int k = 0; k <= kSteps; ++k) {
    const Vector3d hand = from + (to - from) * k / kSteps;
    field.update(k * 1e-3, hand, proxy);
    contact = proxy.step(field, hand, 1e-3);
  }
  return contact.touching;
}

/// Pokes from z = depth to -depth / 3 that pass; `step`: between them, m.
int passes(SceneField& field, double x0, double x1, double y1, double step, double depth) {
  int passed = 0;
  for (double x = x0; x <= x1; x += step) {
    for (double y = -y1; y <= y1; y += step) {
      passed += stops(field, {x, y, depth}, {x, y, -depth / 3}) ? 0 : 1;
    }
  }
  return passed;
}

TEST(NoHoles, RoundNearDuplicates) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  for (const int count : {1, 4, 9, 20, 60}) {
    for (const double size : {2e-5, 2e-4}) {
      Sheet sheet;
      sheet.add(-0.1, 0.1, -0.1, 0.1, 0.01);
      sheet.add_cluster(count, size);
      Scene scene;
      scene.add("sheet", sheet.cloud());
      SceneField field(scene);
      EXPECT_EQ(passes(field, -0.03, 0.03, 0.03, 2.5e-3, 0.03), 0) << count << " in " << size;
    }
  }
}

TEST(NoHoles, WhereDensityChangesAtOnce) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  for (const int ratio : {2, 3, 4, 6, 8, 12}) {
    const double fine = 1e-3;
    Sheet sheet;
    sheet.add(-0.02, 0, -0.04, 0.04, fine);
    sheet.add(0, 0.08, -0.04, 0.04, ratio * fine);
    Scene scene;
    scene.add("sheet", sheet.cloud());
    SceneField field(scene);
    EXPECT_EQ(passes(field, -0.01, 0.06, 0.02, 2e-3, 0.03), 0) << "1:" << ratio;
  }
}

TEST(NoHoles, InASphereOfRandomPoints) {
  constexpr double kSphere = 0.06;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  PointCloud cloud;
  for (int i = 0; i < 8000; ++i) cloud.positions.push_back((kSphere * direction()).cast<float>());
  Scene scene;
  scene.add("sphere", cloud);
  SceneField field(scene);
  int passed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d ray = direction();
    passed += stops(field, 0.08 * ray, 0.055 * ray) ? 0 : 1;
  }
  EXPECT_EQ(passed, 0);
}

/// A sphere of 60 mm as two layers `apart` (spacings of 3 mm), each with half of its points.
PointCloud thinned_layers(double apart, std::mt19937& random) {
  constexpr double kSphere = 0.06;
  constexpr double kSpacing = 3e-3;
  constexpr int kCount = 5027;  // 4 pi kSphere^2 / kSpacing^2
  std::normal_distribution<double> off(0, 0.2 * kSpacing / kSphere);
  PointCloud cloud;
  for (int i = 0; i < 2 * kCount; ++i) {
    if (random() % 2 == 0) continue;
    const double z = 1 - (i % kCount * 2 + 1.0) / kCount;
    const double around = 2.39996 * i;  // the golden angle
    const double across = std::sqrt(1 - z * z);
    const Vector3d place(across * std::cos(around) + off(random),
                         across * std::sin(around) + off(random), z + off(random));
    const double layer = i < kCount ? -0.5 : 0.5;
    const Vector3d p = (kSphere + layer * apart * kSpacing) * place.normalized();
    cloud.positions.push_back(p.cast<float>());
  }
  return cloud;
}

TEST(NoHoles, InAShellOfTwoThinnedLayersAndItLetsGo) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  for (const double apart : {0.5, 1.0, 1.5, 2.0, 3.0}) {
    Scene scene;
    scene.add("shell", thinned_layers(apart, random));
    SceneField field(scene);
    Proxy proxy;
    for (int poke = 0; poke < 20; ++poke) {
      const Vector3d ray = direction();
      for (int k = 0; k <= 200; ++k) {  // from 80 mm to 50 mm and out to 100 mm
        const Vector3d hand = (k < 60 ? 0.08 - 0.5e-3 * k : 0.05 + (k - 60) * 0.357e-3) * ray;
        if (k == 0) proxy.reset(hand);
        field.update(1e-3 * k, hand, proxy);
        const Contact contact = proxy.step(field, hand, 1e-3);
        const bool inside = k == 60;
        if (!inside && k < 200) continue;
        EXPECT_EQ(contact.touching, inside) << apart << " spacings, poke " << poke;
      }
    }
  }
}

TEST(NoHoles, UnderAHandThatJumpedToJustOffTheSurface) {
  constexpr double kSphere = 0.05;
  constexpr int kPoints = 12000;
  PointCloud cloud;
  for (int i = 0; i < kPoints; ++i) {
    const double z = 1 - (2 * i + 1.0) / kPoints;
    const double turn = 2.399963229728653 * i;
    const Vector3d flat(std::cos(turn), std::sin(turn), 0);
    cloud.positions.push_back(
        (kSphere * (std::sqrt(1 - z * z) * flat + Vector3d(0, 0, z))).cast<float>());
  }
  Scene scene;
  const Source& sphere = scene.add("sphere", cloud);
  SceneField field(scene);
  const double radius = sphere.report().radius;
  int passed = 0;
  for (int i = 0; i < kPoints; i += 60) {
    const Vector3d place = cloud.point(static_cast<std::size_t>(i));
    const Vector3d out = (i % 120 == 0 ? 1 : -1) * place.normalized();
    Proxy proxy;
    Contact contact;
    proxy.reset(place + 5 * radius * out);
    for (const double height : {5.0, 0.003, -5.0, -5.0}) {  // R
      const Vector3d hand = place + height * radius * out;
      field.update(0, hand, proxy);
      contact = proxy.step(field, hand, 1e-3);
    }
    passed += contact.touching ? 0 : 1;
  }
  EXPECT_EQ(passed, 0);
}

}  // namespace
}  // namespace palpate
