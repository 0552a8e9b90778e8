#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/formulas.hpp"
#include "palpate/field/field.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/field/surface_points.hpp"
#include "support/dual.hpp"
#include "support/united_reference.hpp"

namespace palpate::test {

struct ReferencePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double radius = 0;      // R_i, m
  double weight = 1;      // C_k a_i
  double confidence = 1;  // c_i
  int source = 0;
  SurfacePoints::EdgePlane edge;
};

/// The field of docs/method.md 2 over all
/// points, in double, without an index: slow, obvious, and the judge of the fast one. Normal tools
/// only (no tool radius for the metaball, none of the paper's variants).
class ReferenceField final : public Field {
 public:
  /// `side`: -1: it is seen from behind its normals.
  ReferenceField(std::vector<ReferencePoint> points, const FieldOptions& options, int side = 1)
      : points_(std::move(points)), options_(options) {
    for (ReferencePoint& p : points_) {
      p.normal *= side;
      const auto sign = static_cast<float>(side);
      p.edge = {sign * p.edge.normal, sign * p.edge.height, sign * p.edge.share};
    }
    for (const ReferencePoint& p : points_) sources_ = std::max(sources_, p.source + 1);
  }

  /// The points of one source each.
  ReferenceField(const std::vector<const SurfacePoints*>& sources, const FieldOptions& options,
                 int side = 1)
      : ReferenceField(points_of(sources), options, side) {}

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override {
    const Sums s = sums_at(x);
    Sample result{.value = 0.35 * typical_radius(), .radius = typical_radius()};
    if (!(s.plain.v > 1e-12)) return result;
    const Dual support = united(s.by_source);
    const Dual radius = s.radius / s.plain;
    const Dual blob = as_length(radius, options_.threshold, support);
    Dual value = blob;
    if (s.trusted.v > 1e-9 * s.plain.v && options_.kind != FieldOptions::Kind::metaball) {
      Dual height = with_edges(s, height_of(s) - closure(s, radius));
      if (sources_ > 1) height = height + united_shift(s.own, radius, options_.kernel);
      value = blend(s, capped(height, radius, support), blob);
    }
    result.value = value.v;
    result.gradient = value.g;
    result.support = support.v;
    result.radius = radius.v;
    return result;
  }

  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    std::vector<Dual> most(static_cast<std::size_t>(sources_));
    for (const ReferencePoint& p : points_) {
      const double r = std::max(0.0, (ball.center - p.position).norm() - ball.radius) / p.radius;
      most[static_cast<std::size_t>(p.source)].v += p.weight * evaluate(options_.kernel, r * r).w;
    }
    const double level = options_.kind == FieldOptions::Kind::metaball
                             ? options_.threshold
                             : std::min(options_.threshold, options_.minimum_support);
    return united(most).v < level;
  }

  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override {
    return {.source = 0};
  }

  [[nodiscard]] Field::Traits traits() const noexcept override {
    const bool metaball = options_.kind == FieldOptions::Kind::metaball;
    return {.resolution = (metaball ? 0.002 : 1.0 / 16) * typical_radius()};
  }

 private:
  struct Term {
    Dual v;
    DualVector q;
    Eigen::Vector3d n = Eigen::Vector3d::Zero();
  };

  struct Sums {
    std::vector<Dual> by_source;
    Dual plain, radius;        // sum w, sum w R
    Dual trusted;              // sum v, v = w c
    DualVector q, n;           // sum v (p - x), sum v n
    Dual nq;                   // sum v n . (p - x)
    Dual edge, edge_height;    // sum e, sum e h: of what points beside edges say
    std::vector<OwnSums> own;  // of each source
  };

  static std::vector<ReferencePoint> points_of(const std::vector<const SurfacePoints*>& sources) {
    std::vector<ReferencePoint> all;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const SurfacePoints& from = *sources[s];
      for (std::size_t i = 0; i < from.size(); ++i) {
        all.push_back({from.origin + from.grid.points()[i].cast<double>(),
                       from.normals.empty() ? Eigen::Vector3d::Zero().eval()
                                            : from.normals[i].cast<double>().eval(),
                       from.radii[i], from.density_weights[i], from.confidences[i],
                       static_cast<int>(s), edge_of(from, i)});
      }
    }
    return all;
  }

  static SurfacePoints::EdgePlane edge_of(const SurfacePoints& from, std::size_t i) {
    const std::vector<std::uint32_t>& edges = from.edges.of_point;
    const bool none = edges.empty() || edges[i] == SurfacePoints::Edges::kNone;
    return none ? SurfacePoints::EdgePlane{} : from.edges.start[edges[i]];
  }

  [[nodiscard]] double typical_radius() const {
    return points_.empty() ? 0 : points_[points_.size() / 2].radius;
  }

  [[nodiscard]] Sums sums_at(const Eigen::Vector3d& x) const {
    Sums s;
    s.by_source.resize(static_cast<std::size_t>(sources_));
    s.own.resize(static_cast<std::size_t>(sources_));
    for (const ReferencePoint& p : points_) {
      const Eigen::Vector3d away = x - p.position;
      const double r2 = p.radius * p.radius;
      const KernelValue kernel = evaluate(options_.kernel, away.squaredNorm() / r2);
      const Dual w{p.weight * kernel.w, (p.weight * kernel.g / r2) * away};
      if (w.v <= 0) continue;
      const Dual v = p.confidence * w;
      Dual& own = s.by_source[static_cast<std::size_t>(p.source)];
      own = own + w;
      s.plain = s.plain + w;
      s.radius = s.radius + p.radius * w;
      s.trusted = s.trusted + v;
      Term term{v, {}, p.normal};
      for (int k = 0; k < 3; ++k) {
        term.q[static_cast<std::size_t>(k)] = {-away[k], -Eigen::Vector3d::Unit(k)};
      }
      add(s, v, term);
      add_own(p, w, v, term, s.own[static_cast<std::size_t>(p.source)]);
      add_edge(s, p, x, v);
    }
    return s;
  }

  static void add(Sums& s, const Dual& v, const Term& term) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double n = term.n[static_cast<Eigen::Index>(axis)];
      s.q[axis] = s.q[axis] + v * term.q[axis];
      s.n[axis] = s.n[axis] + n * v;
      s.nq = s.nq + n * (v * term.q[axis]);
    }
  }

  static void add_own(const ReferencePoint& p, const Dual& w, const Dual& v, const Term& term,
                      OwnSums& own) {
    own.w = own.w + w;
    own.wr = own.wr + p.radius * w;
    own.v = own.v + v;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double n = term.n[static_cast<Eigen::Index>(axis)];
      own.n[axis] = own.n[axis] + n * v;
      own.nq = own.nq + n * (v * term.q[axis]);
    }
  }

  [[nodiscard]] static Dual united(const std::vector<Dual>& by_source) {
    if (by_source.size() == 1) return by_source[0];
    Dual sum;
    for (const Dual& w : by_source) sum = sum + w * w * w * w;
    return sum.v > 0 ? sqrt(sqrt(sum)) : Dual{};
  }

  [[nodiscard]] Dual height_of(const Sums& s) const {
    const DualVector a = s.q / s.trusted;
    const DualVector mean_normal = s.n / s.trusted;
    if (options_.kind == FieldOptions::Kind::pointset) {
      return -1.0 * (dot(mean_normal, a) / sqrt(dot(mean_normal, mean_normal)));
    }
    return -0.5 * (dot(mean_normal, a) + s.nq / s.trusted);
  }

  /// The height above both planes, by e = v |share|: the larger of the two, or in a crease the
  /// smaller, rounded over a part of R.
  static void add_edge(Sums& s, const ReferencePoint& p, const Eigen::Vector3d& x, const Dual& v) {
    const double share = p.edge.share;
    if (share == 0) return;
    const double sign = share < 0 ? -1 : 1;
    const Eigen::Vector3d m = p.edge.normal.cast<double>();
    const Dual own{sign * p.normal.dot(x - p.position), sign * p.normal};
    const double above = static_cast<double>(p.edge.height) + m.dot(x - p.position);
    const Dual beyond{sign * above, sign * m};
    const double width = (share < 0 ? 0.05 : 0.005) * p.radius;
    Dual height = own.v > beyond.v ? own : beyond;
    const Dual apart = own.v > beyond.v ? own - beyond : beyond - own;
    if (apart.v < width) {
      const Dual inside = constant(width) - apart;
      height = height + 0.25 / width * (inside * inside);
    }
    s.edge = s.edge + std::abs(share) * v;
    s.edge_height = s.edge_height + share * (v * height);
  }

  /// The part of the height that points beside edges have a say in is what they say.
  [[nodiscard]] Dual with_edges(const Sums& s, const Dual& height) const {
    if (options_.kind != FieldOptions::Kind::balanced || !options_.sharp_edges || s.edge.v <= 0) {
      return height;
    }
    return height + (s.edge_height - height * s.edge) / s.trusted;
  }

  [[nodiscard]] Dual as_length(const Dual& radius, double level, const Dual& support) const {
    return (0.35 / options_.minimum_support) * (radius * (constant(level) - support));
  }

  /// The height by which acute creases are closed (docs/method.md 2.6).
  [[nodiscard]] Dual closure(const Sums& s, const Dual& radius) const {
    if (!options_.capped) return {};
    const DualVector a = s.q / s.trusted;
    const DualVector n = s.n / s.trusted;
    const Dual hollow = (dot(n, a) - s.nq / s.trusted) / radius;
    return 0.2 * radius * smooth(constant(1) - (1 / 0.7) * dot(n, n)) * smooth(100 * hollow);
  }

  /// u^2 (3 - 2u), u within 0 and 1.
  [[nodiscard]] static Dual smooth(const Dual& u) {
    if (u.v <= 0) return constant(0);
    if (u.v >= 1) return constant(1);
    return u * u * (constant(3) - 2 * u);
  }

  [[nodiscard]] Dual capped(const Dual& height, const Dual& radius, const Dual& support) const {
    const Dual outer = height - constant(options_.tool_radius);
    if (!options_.capped) return outer;
    const Dual cap = as_length(radius, options_.minimum_support, support);
    const Dual width = 0.1 * radius;
    const Dual difference = outer.v > cap.v ? outer - cap : cap - outer;
    const Dual& larger = outer.v > cap.v ? outer : cap;
    if (difference.v >= width.v) return larger;
    const Dual h = (width - difference) / width;
    return larger + 0.25 * (h * h * width);
  }

  [[nodiscard]] Dual blend(const Sums& s, const Dual& cap, const Dual& blob) const {
    if (!options_.capped) return cap;
    const Dual chi = s.trusted / s.plain;
    const Dual kappa = smooth((1 / 0.3) * (chi - constant(0.25)));
    return kappa * cap + (constant(1) - kappa) * blob;
  }

  std::vector<ReferencePoint> points_;
  FieldOptions options_;
  int sources_ = 1;
};

}  // namespace palpate::test
