#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accuracy/score.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::accuracy {

/// One way from a raw frame to a force.
struct Contender {
  std::string name;
  PrepareOptions prepare;
  FieldOptions field;
  ProxyOptions proxy;
};

/// palpate's default for unorganised points and its other two fields, prepared alike, then the
/// paper's two surfaces under the preset `paper`. `prepare` is where the first three start from.
[[nodiscard]] std::vector<Contender> all_contenders(const PrepareOptions& prepare = {});

/// A scene with the one cloud in it, seen by the scene's camera.
[[nodiscard]] std::unique_ptr<Scene> make_scene(const PointCloud& cloud, const TruthScene& truth,
                                                const PrepareOptions& prepare);

/// What the contender's proxy does on a path.
[[nodiscard]] Trace rendered_trace(Scene& scene, const Contender& contender, const Path& path);

/// The same for any field that needs no update, such as TruthField.
[[nodiscard]] Trace rendered_trace(const Field& field, const ProxyOptions& options,
                                   const Path& path);

}  // namespace palpate::accuracy
