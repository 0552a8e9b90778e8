// Moves a proxy along a scene's path, on its cloud as a program would touch it and on the truth.
#include "any_cloud/bench_run.hpp"

#include "accuracy/path.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate::any_cloud {
namespace {

using accuracy::kTick;
using Eigen::Vector3d;

constexpr double kTruthStep = 0.5;  // s: its creases are sharper than those of points

class TruthField final : public AnalyticField {
 public:
  explicit TruthField(const HostileScene& scene)
      : AnalyticField({.T_world_shape = scene.T_world_draft,
                       .step_length = kTruthStep * scene.spacing,
                       .resolution = 0.005 * scene.spacing}),
        scene_(&scene) {}

 private:
  [[nodiscard]] Distance distance(const Vector3d& x) const noexcept override {
    Distance found = scene_->truth(x / scene_->spacing);
    found.value *= scene_->spacing;
    return found;
  }

  const HostileScene* scene_;
};

// `update` brings the field to a time, given hand and proxy.
template <typename Update>
Trace follow(const HostileScene& scene, const Field& field, Update update) {
  ProxyOptions options;
  options.stiffness = scene.stiffness;
  Proxy proxy(options);
  Trace trace;
  double now = 0;
  for (const HandTick& tick : scene.ticks) {
    if (tick.starts) proxy.reset(tick.hand);
    const double before = thread_cpu_seconds();
    update(now, tick.hand, proxy);
    const Contact contact = proxy.step(field, tick.hand, kTick);
    trace.microseconds.push_back(1e6 * (thread_cpu_seconds() - before));
    trace.force.push_back(contact.force);
    trace.proxy.push_back(contact.proxy);
    trace.fault.push_back(has(contact.notes, ContactNote::fault) || !contact.force.allFinite() ||
                          !contact.proxy.allFinite());
    now += kTick;
  }
  return trace;
}

}  // namespace

Rendered touch(const HostileScene& scene, const FieldOptions& options,
               const PrepareOptions& prepare) {
  Scene felt;
  const Source& source = felt.add("cloud", scene.cloud, {.prepare = prepare});
  SceneField field(felt, options);
  const auto update = [&](double now, const Vector3d& hand, const Proxy& proxy) {
    field.update(now, hand, proxy);
  };
  return {follow(scene, field, update), source.report()};
}

Trace touch_truth(const HostileScene& scene) {
  return follow(scene, TruthField(scene), [](double, const Vector3d&, const Proxy&) {});
}

}  // namespace palpate::any_cloud
