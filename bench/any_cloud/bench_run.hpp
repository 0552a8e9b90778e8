#pragma once

#include "any_cloud/hostile_scene.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate::any_cloud {

/// What a proxy did, tick by tick.
struct Trace {
  std::vector<Eigen::Vector3d> force;  ///< on the hand, N
  std::vector<Eigen::Vector3d> proxy;  ///< in the world
  std::vector<bool> fault;             ///< not finite, or the proxy said so
  std::vector<double> microseconds;    ///< computing time of the step
};

/// The cloud as a program would touch it: a Scene with one source, all defaults but these.
struct Rendered {
  Trace trace;
  Prepared::Report report;
};
/// @throws Error as prepare() does.
[[nodiscard]] Rendered touch(const HostileScene& scene, const FieldOptions& field,
                             const PrepareOptions& prepare = {});

/// The same proxy on the exact solid. Only where there is a truth.
[[nodiscard]] Trace touch_truth(const HostileScene& scene);

}  // namespace palpate::any_cloud
