// The proxy on clouds that went through preparation: the whole way from points to a force.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "palpate/contact/proxy.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"
#include "support/kind_name.hpp"
#include "support/point_shapes.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

PointCloud cloud_of(const std::vector<TestPoint>& points) {
  PointCloud cloud;
  for (const TestPoint& p : points) cloud.positions.push_back(p.position.cast<float>());
  return cloud;
}

/// A prepared cloud, its field and a proxy on it.
struct Touch {
  Touch(const PointCloud& cloud, const SourceOptions& source, const FieldOptions& field_options,
        const ProxyOptions& proxy_options, const Vector3d& start)
      : scene(make(cloud, source)), field(*scene, field_options), proxy(proxy_options) {
    proxy.reset(start);
  }

  Contact step(const Vector3d& hip) {
    field.update(0, hip, proxy);
    return proxy.step(field, hip, kTick);
  }

  static std::unique_ptr<Scene> make(const PointCloud& cloud, const SourceOptions& source) {
    auto scene = std::make_unique<Scene>();
    scene->add("cloud", cloud, source);
    return scene;
  }

  std::unique_ptr<Scene> scene;
  SceneField field;
  Proxy proxy;
};

SourceOptions seen_from(const Vector3d& viewpoint) {
  SourceOptions options;
  options.prepare.viewpoint = viewpoint;
  options.prepare.voxel = 0.0;
  return options;
}

TEST(AcceptanceScan, PlaneGivesKTimesDepthAndMu) {
  Touch touch(cloud_of(sheet({.jitter = 0.2}, 0.06)), seen_from({0, 0, 1}), {},
              {.friction = {.static_coefficient = 0.4, .dynamic_coefficient = 0.4}},
              {-0.02, 0, 0.03});
  for (int i = 0; i <= 330; ++i) (void)touch.step({-0.02, 0, 0.03 - 1e-4 * i});
  EXPECT_NEAR(touch.step({-0.02, 0, -0.003}).force.z(), 1.5, 1e-3);
  Contact c;
  for (int i = 0; i <= 400; ++i) c = touch.step({-0.02 + 1e-4 * i, 0, -0.003});
  EXPECT_NEAR(c.force.head<2>().norm() / c.force.z(), 0.4, 0.004);
}

struct Walk {
  int touching = 0;
  int inside = 0;
  int not_finite = 0;
  long evaluations = 0;
  int most_evaluations = 0;
  double given = 0;  // J
};

/// The hand goes round in circles that tumble and drift through the cloud's box.
Walk walk(Touch& touch, const Vector3d& center, double size, int ticks, double speed) {
  Walk result;
  Vector3d last_hip = touch.proxy.position();
  Vector3d last_force = Vector3d::Zero();
  double angle = 0;
  for (int i = 0; i < ticks; ++i) {
    angle += speed * kTick / (0.5 * size);
    const Vector3d axis(std::sin(0.13 * angle), std::cos(0.17 * angle), std::sin(0.11 * angle + 1));
    const Eigen::AngleAxisd turn(angle, axis.normalized());
    const Vector3d hip =
        center + turn * Vector3d(0.45 * size * (1 + 0.3 * std::sin(0.07 * angle)), 0, 0.1 * size);
    const Contact c = touch.step(hip);
    result.given += 0.5 * (c.force + last_force).dot(hip - last_hip);
    result.evaluations += c.evaluations;
    result.most_evaluations = std::max(result.most_evaluations, c.evaluations);
    if (!c.force.allFinite()) ++result.not_finite;
    last_hip = hip;
    last_force = c.force;
    if (!c.touching) continue;
    ++result.touching;
    const Sample here = touch.field.sample(c.proxy);
    if (here.value < -0.002 * here.radius * here.gradient.norm()) ++result.inside;
  }
  return result;
}

void record(const Walk& result, int ticks, const std::string& name) {
  testing::Test::RecordProperty(name + "_mean_evaluations",
                                std::to_string(static_cast<double>(result.evaluations) / ticks));
  testing::Test::RecordProperty(name + "_most_evaluations", result.most_evaluations);
  testing::Test::RecordProperty(name + "_touching", result.touching);
  testing::Test::RecordProperty(name + "_given_mJ", std::to_string(1e3 * result.given));
}

class Bunny : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("PALPATE_DATA");
    if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
    path_ = std::filesystem::path(data) / "stanford_bunny/bun_zipper_res2.ply";
    if (!std::filesystem::exists(path_)) GTEST_SKIP() << path_ << " is absent";
    cloud_ = read_cloud_file(path_).cloud;
  }
  std::filesystem::path path_;
  PointCloud cloud_;
};

TEST_F(Bunny, IsExploredWithoutEnteringIt) {
  const Vector3d center(-0.017, 0.1, 0);
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::metaball}) {
    Touch touch(cloud_, {}, {.kind = kind}, {}, {0.2, 0.1, 0});
    const int ticks = effort(30000);
    const Walk result = walk(touch, center, 0.16, ticks, 0.3);
    record(result, ticks, kind_name(kind));
    EXPECT_EQ(result.not_finite, 0);
    EXPECT_EQ(result.inside, 0);
    EXPECT_GT(result.touching, ticks / 50);  // a short walk has its approach in it
    EXPECT_LE(result.given, 0.05e-3);
  }
}

TEST_F(Bunny, IsExploredThePapersWay) {
  SourceOptions source;
  source.prepare.paper = true;
  for (const FieldOptions::Gradient gradient :
       {FieldOptions::Gradient::exact, FieldOptions::Gradient::normal,
        FieldOptions::Gradient::printed}) {
    FieldOptions options =
        paper_field(gradient == FieldOptions::Gradient::normal ? FieldOptions::Kind::pointset
                                                               : FieldOptions::Kind::metaball);
    options.gradient = gradient;
    Touch touch(cloud_, source, options, {.method = ProxyOptions::Method::single_step},
                {0.2, 0.1, 0});
    const int ticks = effort(10000);
    const Walk result = walk(touch, {-0.017, 0.1, 0}, 0.12, ticks, 0.3);
    record(result, ticks, "gradient_" + std::to_string(static_cast<int>(gradient)));
    EXPECT_EQ(result.not_finite, 0);
    EXPECT_GT(result.touching, 0);
  }
}

}  // namespace
}  // namespace palpate::test
