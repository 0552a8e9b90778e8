// The segments near a tool, and what it sees of them from where it is (docs/method.md 2.7).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/selection.hpp"
#include "field/simd/sums.hpp"

namespace palpate {

class AgreedSides;

/// The position of a proxy, in free space or on the surface, and its contact normal.
struct Stance {
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();   ///< m, world
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the contact; zero: it touches nothing
  double spread = 0;  ///< m: so far around the proxy its tool has samples; what they may touch
                      ///< stays as it is decided
  AgreedSides* agreed = nullptr;  ///< stands above what is seen, and learns what is decided

  [[nodiscard]] bool touches() const noexcept { return !normal.isZero(0); }
};

/// The height of the surface above its points: length (m) + share * R of the point.
struct Rise {
  double length = 0;
  double share = 0;
};

inline constexpr float kLift = 0.3f;  ///< R above the surface that a touching tool looks from
inline constexpr float kUnsharp = 2;  ///< residuals of a height that decides a side; judgement

/// How a segment is seen from the tool. Its points' normals are turned to the tool's side of it.
enum Label : std::uint8_t {
  kNearFace = 0,  ///< near face: what is above it is free
  kFarFace = 1,   ///< far face: it meets a near face or a concave neighbour at a convex edge; solid
                  ///< is what is below both
  kConcave = 2,   ///< concave neighbour: it meets a near face in a crease, or that goes on beyond
                  ///< its plane; free is what is above both
};
static_assert(kConcave == simd::kLabels - 1);

/// Swaps two labels in what has a `label`.
void swap_labels(auto& labelled, std::uint8_t a, std::uint8_t b) noexcept {
  for (auto& x : labelled) x.label = x.label == a ? b : x.label == b ? a : x.label;
}

/// Segments whose normals face away from each other by this cosine or more may be the sides of a
/// plate, which is kept from cutting itself off (docs/method.md 2.8); judgement.
inline constexpr double kBackToBack = 0.8;

/// The segments near the tool, in the order in which they were added, and their components. All
/// memory is taken by the constructor.
struct SegmentTable {
  static constexpr std::size_t kMost = 96;  ///< segments; further ones are near faces; judgement
  static constexpr std::uint8_t kUndecided = 0xff;  ///< no label yet; above every Label

  /// Names a segment or a component: the surface points that it is of, and its number among theirs.
  /// Layers without segments of their own share one (key_of_all()), and all that was seen from one
  /// side alone is one component (kOneSided).
  struct Key {
    const void* owner = nullptr;
    std::uint32_t number = 0;
    bool operator==(const Key&) const = default;
  };
  static constexpr Key kOneSided{nullptr, 1};  ///< of all points seen from one side only
  struct Component {
    Key key;
    int sign = 0;            // 0: not decided
    bool outward = false;    // does evidence turn its normals outward?
    bool uncertain = false;  // was it seen in one view that does not show its side?
    bool assumed = false;    // is its sign one that nothing speaks for?
    bool near = false;       // has one of its points weight at the proxy, or nearly?
    bool weighs = false;     // has one of them weight there?
    double seen = 0;         // what speaks for the side of its normals, less what speaks against it

    [[nodiscard]] bool is_one_sided() const noexcept { return key == kOneSided; }
    // Is it seen from behind, the side that no sensor saw?
    [[nodiscard]] bool is_absent() const noexcept { return is_one_sided() && sign < 0; }
    // The factor for its normals, 1 or -1; 0: not decided. One-sided components are never turned.
    [[nodiscard]] int factor() const noexcept { return is_absent() ? 1 : sign; }
  };
  struct Segment {
    Key key;
    int source = 0;
    std::uint32_t component = 0;
    std::uint8_t label = kUndecided;
    bool near = false;
    std::uint32_t begin = 0;  // of its points in the view's order
    std::uint32_t count = 0;
    double weight = 0;
  };

  SegmentTable();
  void clear() noexcept;
  void clear_segments() noexcept;

  /// The index of a layer's segment, which is added if it is new, with what `before` has decided of
  /// it; kMost: there are too many.
  std::uint32_t add(const ActiveLayer& layer, std::uint32_t number,
                    const SegmentTable& before) noexcept;
  /// Makes near faces of the segments with the label `touched`, or of those that are left where
  /// there is no near face: the labels of what comes into view follow from how it meets them.
  /// Swapped labels leave the field as it is, but for near and far faces beside a
  /// concave neighbour: they stay.
  void make_near_face(std::uint8_t touched) noexcept;
  /// Where the segment is in `slots`, or would be.
  [[nodiscard]] std::uint8_t find(const Key& key) const noexcept;
  [[nodiscard]] bool sees_from_behind() const noexcept {
    return std::ranges::any_of(components, &Component::is_absent);
  }
  /// The key of the one segment and component that points without segments of their own belong to.
  [[nodiscard]] static Key key_of_all(const SurfacePoints& points) noexcept {
    return points.one_sided() ? kOneSided : Key{};
  }

  std::vector<Component> components;
  std::vector<Segment> segments;
  std::array<std::uint8_t, 256> slots;  // of segments, by their keys' hashes and what follows
};

/// The segments of the chosen points, and what an eye at the tool sees of them. All memory is taken
/// by the constructor.
struct SegmentView {
  static constexpr std::uint32_t kNone = SegmentTable::kMost;           ///< a point of no segment
  static constexpr std::uint32_t kUncertain = SegmentTable::kMost + 1;  ///< and of a single view

  /// One point with confidence, and what is read of it again and again.
  struct Point {
    Eigen::Vector3f position;  // from the proxy, m
    Eigen::Vector3f normal;
    float confidence;
    float radius;
    float residual;
    std::uint32_t segment;
  };

  // Where the tool looks from.
  struct Eye {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  // free, from the proxy, m
    Eigen::Vector3f beside = Eigen::Vector3f::Zero();    // normal of the closest one-sided point
    float view = 0;                                      // how far from here what is seen counts, m
  };

  /// `capacity`: points at most.
  explicit SegmentView(std::size_t capacity);

  /// Lists what the proxy is among, with what is decided of it by now.
  void list(std::span<const ActiveLayer> layers, const Selection& chosen, const Rise& height,
            const Stance& stance) noexcept;
  /// Sums what speaks for the sides that the tool sees. `travel`, m: of the proxy since the last
  /// call; `from_behind`: it was behind what was seen from one side only.
  void look(const Stance& stance, double travel, bool from_behind) noexcept;
  /// The label of what a proxy with this contact normal touches most; kNearFace: of nothing.
  [[nodiscard]] std::uint8_t touched_label(const Eigen::Vector3f& normal) const noexcept;
  /// Is a segment gone that was near the proxy when the last list was made?
  [[nodiscard]] bool has_lost_one() const noexcept;
  [[nodiscard]] bool is_one_sided(const Point& point) const noexcept {
    return table.components[table.segments[point.segment].component].is_one_sided();
  }
  /// Is the eye in front of the point's surface?
  [[nodiscard]] bool is_above(const Point& point) const noexcept;

  SegmentTable table;
  SegmentTable before;  // the last list
  std::vector<Point> points;
  std::vector<std::uint32_t> segment_of_point;  // of all chosen points; or kNone, kUncertain
  std::vector<std::uint32_t> order;             // of `points`, segment by segment
  Eye eye;
  float radius = 0;  // R around the tool, m
  Rise rise;
};

}  // namespace palpate
