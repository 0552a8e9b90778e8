// The converged proxy against the exact god-object of shapes whose closest point is known.
#include <gtest/gtest.h>

#include <random>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kClosestStiffness = 500;
const ProxyOptions kFine{
    .stiffness = kClosestStiffness, .max_iterations = 200, .tangent_tolerance = 1e-5};

void expect_force(const Contact& contact, const Vector3d& closest, const Vector3d& hip,
                  double tolerance) {
  EXPECT_TRUE(contact.touching);
  EXPECT_LT((contact.force - kClosestStiffness * (closest - hip)).norm(), tolerance);
  EXPECT_LT((contact.proxy - closest).norm(), tolerance / kClosestStiffness);
}

TEST(ClosestPoint, PlaneGivesKTimesDepthToMachinePrecision) {
  const PlaneField plane;
  Proxy proxy;
  proxy.reset({0, 0, 0.02});
  drive(proxy, plane, {0, 0, 0.02}, {0, 0, -0.003}, 0.1, [](const Vector3d& hip, const Contact& c) {
    EXPECT_NEAR(c.force.z(), std::max(0.0, -kClosestStiffness * hip.z()), 1e-12);
    EXPECT_EQ(c.force.head<2>().norm(), 0);
    EXPECT_EQ(c.touching, hip.z() <= 0) << hip.z();
  });
}

TEST(ClosestPoint, FollowsTheHandAlongThePlane) {
  const PlaneField plane;
  Proxy proxy;
  proxy.reset({0, 0, 0.01});
  drive(proxy, plane, {0, 0, 0.01}, {0, 0, -0.003}, 0.1);
  drive(proxy, plane, {0, 0, -0.003}, {0.05, 0.02, -0.003}, 0.2,
        [](const Vector3d& hip, const Contact& c) {
          expect_force(c, {hip.x(), hip.y(), 0}, hip, 1e-10);
          EXPECT_LE(c.evaluations, 3);
        });
}

TEST(ClosestPoint, CreepingHandFeelsNoDeadZone) {
  const PlaneField plane;
  Proxy proxy;
  proxy.reset({0, 0, 0.01});
  drive(proxy, plane, {0, 0, 0.01}, {0, 0, -0.003}, 0.1);
  // 3 um a step: a third of 1e-3 R, where a plain tolerance would hold on and jump.
  drive(proxy, plane, {0, 0, -0.003}, {0.001, 0, -0.003}, 0.003,
        [](const Vector3d&, const Contact& c) {
          EXPECT_LT(std::abs(c.force.x()), 1.01e-4 * 0.01 * kClosestStiffness);
        });
}

TEST(ClosestPoint, Sphere) {
  const double rho = 0.04;
  const SphereField sphere(rho);
  Proxy proxy{kFine};
  proxy.reset({0, 0, 0.06});
  drive(proxy, sphere, {0, 0, 0.06}, {0.001, 0.002, 0.037}, 0.1);
  drive(proxy, sphere, {0.001, 0.002, 0.037}, {0.03, 0.01, 0.01}, 0.2,
        [&](const Vector3d& hip, const Contact& c) {
          expect_force(c, rho * hip.normalized(), hip, 2e-4);
        });
  const Vector3d hip(0.03, 0.01, 0.01);
  expect_force(rest(proxy, sphere, hip), rho * hip.normalized(), hip, 2e-5);
}

TEST(ClosestPoint, Torus) {
  const TorusField torus(0.06, 0.02);
  Proxy proxy{kFine};
  const auto closest = [](const Vector3d& hip) {
    const Vector3d ring = 0.06 * Vector3d(hip.x(), hip.y(), 0).normalized();
    return Vector3d(ring + 0.02 * (hip - ring).normalized());
  };
  const Vector3d first(0.06, 0, 0.015);
  const Vector3d second(0.04, 0.04, 0.013);
  proxy.reset({0.06, 0, 0.05});
  drive(proxy, torus, {0.06, 0, 0.05}, first, 0.1);
  drive(proxy, torus, first, second, 0.2,
        [&](const Vector3d& hip, const Contact& c) { expect_force(c, closest(hip), hip, 1e-3); });
  expect_force(rest(proxy, torus, second), closest(second), second, 2e-5);
}

TEST(ClosestPoint, BoxFaceStaysUnderTheHandUpToTheEdge) {
  const BoxField box({0.1, 0.1, 0.1});
  Proxy proxy;
  proxy.reset({0, 0, 0.06});
  drive(proxy, box, {0, 0, 0.06}, {0, 0, 0.046}, 0.1);
  drive(proxy, box, {0, 0, 0.046}, {0.0455, 0.02, 0.046}, 0.1,
        [](const Vector3d& hip, const Contact& c) {
          expect_force(c, {hip.x(), hip.y(), 0.05}, hip, 1e-10);
        });
}

TEST(ClosestPoint, PastTheEdgeTheHandLeavesTheBox) {
  const BoxField box({0.1, 0.1, 0.1});
  Proxy proxy;
  proxy.reset({0, 0, 0.06});
  drive(proxy, box, {0, 0, 0.06}, {0, 0, 0.047}, 0.1);
  const Contact last = drive(proxy, box, {0, 0, 0.047}, {0.06, 0, 0.047}, 0.1);
  EXPECT_FALSE(last.touching);
  EXPECT_EQ(last.force.norm(), 0);
  EXPECT_EQ((last.proxy - Vector3d(0.06, 0, 0.047)).norm(), 0);
}

TEST(ClosestPoint, ConcaveBowlConvergesDeeperThanItsRadius) {
  const double rho = 0.01;
  const BowlField bowl(rho);
  Proxy proxy{kFine};
  proxy.reset({0, 0, 0});
  // Depth 3 rho: the plain tangent iteration oscillates here (factor -d / rho).
  drive(proxy, bowl, {0, 0, 0}, {0, 0, -0.04}, 0.1);
  const Vector3d hip(0.02, 0.01, -0.034);
  drive(proxy, bowl, {0, 0, -0.04}, hip, 0.2, [&](const Vector3d& h, const Contact& c) {
    expect_force(c, rho * h.normalized(), h, 0.05);
  });
  expect_force(rest(proxy, bowl, hip), rho * hip.normalized(), hip, 5e-3);
}

class Wedge : public testing::TestWithParam<double> {};

TEST_P(Wedge, ConvergesIntoTheCreaseAndStaysOutside) {
  const double angle = GetParam();  // between the walls, rad
  AnalyticField::Options floor_options;
  AnalyticField::Options wall_options;
  wall_options.T_world_shape.rotate(Eigen::AngleAxisd(M_PI - angle, Vector3d::UnitY()));
  const PlaneField floor(floor_options);
  const PlaneField wall(wall_options);
  const UnionField wedge({&floor, &wall});
  Proxy proxy;
  const Vector3d middle = Vector3d(std::cos(angle / 2), 0, std::sin(angle / 2));
  proxy.reset(0.03 * middle);
  drive(proxy, wedge, 0.03 * middle, -0.004 * middle, 0.1,
        [&](const Vector3d&, const Contact& c) { EXPECT_GT(wedge.sample(c.proxy).value, -2e-5); });
  const Contact last = rest(proxy, wedge, -0.004 * middle);
  expect_force(last, Vector3d::Zero(), -0.004 * middle, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Angles, Wedge, testing::Values(M_PI / 4, M_PI / 3, M_PI / 2, 0.75 * M_PI));

TEST(ClosestPoint, ReleasesExactlyWhenTheHandLeaves) {
  const SphereField sphere(0.04);
  Proxy proxy;
  proxy.reset({0, 0, 0.06});
  drive(proxy, sphere, {0, 0, 0.06}, {0, 0, 0.035}, 0.1);
  drive(proxy, sphere, {0, 0, 0.035}, {0, 0, 0.05}, 0.037,
        [](const Vector3d& hip, const Contact& c) {
          EXPECT_EQ(c.touching, hip.norm() < 0.04) << hip.norm();
          EXPECT_GE(c.force.z(), 0);
        });
}

TEST(ClosestPoint, ThinBoxStopsAHandAtTwoMetresPerSecond) {
  for (const double thickness : {1e-4, 5e-4, 2e-3}) {
    const BoxField plate({0.2, 0.2, thickness});
    for (int phase = 0; phase < 20; ++phase) {
      const Vector3d from(0.01, 0.02, 0.0201 + 1e-4 * phase);
      Proxy proxy;
      proxy.reset(from);
      const Contact last = drive(proxy, plate, from, from - Vector3d(0, 0, 0.04), 2.0);
      EXPECT_TRUE(last.touching);
      EXPECT_GT(last.force.z(), 8);
      EXPECT_NEAR(last.proxy.z(), 0.5 * thickness, 1e-7);
    }
  }
}

TEST(ClosestPoint, SingleStepFollowsThePlane) {
  const PlaneField plane;
  Proxy proxy{{.method = ProxyOptions::Method::single_step}};
  proxy.reset({0, 0, 0.01});
  drive(proxy, plane, {0, 0, 0.01}, {0, 0, -0.003}, 0.1);
  drive(proxy, plane, {0, 0, -0.003}, {0.05, 0.02, -0.003}, 0.2,
        [](const Vector3d& hip, const Contact& c) {
          EXPECT_LE(c.iterations, 1);
          expect_force(c, {hip.x(), hip.y(), 0}, hip, 1e-10);
        });
  EXPECT_FALSE(drive(proxy, plane, {0.05, 0.02, -0.003}, {0.05, 0.02, 0.003}, 0.2).touching);
}

TEST(ClosestPoint, SingleStepLagsOnASphereWhereConvergedDoesNot) {
  const SphereField sphere(0.04);
  const auto worst = [&](ProxyOptions::Method method) {
    Proxy proxy{{.method = method}};
    proxy.reset({0, 0, 0.06});
    drive(proxy, sphere, {0, 0, 0.06}, {0, 0, 0.03}, 0.1);
    double error = 0;
    drive(proxy, sphere, {0, 0, 0.03}, {0.03, 0, 0.005}, 1.0,
          [&](const Vector3d& h, const Contact& c) {
            error =
                std::max(error, (c.force - kClosestStiffness * (0.04 * h.normalized() - h)).norm());
          });
    return error;
  };
  EXPECT_LT(worst(ProxyOptions::Method::converged), 0.02);
  EXPECT_GT(worst(ProxyOptions::Method::single_step), 0.05);
}

TEST(ClosestPoint, FreeSpaceFarFromEverythingCostsOneBallTest) {
  const SphereField sphere(0.04);
  Proxy proxy;
  proxy.reset({0, 0, 0.3});
  rest(proxy, sphere, {0, 0, 0.3}, 10);  // until it knows that it is in open air
  drive(proxy, sphere, {0, 0, 0.3}, {0.1, 0.2, 0.3}, 1.0,
        [](const Vector3d& hip, const Contact& c) {
          EXPECT_EQ(c.evaluations, 1);
          EXPECT_EQ((c.proxy - hip).norm(), 0);
        });
}

}  // namespace
}  // namespace palpate::test
