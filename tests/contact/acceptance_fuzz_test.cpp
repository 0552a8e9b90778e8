// docs/method.md 10: a random hand on point surfaces: never NaN, inside, or on the wrong
// side.
#include <gtest/gtest.h>

#include "palpate/contact/proxy.hpp"
#include "support/effort.hpp"
#include "support/kind_name.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"
#include "support/random_hand.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

struct FuzzScene {
  const char* name;
  std::vector<TestPoint> points;
  double size;  // the hand stays within about this, m
  bool open;    // it has two sides to be on
  // Where a proxy is as geometry sees it, touching or not: +1, -1, or 0 where that cannot be told.
  int (*stands)(const Contact& contact);
};

// Far enough from noisy points for the height alone to tell the side, m.
constexpr double kClear = 0.0035;

int outside_ball(const Contact& contact) {
  return contact.proxy.norm() > 0.03 - 0.002 ? 1 : -1;
}

int faces(const Contact& contact) {
  const double up = contact.touching ? contact.normal.z() / 0.5 : contact.proxy.z() / kClear;
  if (std::abs(up) < 1) return 0;
  return up > 0 ? 1 : -1;
}

// Between the sheets of a plate a hand may rightly go from one to the other.
int outside_plate(const Contact& contact) {
  if (contact.touching) {
    const int side = faces(contact);
    return side * (contact.proxy.z() + 0.004) > 0 ? side : 0;
  }
  if (contact.proxy.z() > kClear) return 1;
  return contact.proxy.z() < -0.008 - kClear ? -1 : 0;
}

/// On which side of the surface a proxy was last, whether it touched there or not.
class SideKeeper {
 public:
  explicit SideKeeper(const FuzzScene& scene) : scene_(scene) {}

  /// Is the proxy on another side without having gone round the rim, or inside a ball?
  [[nodiscard]] bool wrong(const Contact& contact) {
    const int stands = scene_.stands(contact);
    if (!scene_.open) return stands < 0;
    if (contact.proxy.head<2>().cwiseAbs().maxCoeff() > 0.018) {
      last_ = 0;
      return false;
    }
    const bool crossed = stands * last_ < 0;
    if (stands != 0) last_ = stands;
    return crossed;
  }

 private:
  const FuzzScene& scene_;
  int last_ = 0;
};

std::vector<FuzzScene> fuzz_scenes() {
  const Sampling clean;
  const Sampling noisy{.jitter = 0.2, .noise = 0.25, .tilt = 0.1};
  return {{"sphere", ball(clean, 0.03), 0.045, false, outside_ball},
          {"noisy_sphere", ball(noisy, 0.03), 0.045, false, outside_ball},
          {"sheet", sheet(noisy, 0.03), 0.045, true, faces},
          {"plate", plate(noisy, 0.03, 0.008), 0.045, true, outside_plate}};
}

struct FuzzTally {
  int touching = 0;
  int inside = 0;
  int wrong_side = 0;
  int not_finite = 0;
  int lost = 0;
  int unfinished = 0;
  int most_evaluations = 0;
  long evaluations = 0;
  double deepest = 0;  // of R
};

void check(const Field& field, const Contact& contact, FuzzTally& tally) {
  tally.evaluations += contact.evaluations;
  tally.most_evaluations = std::max(tally.most_evaluations, contact.evaluations);
  if (!contact.force.allFinite() || !contact.proxy.allFinite()) ++tally.not_finite;
  if (has(contact.notes, ContactNote::lost)) ++tally.lost;
  if (has(contact.notes, ContactNote::not_converged)) ++tally.unfinished;
  if (!contact.touching) return;
  ++tally.touching;
  const Sample here = field.sample(contact.proxy);
  const double depth = -here.value / std::max(here.gradient.norm(), 1e-9) / here.radius;
  tally.deepest = std::max(tally.deepest, depth);
  if (depth > 0.002) ++tally.inside;
}

using FuzzCase = std::tuple<int, FieldOptions::Kind>;
class AcceptanceFuzz : public testing::TestWithParam<FuzzCase> {};

TEST_P(AcceptanceFuzz, NeverNaNNeverInsideNeverOnTheWrongSide) {
  const auto& [index, kind] = GetParam();
  const FuzzScene scene = fuzz_scenes()[static_cast<std::size_t>(index)];
  PointField points(scene.points, {.kind = kind});
  RandomHand hand(7 * static_cast<unsigned>(index) + static_cast<unsigned>(kind), scene.size);
  Proxy proxy;
  proxy.reset({0, 0, 2 * scene.size});
  FuzzTally tally;
  SideKeeper sides(scene);
  const int ticks = effort(60000);
  for (int i = 0; i < ticks; ++i) {
    const Vector3d hip = hand.next();
    const Field& field = points.at(hip, proxy);
    const Contact contact = proxy.step(field, hip, kTick);
    check(field, contact, tally);
    if (sides.wrong(contact)) ++tally.wrong_side;
  }
  RecordProperty("touching", tally.touching);
  RecordProperty("lost", tally.lost);
  RecordProperty("unfinished", tally.unfinished);
  RecordProperty("most_evaluations", tally.most_evaluations);
  RecordProperty("mean_evaluations", std::to_string(double(tally.evaluations) / ticks));
  RecordProperty("deepest_R", std::to_string(tally.deepest));
  RecordProperty("wrong", tally.wrong_side);
  EXPECT_EQ(tally.not_finite, 0);
  EXPECT_EQ(tally.inside, 0);
  EXPECT_EQ(tally.wrong_side, 0);
  EXPECT_GT(tally.touching, ticks / 20);
  EXPECT_LE(tally.most_evaluations, proxy.max_evaluations());
}

std::string fuzz_name(const testing::TestParamInfo<FuzzCase>& tested) {
  const auto& [index, kind] = tested.param;
  return std::string(fuzz_scenes()[static_cast<std::size_t>(index)].name) + "_" + kind_name(kind);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AcceptanceFuzz,
                         testing::Combine(testing::Range(0, 4),
                                          testing::Values(FieldOptions::Kind::metaball,
                                                          FieldOptions::Kind::pointset,
                                                          FieldOptions::Kind::balanced)),
                         fuzz_name);

}  // namespace
}  // namespace palpate::test
