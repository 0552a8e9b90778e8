// A store of points is felt as the cloud that it holds, whatever little of it is in memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/on_demand.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/made_store.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kRoom = std::size_t{64} << 20U;  // bytes, more than the clouds here have

double height(double x, double y) {
  return 0.03 * std::sin(9 * x) * std::cos(7 * y);
}

/// Hills over the unit square; `spacing_at` says how far apart points are.
PointCloud hills(const std::function<double(double, double)>& spacing_at) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  PointCloud cloud;
  cloud.origin = {100, 200, 0};
  for (double x = 0; x < 1; x += 1. / 500) {
    for (double y = 0; y < 1; y += 1. / 500) {
      const double spacing = 500 * spacing_at(x, y);
      if (share(random) > 1 / (spacing * spacing)) continue;
      const double a = x + 2e-4 * share(random);
      const double b = y + 2e-4 * share(random);
      cloud.positions.push_back(Vector3d(a, b, height(a, b)).cast<float>());
    }
  }
  return cloud;
}

PointCloud even() {
  return hills([](double, double) { return 1. / 500; });
}

/// A store on demand in blocks a fifth of it wide, beside the same points prepared as a whole.
struct Paged {
  explicit Paged(PointCloud cloud, std::size_t memory = kRoom, const SourceOptions& given = {})
      : store(std::make_shared<MadeStore>(std::move(cloud))), options(given) {
    options.prepare.facts = measure_facts(*store, options.prepare, options.T_world_sensor);
    options.prepare.facts->radius = std::min(0.2 / 96, options.prepare.facts->radius);
    demand = std::make_unique<OnDemand>(store, options.prepare, options.T_world_sensor, memory);
    source = &scene.add("part", options);
    while (!source->points()) demand->advance(*source, 0);
    whole.add("whole", store->whole(), options);
    field.emplace(scene);
  }

  /// Moves a hand there and waits until nothing is left to do.
  void go(const Vector3d& place) {
    for (int k = 0; k < 200; ++k) {
      field->update(time += 1e-3, place, place);
      while (demand->advance(*source, time)) field->update(time += 1e-3, place, place);
    }
  }

  /// The force on a hand that presses 2 mm in.
  Contact press(SceneField& at, const Vector3d& place) {
    const Vector3d up = options.T_world_sensor.linear() * Vector3d::UnitZ();
    Proxy proxy;
    proxy.reset(place + 0.01 * up);
    Contact contact;
    for (int k = 0; k < 20; ++k) {
      const Vector3d hip = place + (0.01 - 0.012 * k / 19) * up;
      at.update(time += 1e-3, hip, proxy.position());
      contact = proxy.step(at, hip, 1e-3);
    }
    return contact;
  }

  /// Presses at drawn places; forces are those of the whole, bit for bit.
  void expect_whole(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.02, 0.98);
    std::size_t touched = 0;
    for (int k = 0; k < 12; ++k) {
      const double x = share(random);
      const double y = share(random);
      const Vector3d place = options.T_world_sensor * Vector3d(100 + x, 200 + y, height(x, y));
      go(place);
      SceneField all(whole);
      const Contact expected = press(all, place);
      touched += expected.touching ? 1 : 0;
      SceneField some(scene);
      EXPECT_EQ(press(some, place).force, expected.force) << x << ' ' << y;
      EXPECT_FALSE(has(some.notes(), FieldNote::not_loaded)) << x << ' ' << y;
    }
    EXPECT_GE(touched, 10u);
  }

  std::shared_ptr<MadeStore> store;
  SourceOptions options;
  Scene scene;
  Scene whole;
  Source* source = nullptr;
  std::unique_ptr<OnDemand> demand;
  std::optional<SceneField> field;
  double time = 1;
};

TEST(Store, IsFeltAsTheWholeOfItsPoints) {
  Paged paged(even());
  paged.expect_whole(1);
}

TEST(Store, IsFeltAsTheWholeWherePointsAreMuchSparser) {
  PointCloud cloud = hills(
      [](double x, double y) { return std::hypot(x - 0.5, y - 0.5) < 0.25 ? 1. / 500 : 1. / 25; });
  for (const double z : {0.2, 0.4, -0.3}) {
    cloud.positions.push_back(Vector3d(0.3, 0.7, z).cast<float>());  // strays
  }
  Paged paged(std::move(cloud));
  paged.expect_whole(2);
}

TEST(Store, IsFeltAsTheWholeWhereverItIsPut) {
  SourceOptions options;
  options.T_world_sensor = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  options.T_world_sensor.pretranslate(Vector3d(5, -3, 2));
  options.prepare.clip = Box{{100.01, 200, -1}, {100.99, 201, 1}};
  Paged paged(even(), kRoom, options);
  paged.expect_whole(3);
}

TEST(Store, WithLittleMemoryItIsReadMoreOften) {
  Paged enough(even());
  Paged little(even(), std::size_t{2} << 20U);
  enough.expect_whole(4);
  little.expect_whole(4);
  EXPECT_EQ(little.demand->share(), 1);  // of what there is memory for
  EXPECT_GT(little.store->reads(), enough.store->reads());
}

TEST(Store, WhatIsNotReadYetIsFreeAndSaysSo) {
  Paged paged(even());
  const Vector3d far(100.05, 200.05, height(0.05, 0.05));
  EXPECT_FALSE(paged.press(*paged.field, far).touching);
  EXPECT_TRUE(has(paged.field->notes(), FieldNote::not_loaded));
}

TEST(Store, AllOfItIsSeenThinned) {
  SourceOptions options;
  options.T_world_sensor.translation() = Vector3d(0, 0, 7);
  Paged paged(even(), kRoom, options);
  const auto overview = paged.source->state().overview;
  ASSERT_TRUE(overview);
  EXPECT_GT(overview->size(), 20'000u);
  Box box;
  for (std::size_t i = 0; i < overview->size(); ++i) box.extend(overview->point(i));
  EXPECT_LT((box.lower - Vector3d(100, 200, 6.97)).norm(), 0.01);
  EXPECT_LT((box.upper - Vector3d(101, 201, 7.03)).norm(), 0.01);
}

TEST(Store, NothingIsDoneWhileAHandRests) {
  Paged paged(even());
  const Vector3d place(100.5, 200.5, height(0.5, 0.5));
  paged.go(place);
  const std::size_t reads = paged.store->reads();
  const auto points = paged.source->points();
  paged.go(place);
  EXPECT_EQ(paged.store->reads(), reads);
  EXPECT_EQ(paged.source->points(), points);
  EXPECT_FALSE(paged.demand->done());
  EXPECT_EQ(paged.demand->share(), 1);
}

/// A hand in free air far above everything, where no block has a point.
TEST(Store, FarFromAllPointsThereIsNothingToFeel) {
  Paged paged(even());
  const Vector3d place(100.5, 200.5, 0.8);
  paged.go(place);
  EXPECT_EQ(paged.press(*paged.field, place).force, Vector3d::Zero());
  EXPECT_FALSE(has(paged.field->notes(), FieldNote::not_loaded));
  paged.go({100.5, 200.5, height(0.5, 0.5)});
  EXPECT_TRUE(paged.press(*paged.field, {100.5, 200.5, height(0.5, 0.5)}).touching);
}

/// In the cube of the surface, but farther from its points than what is prepared around a tool.
TEST(Store, InTheAirHighAboveASurfaceAllIsKnown) {
  Paged paged(even());
  paged.go({100.3, 200.3, 0.14});
  paged.field->update(paged.time += 1e-3, {100.3, 200.3, 0.14}, {100.3, 200.3, 0.14});
  EXPECT_FALSE(has(paged.field->notes(), FieldNote::not_loaded));
}

TEST(Store, ABlockUnderAHandIsKeptHoweverLittleMemoryThereIs) {
  Paged paged(even(), 1);
  const Vector3d place(100.3, 200.3, 0.14);
  std::size_t steps = 0;
  for (int k = 0; k < 100; ++k) {
    paged.field->update(paged.time += 1e-3, place, place);
    steps += paged.demand->advance(*paged.source, paged.time, false) ? 1 : 0;
  }
  EXPECT_LT(steps, 20u);
  EXPECT_FALSE(has(paged.field->notes(), FieldNote::not_loaded));
}

TEST(Store, ASurfaceThatArrivesUnderAHandPushesNobody) {
  Paged paged(even());
  const Vector3d hip(100.05, 200.05, height(0.05, 0.05) - 3e-3);
  Proxy proxy;
  proxy.reset(hip);
  double largest = 0;
  bool came = false;
  for (int k = 0; k < 2000; ++k) {
    paged.field->update(paged.time += 1e-3, hip, proxy.position());
    largest = std::max(largest, proxy.step(*paged.field, hip, 1e-3).force.norm());
    came = came || !has(paged.field->notes(), FieldNote::not_loaded);
    if (k % 20 == 0) paged.demand->advance(*paged.source, paged.time);
  }
  EXPECT_TRUE(came);
  EXPECT_LT(largest, 0.05);  // N
}

/// A run begins with another source than the one that was shown the first blocks, and with a hand.
TEST(Store, WhatIsFirstShownToAHandRises) {
  Paged paged(even());
  Scene scene;
  Source& source = scene.add("run", paged.options);
  SceneField field(scene);
  const Vector3d hip(100.05, 200.05, height(0.05, 0.05) - 3e-3);
  field.update(paged.time, hip, hip);
  while (!source.points()) paged.demand->advance(source, paged.time);
  const std::vector<float>& presences = source.points()->presences;
  EXPECT_EQ(std::ranges::min(presences), 0) << "what is around the hand";
  EXPECT_EQ(std::ranges::max(presences), 1) << "what was shown before";
}

/// Says that it has more points than any block may have.
class VastStore final : public PointStore {
 public:
  VastStore() {
    layout_.edge = 1;
    layout_.points = std::size_t{1} << 30U;
    layout_.nodes = {{0, {0, 0, 0}, layout_.points}};
  }
  [[nodiscard]] const Layout& layout() const override { return layout_; }
  [[nodiscard]] PointCloud read(std::size_t) const override {
    PointCloud cloud;
    cloud.positions = {{0.5F, 0.5F, 0.5F}};
    return cloud;
  }

 private:
  Layout layout_;
};

TEST(Store, ABlockThatWouldTakeAllMemoryIsRefused) {
  SourceOptions options;
  options.prepare.facts = CloudFacts{};
  options.prepare.facts->radius = 1;
  options.prepare.facts->extent = {{0, 0, 0}, {1, 1, 1}};
  OnDemand demand(std::make_shared<VastStore>(), options.prepare, options.T_world_sensor, kRoom);
  Scene scene;
  Source& source = scene.add("vast", options);
  try {
    demand.advance(source, 0);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("give a smaller radius"), std::string::npos);
  }
}

TEST(Store, WhatNeedsAllOfItIsRefused) {
  const auto store = std::make_shared<MadeStore>(even());
  PrepareOptions options;
  options.paper = true;
  EXPECT_THROW(OnDemand(store, options, Eigen::Isometry3d::Identity(), kRoom), Error);
}

TEST(Store, ADamagedNodeIsToldAndWhatIsThereStays) {
  Paged paged(even());
  const auto points = paged.source->points();
  paged.store->on_read = [] { throw std::runtime_error("damaged"); };
  EXPECT_THROW(paged.go({100.05, 200.05, 0}), std::runtime_error);
  EXPECT_EQ(paged.source->points(), points);
}

}  // namespace
}  // namespace palpate
