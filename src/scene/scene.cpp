#include "palpate/scene/scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "palpate/base/error.hpp"
#include "scene/source_inside.hpp"

namespace palpate {

Source& Scene::add(std::string name, const SourceOptions& options) {
  if (sources_.size() == kMaxSources) {
    throw Error(fmt::format("cannot add '{}': a scene holds {} sources; merge some clouds first",
                            name, kMaxSources));
  }
  if (*fields_ > 0) {
    throw Error(fmt::format(
        "cannot add '{}': the scene is already in use; add sources before creating fields", name));
  }
  const bool taken =
      std::ranges::any_of(sources_, [&](const Source& source) { return source.name() == name; });
  if (taken)
    throw Error(
        fmt::format("the scene already has a source named '{}'; choose another name", name));
  if (!seams_) seams_ = std::make_shared<Seams>();
  Source& source = sources_.emplace_back(std::move(name), options);
  source.inside_->seams = seams_;
  source.inside_->place = sources_.size() - 1;
  return source;
}

Source& Scene::add(std::string name, const PointCloud& cloud, const SourceOptions& options) {
  Source& source = add(std::move(name), options);
  try {
    source.set(cloud);
  } catch (...) {
    sources_.pop_back();
    throw;
  }
  return source;
}

SourceState Scene::state(std::size_t i) const {
  SourceState state = source(i).state();
  const auto own = source(i).points();
  for (std::size_t k = 0; own && k < size(); ++k) {
    const auto other = k == i ? nullptr : source(k).points();
    if (!other) continue;
    const std::optional<double> found = disagreement(*own, *other);
    if (found) state.disagreement = std::max(*found, state.disagreement.value_or(0));
  }
  return state;
}

}  // namespace palpate
