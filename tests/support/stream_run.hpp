#pragma once

#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate::test {

/// A source whose camera is at `pose` and that fits all of each frame.
inline SourceOptions fitted_from(const Eigen::Isometry3d& pose) {
  SourceOptions options;
  options.T_world_sensor = pose;
  options.policy.fit_everywhere = true;
  return options;
}

/// A frame that becomes ready at a time, and what is to be done with it then.
struct Arrives {
  double time = 0;  ///< s
  std::function<void()> act;
};

/// Simulated time: frames arrive, and a servo looks at the scene every millisecond.
class StreamRun {
 public:
  explicit StreamRun(Scene& scene, const ProxyOptions& proxy = {}, const FieldOptions& field = {})
      : field_(scene, field), proxy_(proxy) {}

  /// `time` never falls from call to call.
  void at(double time, std::function<void()> act) { arriving_.push_back({time, std::move(act)}); }

  /// Steps until `end`, s; `hand` gives the hand's place, `see` is shown every contact.
  void until(double end, const std::function<Eigen::Vector3d(double)>& hand,
             const std::function<void(double, const Contact&)>& see = {}) {
    for (; now_ < end - 1e-9; now_ = ++ticks_ * 1e-3) {
      while (!arriving_.empty() && arriving_.front().time <= now_) {
        arriving_.front().act();
        arriving_.pop_front();
      }
      const Eigen::Vector3d hip = hand(now_);
      field_.update(now_, hip, proxy_);
      const Contact contact = proxy_.step(field_, hip, 1e-3);
      if (see) see(now_, contact);
    }
  }

  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] SceneField& field() { return field_; }
  [[nodiscard]] const Proxy& proxy() const { return proxy_; }

 private:
  SceneField field_;
  Proxy proxy_;
  std::deque<Arrives> arriving_;
  double now_ = 0;
  long ticks_ = 0;
};

}  // namespace palpate::test
