#include "palpate/scene/scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate {

Source& Scene::add(std::string name, const SourceOptions& options) {
  if (sources_.size() == kMaxSources) {
    throw Error(fmt::format("cannot add '{}': a scene holds {} sources; merge some clouds first",
                            name, kMaxSources));
  }
  const bool taken =
      std::ranges::any_of(sources_, [&](const Source& source) { return source.name() == name; });
  if (taken) throw Error(fmt::format("a source named '{}' is in the scene; choose another", name));
  return sources_.emplace_back(std::move(name), options);
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

}  // namespace palpate
