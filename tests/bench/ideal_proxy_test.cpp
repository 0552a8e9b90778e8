#include "accuracy/ideal_proxy.hpp"

#include <gtest/gtest.h>

#include "accuracy/contender.hpp"
#include "accuracy/rows.hpp"
#include "palpate/field/field.hpp"

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

// The exact signed distance as a Field: the errors with it are the proxy's and the bench's own.
class TruthField final : public Field {
 public:
  explicit TruthField(const TruthScene& scene) : scene_(&scene) {}

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const Distance found = distance_and_normal(*scene_, x);
    return {found.value, found.gradient, 1, kScale};
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return distance_and_normal(*scene_, ball.center).value > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d& /*x*/) const noexcept override { return {}; }
  [[nodiscard]] Traits traits() const noexcept override {
    Traits traits;
    traits.resolution = 0.002 * kScale;
    return traits;
  }

 private:
  static constexpr double kScale = 0.01;  // m, that steps are measured in; judgement

  const TruthScene* scene_;
};

TEST(IdealProxy, RestsAtTheClosestPointOfAPlane) {
  const TruthScene scene = make_truth_scene();
  const Vector3d c = scene.slide_center;
  IdealProxy proxy(scene, c + Vector3d(0, 0, 0.01));
  proxy.follow(c + Vector3d(0.02, 0.01, -0.003));
  EXPECT_LT((proxy.position() - (c + Vector3d(0.02, 0.01, 0))).norm(), 1e-7);
  proxy.follow(c + Vector3d(0.02, 0.01, 0.004));
  EXPECT_LT((proxy.position() - (c + Vector3d(0.02, 0.01, 0.004))).norm(), 1e-7);
}

TEST(IdealProxy, LiesOverTheHandOnASphere) {
  const TruthScene scene = make_truth_scene();
  const Vector3d middle = scene.solids[kSphere].T_world_solid.translation();
  const Vector3d up = Vector3d(-0.5, 0.2, 1).normalized();
  IdealProxy proxy(scene, middle + 0.07 * Vector3d::UnitZ());
  proxy.follow(middle + 0.057 * Vector3d::UnitZ());
  proxy.follow(middle + 0.057 * up);
  EXPECT_LT((proxy.position() - (middle + 0.060 * up)).norm(), 1e-6);
}

TEST(IdealProxy, StaysInTheCreaseAndBeforeThePlate) {
  const TruthScene scene = make_truth_scene();
  int rows = 0;
  for (const Row& row : make_rows(scene)) {
    if (row.name != "crease 10 mm" && row.name != "thin push") continue;
    ++rows;
    const Trace trace = ideal_trace(scene, row.paths.front());
    double largest = 0;
    for (std::size_t i = 0; i < trace.proxy.size(); ++i) {
      EXPECT_GT(distance_and_normal(scene, trace.proxy[i]).value, -1e-9);
      largest = std::max(largest, trace.force[i].norm());
    }
    // 10 mm into both walls of the crease; 30 mm past the plate's face.
    EXPECT_NEAR(largest, row.name == "thin push" ? 15.0 : 7.0711, 1e-3) << row.name;
  }
  EXPECT_EQ(rows, 2);
}

TEST(IdealProxy, LeavesTheBoxAtItsEdge) {
  const TruthScene scene = make_truth_scene();
  const std::vector<Row> rows = make_rows(scene);
  ASSERT_FALSE(rows[3].paths.empty());
  for (const Path& path : rows[3].paths) {
    const Trace trace = ideal_trace(scene, path);
    EXPECT_NEAR(trace.force[path.begin].norm(), 1.5, 1e-3);
    EXPECT_NEAR(trace.force[path.begin + 900].norm(), 1.5, 1e-3);
    EXPECT_EQ(trace.force[path.end - 1].norm(), 0);
  }
}

// What the bench measures with the truth for a field is its own error and the proxy's.
TEST(IdealProxy, AgreesWithTheProxyOnTheExactField) {
  const TruthScene scene = make_truth_scene();
  const TruthField field(scene);
  int rows = 0;
  for (const Row& row : make_rows(scene)) {
    if (row.name != "plane slide" && row.name != "sphere slide" && row.name != "fast tap" &&
        row.name != "thin push") {
      continue;
    }
    Scorer scorer;
    const Path& path = row.paths.front();
    scorer.add(path, ideal_trace(scene, path), rendered_trace(field, {}, path), scene);
    const Score score = scorer.score();
    EXPECT_LT(score.normal, 0.2) << row.name;
    EXPECT_LT(score.force, 0.006) << row.name;
    // The push turns a corner, and so does its force.
    EXPECT_LT(score.ripple, row.name == "thin push" ? 0.01 : 0.002) << row.name;
    EXPECT_LT(std::abs(score.height), 0.002) << row.name;
    EXPECT_EQ(score.lost, 0) << row.name;
    EXPECT_EQ(score.pops, 0) << row.name;
    ++rows;
  }
  EXPECT_EQ(rows, 4);
}

}  // namespace
}  // namespace palpate::accuracy
