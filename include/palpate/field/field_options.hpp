// Options that define the surface of points.
#pragma once

namespace palpate {

/// The paper's two compactly supported weights (section III-A).
enum class Kernel { wyvill, wendland };

/// How points become a surface. The defaults are ours; paper_field() gives the paper's.
struct FieldOptions {
  /// The implicit surfaces that points can be turned into.
  enum class Kind {
    balanced,  ///< mean of point-set surface and IMLS; our default (docs/method.md 2.4)
    pointset,  ///< the paper's point-set surface, eqs. (5)-(7)
    metaball,  ///< the paper's metaball surface, eq. (3), on density-normalised weights
  };

  /// Which vector stands for the gradient.
  enum class Gradient {
    exact,    ///< of the function as evaluated
    normal,   ///< the mean normal n(x): eq. (8), `pointset` of the preset `paper` only
    printed,  ///< eq. (4) as printed, which points inward: to show that, never to be felt
  };

  Kind kind = Kind::balanced;
  Kernel kernel = Kernel::wyvill;
  Gradient gradient = Gradient::exact;
  double threshold = 0.4;        ///< metaball level T', of the (united) weight sum
  double minimum_support = 0.3;  ///< Wmin: the surface ends where the weight sum falls below it
  double tool_radius = 0;        ///< radius of the proxy's ball, m; the surface is pushed out by it
  /// Cap at Wmin, fill acute creases, and blend to the metaball where normals are uncertain.
  bool capped = true;
  /// Edges and creases are sharp where points have edge planes (SurfacePoints::edges); `balanced`
  /// with the exact gradient only.
  bool sharp_edges = true;
  bool raw_weights = false;     ///< ignore density weights (the paper)
  bool nearest_radius = false;  ///< use the R of the point nearest to the proxy for all (the paper)

  bool operator==(const FieldOptions&) const = default;
};

/// @throws Error when an option is out of its range.
void check(const FieldOptions& options);

/// The paper's field: raw weights, T = 0.5, R of the nearest point, no cap.
[[nodiscard]] FieldOptions paper_field(FieldOptions::Kind kind = FieldOptions::Kind::metaball);

}  // namespace palpate
