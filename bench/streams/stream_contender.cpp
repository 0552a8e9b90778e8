// Sets up the ways to make surfaces of streams that are compared.
#include "streams/stream_contender.hpp"

#include "accuracy/path.hpp"

namespace palpate::streams {
namespace {

constexpr double kVoxel = 0.004;          // m
constexpr double kRadius = 0.010;         // m
constexpr double kFigureRadius = 0.0051;  // m

ProxyOptions proxy_options(ProxyOptions::Method method) {
  ProxyOptions options;
  options.stiffness = accuracy::kStiffness;
  options.method = method;
  return options;
}

Tool ours(std::string name, FieldOptions::Kind kind) {
  FieldOptions field;
  field.kind = kind;
  return {std::move(name), field, proxy_options(ProxyOptions::Method::converged)};
}

Tool papers(std::string name, FieldOptions::Kind kind) {
  return {std::move(name), paper_field(kind), proxy_options(ProxyOptions::Method::single_step)};
}

std::string with_history(const std::string& name, int history) {
  return name + ", N = " + std::to_string(history);
}

}  // namespace

std::vector<Tool> our_tools() {
  return {ours("metaball", FieldOptions::Kind::metaball),
          ours("pointset", FieldOptions::Kind::pointset),
          ours("balanced", FieldOptions::Kind::balanced)};
}

std::vector<Tool> paper_tools() {
  return {papers("metaball", FieldOptions::Kind::metaball),
          papers("pointset", FieldOptions::Kind::pointset)};
}

Contender morph() {
  Contender contender{"morph", {}, false, our_tools()};
  contender.source.policy.policy = Policy::morph;
  return contender;
}

Contender default_way() {
  return {"default", {}, false, {our_tools().back()}};
}

Contender of_clouds(Policy policy, int history) {
  Contender contender{"", {}, true, our_tools()};
  contender.source.policy.policy = policy;
  contender.source.policy.history = history;
  contender.source.prepare.voxel = kVoxel;
  contender.source.prepare.radius = kRadius;
  switch (policy) {
    case Policy::average:
      contender.name = with_history("average", history);
      break;
    case Policy::crossfade:
      contender.name = with_history("crossfade", history);
      break;
    default:
      contender.name = "replace";
      break;
  }
  return contender;
}

Contender papers_way(int history) {
  Contender contender = of_clouds(Policy::average, history);
  contender.name = with_history("the paper's", history);
  contender.tools = paper_tools();
  return contender;
}

Contender papers_figure(int history) {
  Contender contender = papers_way(history);
  contender.source.prepare.radius = kFigureRadius;
  return contender;
}

}  // namespace palpate::streams
