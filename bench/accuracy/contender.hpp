#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accuracy/score.hpp"
#include "accuracy/truth_frame.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::accuracy {

/// One way from a raw frame to a force.
struct Contender {
  std::string name;
  bool organised = false;  ///< as a depth frame, through the depth filter; else as points
  PrepareOptions prepare;
  FieldOptions field;
  ProxyOptions proxy;
};

/// Names of palpate's defaults: for depth frames, and for unorganised points.
inline constexpr const char* kOrganised = "organised";
inline constexpr const char* kUnorganised = "balanced";

/// palpate's default for depth frames, its default for unorganised points and its other two fields,
/// prepared alike, then the paper's two surfaces under the preset `paper`. `prepare` is where those
/// for points start from.
[[nodiscard]] std::vector<Contender> all_contenders(const PrepareOptions& prepare = {});

/// A scene with the one frame in it, seen by the scene's camera, prepared as the contender says.
[[nodiscard]] std::unique_ptr<Scene> make_scene(const DepthFrame& frame, const TruthScene& truth,
                                                const Contender& contender);

/// The trace of the contender's proxy on a path.
[[nodiscard]] Trace rendered_trace(Scene& scene, const Contender& contender, const Path& path);

/// The same for any field that needs no update, such as an analytic one.
[[nodiscard]] Trace rendered_trace(const Field& field, const ProxyOptions& options,
                                   const Path& path);

}  // namespace palpate::accuracy
