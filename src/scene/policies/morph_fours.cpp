// Follows four points at a time: most blocks show what they showed before. Worth 16 to 29 % of a
// frame (bench/RESULTS.md).
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/policies/morph.hpp"

namespace palpate {
namespace {

// Closer than R by what rounding may do.
constexpr float kWithin2 = 0.98f;

template <class T, class Of>
Floats gather(const std::array<std::size_t, kLanes>& at, const T& column, const Of& of) {
  return Floats{of(column[at[0]]), of(column[at[1]]), of(column[at[2]]), of(column[at[3]])};
}

Vectors gather(const std::array<std::size_t, kLanes>& at,
               const std::vector<Eigen::Vector3f>& column) {
  return {gather(at, column, [](const auto& v) { return v.x(); }),
          gather(at, column, [](const auto& v) { return v.y(); }),
          gather(at, column, [](const auto& v) { return v.z(); })};
}

Floats gather(const std::array<std::size_t, kLanes>& at, const std::vector<float>& column) {
  return gather(at, column, [](float value) { return value; });
}

Floats mix_lanes(const Floats& a, const Floats& b, float u) {
  return a + u * (b - a);
}

Vectors mix_lanes(const Vectors& a, const Vectors& b, float u) {
  return a + (Floats{} + u) * (b - a);
}

Vectors mix_normal_lanes(const Vectors& a, const Vectors& b, float u) {
  const Vectors mixed = mix_lanes(a, b, u);
  Floats length = dot(mixed, mixed);
  for (int l = 0; l < kLanes; ++l) length[l] = std::sqrt(length[l]);
  const Vectors unit{mixed.x / length, mixed.y / length, mixed.z / length};
  return choose(length > 1e-6f, unit, a);
}

}  // namespace

void Morph::prefetch(const FilteredDepth& depth, std::size_t place) const {
  if (place + kLanes > order_.size()) return;
  for (std::size_t k = place; k < place + kLanes; k += 2) {  // two stand beside each other
    const std::size_t block = order_.blocks[k];
    __builtin_prefetch(&depth.positions[block]);
    __builtin_prefetch(&depth.normals[block]);
    __builtin_prefetch(&depth.confidences[block]);
    __builtin_prefetch(&depth.deviations[block]);
    surface_.prefetch(block);
    edges_.prefetch(block);
  }
}

Morph::Four Morph::new_points(const FilteredDepth& depth, std::size_t place) const {
  std::array<std::size_t, kLanes> at;
  Four four;
  for (std::size_t k = 0; k < kLanes; ++k) {
    at[k] = order_.blocks[std::min(place + k, order_.size() - 1)];
    four.edges[static_cast<int>(k)] = static_cast<std::int32_t>(edges_.number(at[k]));
  }
  four.position = turn_ * gather(at, depth.positions) + all_lanes(shift_);
  four.normal = turn_ * gather(at, depth.normals);
  four.radius = gather(at, surface_.radii());
  four.confidence = gather(at, depth.confidences);
  four.area = gather(at, surface_.areas());
  four.trust = streams_ ? gather(at, surface_.trusts()) : Floats{} + 1.0f;
  const Floats deviation = gather(at, depth.deviations);
  four.variance = deviation * deviation;
  four.place = static_cast<std::uint32_t>(place);
  return four;
}

Morph::Point Morph::point_of(const Four& seen, int l) {
  Point point;
  point.place = seen.place + static_cast<std::uint32_t>(l);
  if (!(seen.radius[l] > 0)) return point;
  point.state = {.position = seen.position.lane(l),
                 .normal = seen.normal.lane(l),
                 .radius = seen.radius[l],
                 .confidence = seen.confidence[l]};
  point.area = seen.area[l];
  point.trust = seen.trust[l];
  point.variance = seen.variance[l];
  point.state.weight = point.weight(point.state.radius);
  point.edge = static_cast<std::uint32_t>(seen.edges[l]);
  return point;
}

PointStates Morph::old_points(std::uint32_t i) const {
  const SurfacePoints& p = *last_;
  const Vectors shift = all_lanes(old_shift_);
  const bool fades = !p.presences.empty();
  const Floats whole = Floats{} + 1.0f;
  const auto end = [i](const auto& column) {
    __builtin_prefetch(&column[i] + 96);
    return load<Floats>(&column[i]);
  };
  __builtin_prefetch(&p.end_positions[i] + 96);
  __builtin_prefetch(&p.end_normals[i] + 96);
  if (progress_ >= 1) {
    return {load(&p.end_positions[i]) + shift,
            load(&p.end_normals[i]),
            end(p.end_density_weights),
            end(p.end_radii),
            end(p.end_confidences),
            fades ? end(p.end_presences) : whole};
  }
  const auto u = static_cast<float>(progress_);
  const auto between = [i, u](const auto& a, const auto& b) {
    return mix_lanes(load<Floats>(&a[i]), load<Floats>(&b[i]), u);
  };
  return {mix_lanes(load(&p.grid.points()[i]), load(&p.end_positions[i]), u) + shift,
          mix_normal_lanes(load(&p.normals[i]), load(&p.end_normals[i]), u),
          between(p.density_weights, p.end_density_weights),
          between(p.radii, p.end_radii),
          between(p.confidences, p.end_confidences),
          fades ? between(p.presences, p.end_presences) : whole};
}

/// Are four live points seen again within R, as they face, beside no edge, alone at their places?
/// Else there is more to decide.
bool Morph::goes_on(const Four& seen, FourWays& ways) const {
  const std::uint32_t first = by_block_.four_at(seen.place);
  if (first == BlockEntries::kNone) return false;
  bool live = true;
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    live = live & (entries_[first + k].kind == EntryKind::live);
    ways.variance[k] = entries_[first + k].variance;
  }
  const auto old_edges = load<Ints>(&last_->edges.of_point[first]);
  if (!live || any(~(seen.edges & old_edges))) return false;
  ways.from = old_points(first);
  ways.place = seen.place;
  const Vectors way = ways.from.position - seen.position;
  const Vectors& normal = ways.from.normal;
  const Ints near = (seen.radius > 0) & (dot(way, way) <= kWithin2 * (seen.radius * seen.radius));
  const Ints turns =
      ~normal.zero() & (dot(seen.normal, normal) < kTurns * dot(seen.normal, seen.normal));
  if (!all(near & ~turns)) return false;
  follow(seen, ways);
  return true;
}

/// Does what the other follow() does for a point within R, in four lanes.
void Morph::follow(const Four& seen, FourWays& ways) const {
  const Floats whole = Floats{} + 1.0f;
  const PointStates& from = ways.from;
  const Floats known = ways.variance * doubt_;
  const Floats both = known + seen.variance;
  const Floats apart = dot(seen.position - from.position, seen.normal);
  const Ints unsure = (seen.variance > kUnsure * known) & (apart * apart < kAgree * kAgree * both);
  const Floats gain = unsure ? known / both : whole;
  ways.variance = gain < 1 ? known : seen.variance;
  ways.to.position = seen.position - ((1 - gain) * apart) * seen.normal;
  ways.to.normal = choose(seen.normal.zero(), from.normal, seen.normal);
  ways.to.radius = from.radius + kShare * (seen.radius - from.radius);
  ways.to.confidence = from.confidence + kShare * (seen.confidence - from.confidence);
  ways.to.weight = seen.trust * least(whole, seen.area / (ways.to.radius * ways.to.radius));
  ways.to.presence = least(whole, from.presence + comes_);
}

void Morph::write(std::size_t at, const FourWays& ways, Piece& piece) {
  writer_.write(at, &order_.codes[ways.place], ways.from, ways.to, piece.extremes);
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    next_entries_[at + k] = Entry{moment_.stamp, ways.variance[k]};
    next_entries_[at + k].place = ways.place + k;
  }
}

}  // namespace palpate
