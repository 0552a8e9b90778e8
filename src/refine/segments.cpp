// Makes oriented components of segments, within which signs agree, and turns their normals outward.

#include "refine/segments.hpp"

#include <algorithm>
#include <cmath>

#include "refine/signed_graph.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// |sum of evidence| over the sum of its sizes, where it is certain: 98 % agree; judgement.
constexpr double kAgree = 0.96;

constexpr double kMostHidden = 0.5;  // share of a segment's points; judgement

constexpr double kOpen = 0.3;  // |sum a n| / sum a of open components, at least; judgement
// Sine of the lean that gives an open component an upper side; judgement.
constexpr double kUpright = 0.2;

/// For each segment: given normals where nearly all agree, else what the eye sees of it.
std::vector<EdgeWeight> evidence_of(const SegmentInput& input, const PriorSigns& prior,
                                    const PointFits& own, const GrownSegments& grown) {
  const SurfacePoints::Segments& segments = grown.segments;
  struct Counts {
    double points = 0;
    double hidden = 0;
  };
  std::vector<EdgeWeight> given(segments.component.size());
  std::vector<EdgeWeight> seen(segments.component.size());
  std::vector<Counts> counts(segments.component.size());
  for (std::uint32_t i = 0; i < segments.segment.size(); ++i) {
    const std::uint32_t segment = segments.segment[i];
    if (segment == SurfacePoints::Segments::kNone) continue;
    ++counts[segment].points;
    if (!prior.given.empty() && prior.given[i].allFinite()) {
      const float cosine = prior.given[i].dot(own.normals[i]);
      if (cosine != 0) given[segment] += EdgeWeight(cosine < 0 ? -1 : 1);
    }
    if (prior.eye) {
      const Vector3f offset = *prior.eye - input.grid().points()[i];
      const float cosine = own.normals[i].dot(offset.normalized());
      if (grown.hidden[i] != 0) {
        ++counts[segment].hidden;
      } else {
        seen[segment] += EdgeWeight(static_cast<double>(cosine));
      }
    }
  }
  for (std::uint32_t k = 0; k < seen.size(); ++k) {
    if (counts[k].hidden > kMostHidden * counts[k].points) seen[k] = {};
    if (given[k].sign(kAgree) != 0 || !(seen[k].size > 0)) seen[k] = given[k];
  }
  return seen;
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
Side side_of(const ComponentSums& component, const EdgeWeight& evidence,
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

/// Clusters of segments by the `votes` of their points and the `evidence` for their sides.
SignedGraph join_segments(const std::vector<SignedEdge>& votes,
                          const std::vector<EdgeWeight>& evidence) {
  const auto free_side = static_cast<std::uint32_t>(evidence.size());
  SignedGraph graph{detail::SignedSets(evidence.size() + 1)};
  for (const SignedEdge& vote : votes) graph.add(vote);
  for (std::uint32_t k = 0; k < free_side; ++k) graph.add({k, free_side, evidence[k]});
  graph.contract();
  return graph;
}

/// Makes components of clusters of segments and turns their normals to the free side.
void join_components(const SegmentInput& input, SignedGraph& graph,
                     const std::optional<Vector3d>& middle, PointFits& own,
                     SurfacePoints::Segments& segments) {
  std::vector<int> signs;
  std::vector<std::uint32_t> roots;  // of the components
  std::vector<std::uint32_t> of_root(segments.component.size(), SurfacePoints::Segments::kNone);
  for (std::uint32_t k = 0; k < of_root.size(); ++k) {
    const std::uint32_t root = graph.find(k).first;
    if (of_root[root] == SurfacePoints::Segments::kNone) {
      of_root[root] = static_cast<std::uint32_t>(roots.size());
      roots.push_back(root);
    }
    segments.component[k] = of_root[root];
    signs.push_back(graph.find(k).second);
  }
  ComponentSums all;
  const std::vector<ComponentSums> sums = sums_of_components(input, own, segments, signs, all);
  const Vector3d own_middle = all.area > 0 ? Vector3d(all.moment / all.area) : all.moment;
  std::vector<Side> sides;
  for (std::uint32_t k = 0; k < roots.size(); ++k) {
    sides.push_back(side_of(sums[k], graph.side(roots[k]), middle.value_or(own_middle)));
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
  const std::vector<SignedEdge> votes = look_around(input, own, prior.eye, grown);
  SignedGraph graph = join_segments(votes, evidence_of(input, prior, own, grown));
  SurfacePoints::Segments segments = std::move(grown.segments);
  join_components(input, graph, prior.middle, own, segments);
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
