#include "viewer/cloud_painter.hpp"

#include <utility>

#include "viewer/cloud_of.hpp"
#include "viewer/thinned.hpp"

namespace palpate::viewer {
namespace {

/// Has nothing confirmed the surface for so long that it cannot be felt any more? A cloud that was
/// set and not pushed stands still.
bool faded(const SourceState& state, double now) {
  return state.frames > 0 && now > state.silent_from + state.fade;
}

}  // namespace

std::vector<PaintedCloud> CloudPainter::paint(const std::set<std::size_t>& budgets, double now) {
  std::vector<std::shared_ptr<const SurfacePoints>> newest(sources_.size());
  std::vector<std::size_t> sizes(sources_.size());
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const SourceState state = scene_.source(s).state();
    newest[s] = scene_.source(s).points();
    Known& known = sources_[s];
    const bool gone = faded(state, now);
    if (known.points.lock() != newest[s] || known.frames != state.frames || known.faded != gone) {
      known = {newest[s], state.frames, gone, {}};
    }
    if (gone) newest[s] = nullptr;
    sizes[s] = newest[s] ? newest[s]->size() : 0;
  }
  std::vector<PaintedCloud> clouds;
  std::vector<std::set<std::size_t>> used(sources_.size());
  for (const std::size_t budget : budgets) {
    const std::vector<std::size_t> parts = shares(sizes, budget);
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      SharedBytes& bytes = sources_[s].painted[parts[s]];
      if (!bytes) bytes = paint(s, newest[s].get(), parts[s]);
      used[s].insert(parts[s]);
      clouds.push_back({s, budget, bytes});
    }
  }
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    std::erase_if(sources_[s].painted,
                  [&](const auto& entry) { return !used[s].contains(entry.first); });
  }
  return clouds;
}

SharedBytes CloudPainter::paint(std::size_t source, const SurfacePoints* points,
                                std::size_t share) const {
  CloudMessage message;
  if (points != nullptr) message = cloud_of(*points, origin_, share);
  message.source = static_cast<std::uint8_t>(source);
  message.stamp = scene_.source(source).state().stamp;
  return std::make_shared<const std::string>(encode(message));
}

}  // namespace palpate::viewer
