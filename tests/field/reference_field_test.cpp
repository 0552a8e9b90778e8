// The reference field against central differences, and the scene's field against the reference.
#include "support/reference_field.hpp"

#include <gtest/gtest.h>

#include <random>

#include "palpate/scene/scene_field.hpp"
#include "support/known_edges.hpp"
#include "support/make_points.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

class Reference : public testing::TestWithParam<FieldOptions::Kind> {};

TEST_P(Reference, GradientAgreesWithCentralDifferences) {
  SurfacePoints sharp = make_points(wavy_sheet(1, 0.2));
  draw_edges(sharp, 5);
  const SurfacePoints& first = sharp;
  const SurfacePoints second = make_points(wavy_sheet(2, 0.2));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const auto& sources : {std::vector{&first}, std::vector{&first, &second}}) {
    const ReferenceField front(sources, {.kind = GetParam()});
    const ReferenceField back(sources, {.kind = GetParam()}, -1);
    for (int i = 0; i < 100; ++i) {
      const ReferenceField& field = i % 2 == 0 ? front : back;
      const Vector3d x(0.03 * uniform(random), 0.03 * uniform(random), 0.009 * uniform(random));
      const Vector3d gradient = field.sample(x).gradient;
      constexpr double kStep = 1e-7;
      Vector3d difference;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = kStep * Vector3d::Unit(axis);
        difference[axis] =
            (field.sample(x + step).value - field.sample(x - step).value) / (2 * kStep);
      }
      EXPECT_LT((difference - gradient).norm(), 1e-5 * std::max(1.0, gradient.norm()));
    }
  }
}

void expect_same(const Sample& fast, const Sample& slow, const Vector3d& x) {
  if (slow.support <= 0) {
    EXPECT_GT(fast.value, 0);
    EXPECT_EQ(fast.support, 0);
    return;
  }
  EXPECT_NEAR(fast.value, slow.value, 1e-10) << x.transpose();
  EXPECT_NEAR(fast.support, slow.support, 1e-10) << x.transpose();
  EXPECT_LT((fast.gradient - slow.gradient).norm(), 1e-7 * std::max(1.0, slow.gradient.norm()))
      << x.transpose();
  EXPECT_NEAR(fast.radius, slow.radius, 1e-10) << x.transpose();
}

TEST_P(Reference, SceneFieldSaysTheSame) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const Kernel kernel : {Kernel::wyvill, Kernel::wendland}) {
    for (const int sources : {1, 3}) {
      Scene scene;
      std::vector<std::shared_ptr<const SurfacePoints>> kept;
      std::vector<const SurfacePoints*> all;
      for (int s = 0; s < sources; ++s) {
        SurfacePoints points = make_points(wavy_sheet(10 + static_cast<unsigned>(s), 0.3), kernel);
        if (s % 2 == 0) draw_edges(points, static_cast<unsigned>(s));
        kept.push_back(std::make_shared<SurfacePoints>(std::move(points)));
        all.push_back(kept.back().get());
        auto snapshot = std::make_unique<Snapshot>();
        snapshot->layers.push_back({kept.back()});
        scene.add(std::to_string(s)).publish(std::move(snapshot));
      }
      const FieldOptions options{.kind = GetParam(), .kernel = kernel};
      for (const int side : {1, -1}) {
        const ReferenceField slow(all, options, side);
        SceneField fast(scene, options);
        fast.update_from(0, Vector3d::Zero(), Vector3d(0, 0, 8e-3 * side));
        for (int i = 0; i < 150; ++i) {
          const Vector3d x(0.04 * uniform(random), 0.04 * uniform(random), 0.02 * uniform(random));
          expect_same(fast.sample(x), slow.sample(x), x);
          const Ball ball{x, 0.003 * (1 + uniform(random))};
          EXPECT_EQ(fast.is_free(ball), slow.is_free(ball)) << x.transpose();
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Reference,
                         testing::Values(FieldOptions::Kind::balanced, FieldOptions::Kind::pointset,
                                         FieldOptions::Kind::metaball));

}  // namespace
}  // namespace palpate::test
