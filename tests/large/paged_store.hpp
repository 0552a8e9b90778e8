// A store on demand beside the same points prepared as a whole.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/on_demand.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/made_store.hpp"

namespace palpate {

using Eigen::Vector3d;

constexpr std::size_t kRoom = std::size_t{64} << 20U;  // bytes, more than the clouds here have

inline double hill_height(double x, double y) {
  return 0.03 * std::sin(9 * x) * std::cos(7 * y);
}

/// Hills over the unit square; `spacing_at` says how far apart points are.
inline PointCloud hill_cloud(const std::function<double(double, double)>& spacing_at) {
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
      cloud.positions.push_back(Vector3d(a, b, hill_height(a, b)).cast<float>());
    }
  }
  return cloud;
}

inline PointCloud even() {
  return hill_cloud([](double, double) { return 1. / 500; });
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
      field->update_from(time += 1e-3, place, place);
      while (demand->advance(*source, time)) field->update_from(time += 1e-3, place, place);
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
      at.update(time += 1e-3, hip, proxy);
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
      const Vector3d place = options.T_world_sensor * Vector3d(100 + x, 200 + y, hill_height(x, y));
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

}  // namespace palpate
