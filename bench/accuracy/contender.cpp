// Makes the contenders of table A, their scenes and their traces.
#include "accuracy/contender.hpp"

#include "palpate/scene/scene_field.hpp"

namespace palpate::accuracy {
namespace {

constexpr double kForEver = 1e6;  // s; judgement: longer than any run

ProxyOptions proxy_options(ProxyOptions::Method method) {
  ProxyOptions options;
  options.stiffness = kStiffness;
  options.method = method;
  return options;
}

Contender ours(std::string name, FieldOptions::Kind kind, const PrepareOptions& prepare) {
  FieldOptions field;
  field.kind = kind;
  return {std::move(name), false, prepare, field, proxy_options(ProxyOptions::Method::converged)};
}

Contender papers(std::string name, FieldOptions::Kind kind) {
  PrepareOptions prepare;
  prepare.paper = true;
  return {std::move(name), false, prepare, paper_field(kind),
          proxy_options(ProxyOptions::Method::single_step)};
}

Contender organised() {
  Contender contender = ours(kOrganised, FieldOptions::Kind::balanced, {});
  contender.organised = true;
  return contender;
}

void record(Trace& trace, const Contact& contact, const Eigen::Vector3d& hip) {
  trace.proxy.push_back(contact.proxy);
  // Not contact.force: that may be faded, and what is scored is the raw K (p - h).
  trace.force.push_back(kStiffness * (contact.proxy - hip));
}

}  // namespace

std::vector<Contender> all_contenders(const PrepareOptions& prepare) {
  return {organised(),
          ours(kUnorganised, FieldOptions::Kind::balanced, prepare),
          ours("pointset", FieldOptions::Kind::pointset, prepare),
          ours("metaball", FieldOptions::Kind::metaball, prepare),
          papers("paper pointset", FieldOptions::Kind::pointset),
          papers("paper metaball", FieldOptions::Kind::metaball)};
}

std::unique_ptr<Scene> make_scene(const DepthFrame& frame, const TruthScene& truth,
                                  const Contender& contender) {
  auto scene = std::make_unique<Scene>();
  SourceOptions options;
  options.T_world_sensor = truth.camera.T_world_camera;
  options.prepare = contender.prepare;
  options.policy.fit_everywhere = true;  // no tool has said yet where it is
  options.policy.silence = kForEver;
  if (contender.organised) {
    scene->add("frame", options).push(frame, [] { return -1.0; });
  } else {
    scene->add("frame", back_project(frame), options);
  }
  return scene;
}

Trace rendered_trace(Scene& scene, const Contender& contender, const Path& path) {
  Trace trace;
  SceneField field(scene, contender.field);
  Proxy proxy(contender.proxy);
  proxy.reset(path.hip.front());
  for (std::size_t i = 0; i < path.hip.size(); ++i) {
    field.update(static_cast<double>(i) * kTick, path.hip[i], proxy);
    record(trace, proxy.step(field, path.hip[i], kTick), path.hip[i]);
  }
  return trace;
}

Trace rendered_trace(const Field& field, const ProxyOptions& options, const Path& path) {
  Trace trace;
  Proxy proxy(options);
  proxy.reset(path.hip.front());
  for (const Eigen::Vector3d& hip : path.hip) {
    record(trace, proxy.step(field, hip, kTick), hip);
  }
  return trace;
}

}  // namespace palpate::accuracy
