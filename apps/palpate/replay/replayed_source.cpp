#include "apps/palpate/replay/replayed_source.hpp"

#include <optional>
#include <vector>

#include "apps/palpate/record/options_json.hpp"
#include "palpate/base/error.hpp"
#include "scene/source_trace.hpp"

namespace palpate::app {

ReplayedSource::ReplayedSource(const std::string& path, const Json& json, std::size_t index,
                               Scene& scene, const bag::McapReader& reader)
    : frames_(path, reader, json.at("topic").get<std::string>()) {
  from_.plan.argument.name = json.at("name").get<std::string>();
  take_exact(json.at("options"), from_.plan.options);
  from_.plan.as_cloud = json.at("as_cloud").get<bool>();
  source_ = &scene.add(from_.plan.argument.name, from_.plan.options);
  lives_ = json.at("lives").get<bool>();
  if (!lives_) show_surface(reader, index, json, *source_);
}

bool ReplayedSource::push_until(std::uint64_t publication) {
  while (done_ < publication) {
    if (!lives_ || !push_next()) return false;
  }
  return SourceTrace(*source_).publications() == done_;
}

void ReplayedSource::widen(double least_radius) {
  SourceTrace(*source_).impose_least_radius(least_radius);
}

bool ReplayedSource::push_next() {
  const std::optional<RecordedFrame> frame = frames_.next();
  if (!frame || frame->use.gap) return false;
  do_again(*frame);
  return true;
}

void ReplayedSource::do_again(const RecordedFrame& recorded) {
  const message::FrameUse& use = recorded.use;
  done_ = use.publication;
  if (!use.options.empty()) {
    SourceOptions options;
    take_exact(Json::parse(use.options), options);
    source_->change(options);
  }
  if (use.dropped) return;
  std::vector<Reach> reach;
  for (std::size_t i = 0; i + 3 < use.reach.size(); i += 4) {
    reach.push_back({Eigen::Vector3d(use.reach.data() + i), use.reach[i + 3]});
  }
  SourceTrace(*source_).impose_reach(reach);
  if (use.kind == "end") return source_->keep();
  try {
    push_frame(from_, *source_, recorded.frame, [&] { return use.start; });
  } catch (const Error&) {
    if (use.why_not.empty()) throw;  // else it was refused in the run, too
  }
}

}  // namespace palpate::app
