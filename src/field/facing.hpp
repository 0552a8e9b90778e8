// Sides and labels: how the sheets near the tool are seen from it (docs/method.md 2.7).
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

/// How a sheet is seen from the tool. Its points' normals are turned to the tool's side of it.
enum Label : std::uint8_t {
  kInFront = 0,  ///< what is above it is free
  kBehind = 1,   ///< it meets what is in front at a convex edge, or is hidden by it: solid is
                 ///< what is below both
  kAcross = 2,   ///< it meets what is in front in a crease, or that goes on beyond its plane: free
                 ///< is what is above both
};
static_assert(kAcross == simd::kLabels - 1);

/// Sheets whose normals face away from each other by this cosine or more may be the sides of a
/// plate, which is kept from cutting itself off (docs/method.md 2.8); judgement.
inline constexpr double kBackToBack = 0.8;

/// The position of a proxy, in free space or on the surface, and its contact normal.
struct Stance {
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();   ///< m, world
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the contact; zero: it touches nothing

  [[nodiscard]] bool touches() const noexcept { return !normal.isZero(0); }
};

/// The height of the surface above its points: length (m) + share * R of the point.
struct Rise {
  double length = 0;
  double share = 0;
};

/// Decides which side of each sheet near the tool is free, and how the sheets meet as seen from
/// there. A decision stands as long as any of the sheet's points has weight at the proxy: meanwhile
/// the field depends only on where it is evaluated. Real-time but for construction; bounded in
/// pairs of points that are compared.
class Facing {
 public:
  /// `capacity`: points at most.
  explicit Facing(std::size_t capacity);

  /// The points that count, layer by layer, and what is decided of each: whether its normal is to
  /// be turned (-1) or it is not there at all (0), and its label.
  struct Points {
    std::span<const ActiveLayer> layers;
    const Selection* selection = nullptr;
    std::span<std::int8_t> signs;
    std::span<std::uint8_t> labels;
    Rise rise;
  };

  /// True when a sign or a label is another than before.
  bool face(const Points& points, const Stance& stance) noexcept;

  /// Is the proxy behind what was seen from the other side alone? Such points are not there for it
  /// until it comes out in front of them.
  [[nodiscard]] bool behind() const noexcept { return was_behind_; }

  /// Has all decided again, for a proxy that is where nothing is solid. What was seen on the way
  /// counts.
  void reopen() noexcept;

  /// Forgets what is decided and what was seen.
  void forget() noexcept;

  /// Copies decisions from `other`, if it has any. They hold for the next face() even if no point
  /// is near.
  void follow(const Facing& other) noexcept;

 private:
  // Sheets near the tool; further ones are in front; judgement.
  static constexpr std::size_t kMost = 96;
  static constexpr std::uint32_t kUnsure = kMost + 1;  // no sheet, but a point of a single view
  static constexpr std::uint8_t kOpen = 0xff;  // a label that is not decided; above every Label

  /// Names a sheet or a part: the surface points that it is of, and its number among theirs. Layers
  /// without sheets of their own share one (key_of_all()), and all that was seen from one side
  /// alone is one part (kOneSided).
  struct Key {
    const void* owner = nullptr;
    std::uint32_t number = 0;
    bool operator==(const Key&) const = default;
  };
  static constexpr Key kOneSided{nullptr, 1};  // the part of all points seen from one side only
  struct Part {
    Key key;
    int sign = 0;         // 0: not decided
    bool known = false;   // do its normals point outward for sure?
    bool unsure = false;  // was it seen in one view that does not tell its side?
    bool near = false;    // has one of its points weight at the proxy, or nearly?
    bool weighs = false;  // has one of them weight there?
    double seen = 0;      // what speaks for the side of its normals, less what speaks against it

    // Is it seen from behind, the side that no sensor saw?
    [[nodiscard]] bool is_absent() const noexcept { return key == kOneSided && sign < 0; }
    // The factor for its normals, 1 or -1; 0: not decided. One-sided parts are never turned.
    [[nodiscard]] int factor() const noexcept { return is_absent() ? 1 : sign; }
  };
  struct Sheet {
    Key key;
    int source = 0;
    std::uint32_t part = 0;
    std::uint8_t label = kOpen;
    bool near = false;
    std::uint32_t begin = 0;  // of its points in order_
    std::uint32_t count = 0;
    double weight = 0;
    double all = 0;     // sum of its points' weights
    double hidden = 0;  // the same of those that another sheet hides
  };
  struct Table {
    std::array<Part, kMost> parts;
    std::array<Sheet, kMost> sheets;
    std::uint32_t part_count = 0;
    std::uint32_t sheet_count = 0;
    std::array<std::uint8_t, 256> slots;  // of sheets, by their keys' hashes and what follows

    void clear_sheets() noexcept;
    void clear() noexcept;
    /// Copies what is in use of 10 KB.
    void copy(const Table& other) noexcept;
    /// Where the sheet is in `slots`, or would be.
    [[nodiscard]] std::uint8_t* find(const Key& key) noexcept;
  };
  /// One point with confidence, and what is asked of it again and again.
  struct Point {
    Eigen::Vector3f place;  // from the proxy, m
    Eigen::Vector3f normal;
    float confidence;
    float radius;
    float residual;
    float above;
    float below;
    std::uint32_t sheet;

    // Is another sheet between its plane and an eye at this height above it?
    [[nodiscard]] bool is_hidden(float height) const noexcept {
      return std::abs(height) > (height > 0 ? above : below) + residual;
    }
  };
  /// A point that is decided and counts for those that are not.
  struct Reference {
    const void* cloud;  // nullptr: one that is gone
    int source;
    Eigen::Vector3f place;
    Eigen::Vector3f normal;  // turned
    float confidence;
    float residual;
    std::uint8_t label;

    // Was it measured at another time than the sheet, by the same source? Then it may be what the
    // sheet was, or will be, somewhere else.
    [[nodiscard]] bool is_of_another_time(const Sheet& sheet) const noexcept {
      return source == sheet.source && cloud != sheet.key.owner;
    }
  };

  // Where the tool looks from.
  struct Eye {
    Eigen::Vector3f place = Eigen::Vector3f::Zero();   // free, from the proxy, m
    Eigen::Vector3f beside = Eigen::Vector3f::Zero();  // normal of the closest one-sided point
    float view = 0;                                    // how far from here what is seen counts, m
  };

  std::uint32_t part_of(Part part) noexcept;
  std::uint32_t sheet_of(const ActiveLayer& layer, std::uint32_t number) noexcept;
  void list(const Points& points, const Stance& stance) noexcept;
  void list_layer(const ActiveLayer& layer, std::span<const std::uint32_t> places,
                  const Stance& stance) noexcept;
  void let_go(const Stance& stance) noexcept;
  void group() noexcept;
  void choose_eye(const Stance& stance) noexcept;
  // The key of the one sheet and part that points without sheets of their own belong to.
  [[nodiscard]] static Key key_of_all(const SurfacePoints& points) noexcept {
    return points.one_sided ? kOneSided : Key{};
  }
  [[nodiscard]] bool is_one_sided(const Point& point) const noexcept;
  [[nodiscard]] float height_over(const Point& point) const noexcept;
  [[nodiscard]] float rise_of(const Point& point) const noexcept;
  [[nodiscard]] bool is_above(const Point& point) const noexcept;
  [[nodiscard]] bool list_references(const Stance& stance) noexcept;
  [[nodiscard]] bool is_settled(std::span<const ActiveLayer> layers) const noexcept;
  void add_references(const Sheet& sheet) noexcept;
  template <class Visit>
  void each_meeting(const Sheet& sheet, const Visit& visit) noexcept;
  [[nodiscard]] bool is_decided(const Sheet& sheet) const noexcept;
  void see(const Stance& stance) noexcept;
  void decide_signs(bool continued) noexcept;
  void turn_by(const Eigen::Vector3f& normal) noexcept;
  [[nodiscard]] double across(std::uint32_t part) noexcept;
  void decide_labels() noexcept;
  struct Meeting;
  using Meetings = std::array<Meeting, simd::kLabels>;
  [[nodiscard]] Meetings meetings(const Sheet& sheet, double& beyond) noexcept;
  [[nodiscard]] std::uint8_t label_of(const Sheet& sheet) noexcept;
  void look(const Points& points, const Stance& stance) noexcept;
  [[nodiscard]] bool sees_from_behind() const noexcept {
    return std::ranges::any_of(std::span(now_.parts).first(now_.part_count), &Part::is_absent);
  }
  [[nodiscard]] bool tells() const noexcept;
  [[nodiscard]] bool write(const Points& points) const noexcept;

  Table now_;
  Table before_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> sheet_of_place_;  // of all places; kMost, kUnsure: none
  std::vector<std::uint32_t> order_;           // of points_, sheet by sheet
  std::vector<Reference> references_;
  std::vector<Reference> remembered_;                          // of the last call
  Eigen::Vector3d remembered_from_ = Eigen::Vector3d::Zero();  // the proxy then
  Eye eye_;
  float radius_ = 0;  // R around the tool, m
  Rise rise_;
  bool touched_ = false;     // at the last call
  bool was_behind_ = false;  // when there was last something to see; absent points do not show it
  bool follows_ = false;
  int pairs_ = 0;  // that may still be compared
};

}  // namespace palpate
