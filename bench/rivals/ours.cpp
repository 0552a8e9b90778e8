// Makes methods of palpate's own surfaces and proxies.
#include "rivals/ours.hpp"

#include <optional>

#include "palpate/scene/scene_field.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

class Ours final : public Rival {
 public:
  explicit Ours(const accuracy::Contender& contender)
      : contender_(contender), proxy_(contender.proxy) {}

  void show(const Shown& shown) override {
    field_.reset();
    if (shown.frame != nullptr) {
      accuracy::TruthScene seen;
      seen.camera.T_world_camera = *shown.frame->T_world_sensor;
      scene_ = accuracy::make_scene(*shown.frame, seen, contender_);
    } else {
      SourceOptions options;
      options.prepare = contender_.prepare;
      scene_ = std::make_unique<Scene>();
      scene_->add("cloud", *shown.cloud, options);
    }
    field_.emplace(*scene_, contender_.field);
  }

  void reset(const Vector3d& hip) override {
    field_.emplace(*scene_, contender_.field);
    proxy_ = Proxy(contender_.proxy);
    proxy_.reset(hip);
    now_ = 0;
  }

  Step step(const Vector3d& hip) override {
    field_->update(now_, hip, proxy_);
    now_ += accuracy::kTick;
    return spring(proxy_.step(*field_, hip, accuracy::kTick).proxy, hip);
  }

 private:
  accuracy::Contender contender_;
  std::unique_ptr<Scene> scene_;
  std::optional<SceneField> field_;
  Proxy proxy_;
  double now_ = 0;
};

}  // namespace

std::unique_ptr<Rival> make_rival(const accuracy::Contender& contender) {
  return std::make_unique<Ours>(contender);
}

}  // namespace palpate::rivals
