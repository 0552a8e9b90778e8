// Chooses the points of each source that a page draws, and encodes them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "field/formulas.hpp"
#include "geometry/elements_at.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/radii.hpp"
#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {

namespace {

constexpr std::size_t kOverviewShare = 4;  // of what is drawn, at least one in so many; judgement

// An index in a stretch that repeats from call to call and has no rhythm that a scan's rows could
// have, too.
std::uint64_t scattered(std::uint64_t i) {
  std::uint64_t x = (i + 1) * 0x9E3779B97F4A7C15u;
  x ^= x >> 31;
  x *= 0xBF58476D1CE4E5B9u;
  return x ^ (x >> 29);
}

/// Indices of the points that have not faded away, in the grid's order.
std::vector<std::uint32_t> felt(const SurfacePoints& points) {
  const auto& weights = newest(points.density_weights, points.end_density_weights);
  const auto& presences = newest(points.presences, points.end_presences);
  std::vector<std::uint32_t> found;
  found.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const bool weighs = weights.empty() || weights[i] > 0;
    if (weighs && (presences.empty() || presences[i] > 0)) found.push_back(i);
  }
  return found;
}

/// Has nothing confirmed the surface for so long that it cannot be felt any more? A cloud that was
/// set and not pushed stands still.
bool faded(const Source::State& state, double now) {
  return state.frames > 0 && now > state.silent_from + state.fade;
}

/// The density weight of a point whose R is kUsualMultiple spacings: of a plane, where weights sum
/// up to the kernel's mean over its disc for each point in that (docs/method.md 2.2).
double usual_weight(Kernel kernel) {
  return 1 / (plane_integral(kernel) * kUsualMultiple * kUsualMultiple);
}

/// How large points are drawn, m: R, or where they lie more densely than R requires,
/// kUsualMultiple spacings.
std::vector<float> drawn_radii(const SurfacePoints& points) {
  std::vector<float> radii = newest(points.radii, points.end_radii);
  const auto& weights = newest(points.density_weights, points.end_density_weights);
  const double usual = usual_weight(points.kernel);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    radii[i] *= static_cast<float>(std::min(1.0, std::sqrt(weights[i] / usual)));
  }
  return radii;
}

/// The same of points without measured radii, by their own spacings.
std::vector<float> drawn_radii(const PointCloud& cloud, const std::vector<std::uint32_t>& kept) {
  const CellGrid grid(detail::elements_at(cloud.positions, kept));
  const std::vector<float> spacings = local_spacings(grid);
  std::vector<float> radii(kept.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    radii[grid.order()[i]] = kUsualMultiple * spacings[i];
  }
  return radii;
}

/// Adds points that are seen and cannot be felt here: as ones of trust 0.
void add_overview(const PointCloud& overview, const std::vector<std::uint32_t>& kept,
                  const Eigen::Vector3d& origin, CloudMessage& message) {
  constexpr std::array<std::uint8_t, 3> kGrey{128, 128, 128};
  const Eigen::Vector3f shift = (overview.origin - origin).cast<float>();
  const bool coloured =
      message.positions.empty() ? !overview.colors.empty() : !message.colors.empty();
  for (const std::uint32_t i : kept) {
    message.positions.emplace_back(overview.positions[i] + shift);
    message.trust.push_back(0);
    if (!message.normals.empty()) message.normals.emplace_back(Eigen::Vector3f::Zero());
    if (!coloured) continue;
    message.colors.push_back(overview.colors.empty() ? kGrey : overview.colors[i]);
  }
}

// count * part / all, rounded down; also where std::size_t has 32 bits, as in WebAssembly.
std::size_t part_of(std::size_t count, std::uint64_t part, std::uint64_t all) {
  return static_cast<std::size_t>(count * part / all);
}

}  // namespace

std::vector<std::uint32_t> thinned(std::size_t count, std::size_t budget) {
  std::vector<std::uint32_t> kept(std::min(count, budget));
  if (kept.size() == count) {
    std::iota(kept.begin(), kept.end(), 0u);
    return kept;
  }
  for (std::size_t i = 0; i < budget; ++i) {
    const std::size_t begin = part_of(count, i, budget);
    const std::size_t end = part_of(count, i + 1, budget);
    kept[i] = static_cast<std::uint32_t>(begin + scattered(i) % (end - begin));
  }
  return kept;
}

std::vector<std::size_t> shares(const std::vector<std::size_t>& sizes, std::size_t budget) {
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  if (all <= budget) return sizes;
  std::vector<std::size_t> parts;
  for (const std::size_t size : sizes) parts.push_back(part_of(size, budget, all));
  return parts;
}

CloudMessage cloud_of(const SurfacePoints& points, const Eigen::Vector3d& origin,
                      std::size_t budget) {
  const std::vector<std::uint32_t> shown = felt(points);
  const std::vector<std::uint32_t> kept = thinned(shown.size(), budget);
  const auto& normals = newest(points.normals, points.end_normals);
  const auto& confidences = newest(points.confidences, points.end_confidences);
  const Eigen::Vector3f shift = (points.origin - origin).cast<float>();
  CloudMessage message;
  const std::vector<float> radii = drawn_radii(points);
  // What is left of a thinned cloud covers as much.
  const float wider = std::sqrt(static_cast<float>(shown.size()) / static_cast<float>(kept.size()));
  message.radii.reserve(kept.size());
  message.positions.reserve(kept.size());
  message.trust.reserve(kept.size());
  if (!normals.empty()) message.normals.reserve(kept.size());
  if (!points.colors.empty()) message.colors.reserve(kept.size());
  for (const std::uint32_t k : kept) {
    const std::uint32_t i = shown[k];
    const Eigen::Vector3f& position =
        points.end_positions.empty() ? points.grid.points()[i] : points.end_positions[i];
    message.positions.emplace_back(position + shift);
    message.radii.push_back(wider * radii[i]);
    if (!normals.empty()) message.normals.push_back(normals[i]);
    message.trust.push_back(static_cast<std::uint8_t>(std::lround(255 * confidences[i])));
    if (!points.colors.empty()) message.colors.push_back(points.colors[i]);
  }
  return message;
}

std::vector<EncodedCloud> CloudEncoder::encode(const std::set<std::size_t>& budgets, double now) {
  std::vector<std::shared_ptr<const SurfacePoints>> newest(sources_.size());
  std::vector<std::size_t> sizes(sources_.size());
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const Source::State state = scene_.source(s).state();
    newest[s] = scene_.source(s).points();
    Encoded& last = sources_[s];
    const bool gone = faded(state, now);
    if (last.points.lock() != newest[s] || last.frames != state.frames || last.faded != gone) {
      last = {newest[s], state.frames, gone, {}};
    }
    sizes[s] = newest[s] ? newest[s]->size() : 0;
    if (newest[s] && state.overview) sizes[s] += state.overview->size();
  }
  std::vector<EncodedCloud> clouds;
  std::vector<std::set<std::size_t>> used(sources_.size());
  for (const std::size_t budget : budgets) {
    const std::vector<std::size_t> parts = shares(sizes, budget);
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      SharedBytes& bytes = sources_[s].encoded[parts[s]];
      if (!bytes) bytes = encode(s, newest[s].get(), parts[s]);
      used[s].insert(parts[s]);
      clouds.push_back({s, budget, bytes});
    }
  }
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    std::erase_if(sources_[s].encoded,
                  [&](const auto& entry) { return !used[s].contains(entry.first); });
  }
  return clouds;
}

SharedBytes CloudEncoder::encode(std::size_t source, const SurfacePoints* points,
                                 std::size_t share) {
  CloudMessage message;
  const Source::State state = scene_.source(source).state();
  const std::size_t left = share - std::min(share, points != nullptr ? points->size() : 0);
  const std::size_t far =
      state.overview ? std::min(std::max(share / kOverviewShare, left), state.overview->size()) : 0;
  if (points != nullptr) message = cloud_of(*points, origin_, share - far);
  if (points != nullptr && far > 0) {
    Overview& overview = overviews_[source];
    if (overview.cloud.lock() != state.overview || overview.kept.size() != far) {
      overview = {state.overview, thinned(state.overview->size(), far), {}};
      overview.radii = drawn_radii(*state.overview, overview.kept);
    }
    add_overview(*state.overview, overview.kept, origin_, message);
    message.radii.insert(message.radii.end(), overview.radii.begin(), overview.radii.end());
  }
  message.source = static_cast<std::uint8_t>(source);
  message.stamp = state.stamp;
  message.faded = sources_[source].faded;
  return std::make_shared<const std::string>(viewer::encode(message));
}

}  // namespace palpate::viewer
