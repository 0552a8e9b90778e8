// Makes oriented components of segments, within which signs agree, and turns their normals outward.

#include "refine/segments.hpp"

#include <algorithm>
#include <cmath>

#include "refine/segment_clusters.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// |sum of evidence| over the sum of its sizes.
constexpr double kCoherent = 0.5;  // three quarters agree; judgement
constexpr double kAgree = 0.96;    // it is certain: 98 % agree; judgement

constexpr double kMostHidden = 0.5;  // share of a segment's points; judgement

constexpr double kOpen = 0.3;  // |sum a n| / sum a of open components, at least; judgement
// Sine of the lean that gives an open component an upper side; judgement.
constexpr double kUpright = 0.2;

/// Prior evidence for which side of a segment or component is free, relative to its normals.
struct Evidence {
  double signs = 0;  // sum of votes
  double all = 0;    // sum of their sizes

  void add(double vote) {
    signs += vote;
    all += std::abs(vote);
  }
  /// The sign that at least (1 + share) / 2 of the votes have; 0: neither.
  [[nodiscard]] int sign(double share) const {
    if (!(all > 0) || std::abs(signs) < share * all) return 0;
    return signs < 0 ? -1 : 1;
  }
};

/// For each segment: given normals where nearly all agree, else what the eye sees of it.
std::vector<Evidence> evidence_of(const SegmentInput& input, const PriorSigns& prior,
                                  const PointFits& own, const GrownSegments& grown) {
  const SurfacePoints::Segments& segments = grown.segments;
  struct Counts {
    double points = 0;
    double hidden = 0;
  };
  std::vector<Evidence> given(segments.component.size());
  std::vector<Evidence> seen(segments.component.size());
  std::vector<Counts> counts(segments.component.size());
  for (std::uint32_t i = 0; i < segments.segment.size(); ++i) {
    const std::uint32_t segment = segments.segment[i];
    if (segment == SurfacePoints::Segments::kNone) continue;
    ++counts[segment].points;
    if (!prior.given.empty() && prior.given[i].allFinite()) {
      const float cosine = prior.given[i].dot(own.normals[i]);
      if (cosine != 0) given[segment].add(cosine < 0 ? -1 : 1);
    }
    if (prior.eye) {
      const Vector3f offset = *prior.eye - input.grid().points()[i];
      const float cosine = own.normals[i].dot(offset.normalized());
      if (grown.hidden[i] != 0) {
        ++counts[segment].hidden;
      } else {
        seen[segment].add(static_cast<double>(cosine));
      }
    }
  }
  for (std::uint32_t k = 0; k < seen.size(); ++k) {
    if (counts[k].hidden > kMostHidden * counts[k].points) seen[k] = {};
    if (given[k].sign(kAgree) != 0 || !(seen[k].all > 0)) seen[k] = given[k];
  }
  return seen;
}

/// The signed edges between segments, the strongest first.
std::vector<SignedEdge> edges_of(const std::vector<SegmentVote>& votes) {
  std::vector<SignedEdge> edges;
  for (std::size_t k = 0; k < votes.size();) {
    SignedEdge edge{votes[k].a, votes[k].b, {}};
    for (; k < votes.size() && votes[k].a == edge.a && votes[k].b == edge.b; ++k) {
      const auto v = static_cast<double>(votes[k].value);
      edge.votes.value += v * std::abs(v);
      edge.votes.squares += v * v;
    }
    edges.push_back(edge);
  }
  std::stable_sort(edges.begin(), edges.end(), [](const SignedEdge& x, const SignedEdge& y) {
    return std::abs(x.votes.value) > std::abs(y.votes.value);
  });
  return edges;
}

/// Sums over the points of one component.
struct ComponentSums {
  double area = 0;                     // m^2
  double flux = 0;                     // sum a n.p, m^3
  Vector3d vector = Vector3d::Zero();  // sum a n, m^2
  Vector3d moment = Vector3d::Zero();  // sum a p, m^3
};

/// The sign that turns a component's normals to its free side, and whether evidence decided it.
struct Side {
  int sign = 1;
  bool decided = false;
};

/// Evidence counts where nearly all of it agrees. Else a component that closes around something
/// gets its normals outward: the far side of a whole object faces away from where it was seen. A
/// component that does not close, such as terrain, a wall or one view of a scene, has no outside:
/// evidence that mostly agrees decides or, without any, the mean normal is to point up (+z) or, if
/// it lies, away from the centre of all points.
Side side_of(const ComponentSums& component, const Evidence& evidence,
             const Vector3d& center_of_all) {
  if (const int sign = evidence.sign(kAgree); sign != 0) return {sign, true};
  if (!(component.area > 0)) return {};
  const auto turned = [](double along) { return Side{along < 0 ? -1 : 1, false}; };
  const Vector3d center = component.moment / component.area;
  if (component.vector.norm() <= kOpen * component.area)
    return turned(component.flux - center.dot(component.vector));
  if (const int sign = evidence.sign(kCoherent); sign != 0) return {sign, true};
  if (std::abs(component.vector.z()) > kUpright * component.vector.norm())
    return turned(component.vector.z());
  return turned(component.vector.dot(center - center_of_all));
}

/// The sums of every component, its normals turned by `signs` of the segments, and of all.
std::vector<ComponentSums> sums_of_components(const SegmentInput& input, const PointFits& own,
                                              const SurfacePoints::Segments& segments,
                                              const std::vector<int>& signs, ComponentSums& all) {
  std::vector<ComponentSums> sums(signs.size());
  for (std::uint32_t i = 0; i < segments.segment.size(); ++i) {
    if (segments.segment[i] == SurfacePoints::Segments::kNone) continue;
    const Vector3d p = input.grid().points()[i].cast<double>();
    const Vector3d n = signs[segments.segment[i]] * own.normals[i].cast<double>();
    const double area =
        static_cast<double>(input.spacings[i]) * static_cast<double>(input.spacings[i]);
    ComponentSums& component = sums[segments.component[segments.segment[i]]];
    component.area += area;
    component.flux += area * n.dot(p);
    component.vector += area * n;
    component.moment += area * p;
    all.area += area;
    all.moment += area * p;
  }
  return sums;
}

/// Turns the normals of whole segments.
void turn(const std::vector<int>& sign_of_segment, const SurfacePoints::Segments& segments,
          PointFits& own) {
  for (std::size_t i = 0; i < segments.segment.size(); ++i) {
    if (segments.segment[i] == SurfacePoints::Segments::kNone ||
        sign_of_segment[segments.segment[i]] > 0)
      continue;
    own.normals[i] = -own.normals[i];
  }
}

/// Joins segments in clusters, along the strongest edges first. An edge that contradicts the
/// evidence of both of its sides is passed over. `evidence`: becomes that of the clusters, at their
/// roots.
SegmentClusters join_clusters(const std::vector<SignedEdge>& edges,
                              std::vector<Evidence>& evidence) {
  SegmentClusters clusters(edges, evidence.size());
  for (const SignedEdge& edge : edges) {
    const std::uint32_t root_a = clusters.find(edge.a).first;
    const std::uint32_t root_b = clusters.find(edge.b).first;
    const int sign = clusters.sign_between(root_a, root_b);
    if (sign == 0) continue;
    const int both = evidence[root_a].sign(kCoherent) * evidence[root_b].sign(kCoherent);
    if (both != 0 && both != sign) continue;
    Evidence& whole = evidence[std::min(root_a, root_b)];
    const Evidence& other = evidence[std::max(root_a, root_b)];
    whole.signs += sign * other.signs;
    whole.all += other.all;
    clusters.join(root_a, root_b, sign);
  }
  return clusters;
}

/// Makes components of clusters of segments and turns their normals to the free side.
void join_components(const SegmentInput& input, const std::vector<SignedEdge>& edges,
                     std::vector<Evidence> evidence, const std::optional<Vector3d>& middle,
                     PointFits& own, SurfacePoints::Segments& segments) {
  SegmentClusters clusters = join_clusters(edges, evidence);
  std::vector<int> signs;
  std::vector<std::uint32_t> roots;  // of the components
  for (std::uint32_t k = 0; k < segments.component.size(); ++k) {
    const auto [root, sign] = clusters.find(k);
    if (root == k) roots.push_back(k);
    segments.component[k] =
        root == k ? static_cast<std::uint32_t>(roots.size()) - 1 : segments.component[root];
    signs.push_back(sign);
  }
  ComponentSums all;
  const std::vector<ComponentSums> sums = sums_of_components(input, own, segments, signs, all);
  const Vector3d own_middle = all.area > 0 ? Vector3d(all.moment / all.area) : all.moment;
  std::vector<Side> sides;
  for (std::uint32_t k = 0; k < roots.size(); ++k) {
    sides.push_back(side_of(sums[k], evidence[roots[k]], middle.value_or(own_middle)));
    segments.known.push_back(sides.back().decided ? 1 : 0);
  }
  for (std::uint32_t k = 0; k < signs.size(); ++k) signs[k] *= sides[segments.component[k]].sign;
  turn(signs, segments, own);
}

}  // namespace

SurfacePoints::Segments make_segments(const SegmentInput& input, const PriorSigns& prior,
                                      PointFits& own, std::vector<SecondPlane>& second_planes) {
  GrownSegments grown = grow_segments(input, own);
  second_planes = std::move(grown.second_planes);
  const std::vector<SegmentVote> votes = look_around(input, own, prior.eye, grown);
  const std::vector<Evidence> evidence = evidence_of(input, prior, own, grown);
  SurfacePoints::Segments segments = std::move(grown.segments);
  join_components(input, edges_of(votes), evidence, prior.middle, own, segments);
  segments.residual = own.residuals;
  return segments;
}

void refine_segments(Surfels& s) {
  if (s.fits.normals.empty()) return;
  for (std::size_t i = 0; i < s.weights.values.size(); ++i) {
    if (s.weights.values[i] <= 0) s.fits.confidences[i] = 0;
  }
  const PriorSigns prior = given_signs(s.placed, s.sampling, s.options);
  s.graph.widen(segment_reaches(s.sampling.spacings, s.radii.values, prior.eye.has_value()),
                s.radii.values);
  s.segments =
      make_segments({s.graph, s.sampling.spacings, s.radii.values, s.sampling.local.sigmas}, prior,
                    s.fits, s.second_planes);
}

}  // namespace palpate
