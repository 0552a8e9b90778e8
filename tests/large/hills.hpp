// A cloud of hills that is prepared while it is touched, and a hand that presses on it.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/on_demand.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {

inline double height(double x, double y) {
  return 0.03 * std::sin(9 * x) * std::cos(7 * y);
}

/// Hills over the unit square, `side` points along each of its sides.
inline std::shared_ptr<const PointCloud> hills(int side = 300) {
  std::mt19937 random(5);
  std::normal_distribution<double> error(0, 1);
  auto cloud = std::make_shared<PointCloud>();
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double x = (i + 0.1 * error(random)) / side;
      const double y = (j + 0.1 * error(random)) / side;
      cloud->positions.push_back(Eigen::Vector3d(x, y, height(x, y)).cast<float>());
    }
  }
  return cloud;
}

/// A cloud on demand as far as it comes at first: in blocks that are `wide`, m, or, without that,
/// in small ones until all of it is prepared together.
struct Begun {
  explicit Begun(const std::shared_ptr<const PointCloud>& cloud, SourceOptions given = {})
      : options(std::move(given)) {
    demand = std::make_unique<OnDemand>(cloud, options.prepare);
    begin();
  }

  Begun(const std::shared_ptr<const PointCloud>& cloud, double wide, SourceOptions given = {})
      : options(std::move(given)) {
    options.prepare.facts = measure_facts(*cloud, {});
    options.prepare.facts->radius = wide / 96;
    demand = std::make_unique<OnDemand>(cloud, options.prepare);
    begin();
  }

  void begin() {
    source = &scene.add("part", options);
    while (!source->points()) demand->advance(*source, 0);
  }

  SourceOptions options;
  Scene scene;
  Source* source = nullptr;
  std::unique_ptr<OnDemand> demand;
};

/// Lets a hand press at a place for 20 ms.
inline Contact press(SceneField& field, const Eigen::Vector3d& place, double depth, double time) {
  Proxy proxy;
  proxy.reset(place + Eigen::Vector3d(0, 0, 0.01));
  Contact contact;
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d hip = place + Eigen::Vector3d(0, 0, 0.01 - (0.01 + depth) * k / 19);
    field.update(time + 1e-3 * k, hip, proxy);
    contact = proxy.step(field, hip, 1e-3);
  }
  return contact;
}

}  // namespace palpate
