// Sides and labels: how the segments near the tool are seen from it (docs/method.md 2.7).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/segment_view.hpp"
#include "field/selection.hpp"

namespace palpate {

/// The sides of components on which all parts of a rigid tool are: it is on one side of each
/// surface, however many of its parts look at it. Real-time.
class AgreedSides {
 public:
  using Component = SegmentTable::Component;

  /// s in which nobody confirms a side, after which it is forgotten: the pauses in which a hand
  /// that slides lifts off (judgement).
  static constexpr double kKept = 0.02;

  /// `passed`: s since the last update.
  void begin_update(double passed) noexcept;
  /// Gives components the signs that are agreed.
  void turn(std::span<Component> components) noexcept;
  /// A part has decided these; those that are near it are confirmed. The first sign of a component
  /// counts.
  void confirm(std::span<const Component> components) noexcept;
  void forget() noexcept { count_ = 0; }

 private:
  struct Side {
    SegmentTable::Key component;
    int sign = 0;
    double unconfirmed = 0;  // s
  };
  [[nodiscard]] Side* find(const Component& component) noexcept;

  std::array<Side, SegmentTable::kMost> sides_;
  std::size_t count_ = 0;
};

/// Decides which side of each segment near the tool is free, and how the segments meet as seen from
/// there. A decision stands as long as any of the segment's points has weight at the proxy:
/// meanwhile the field depends only on where it is evaluated. Real-time but for construction;
/// bounded in pairs of points that are compared.
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
  [[nodiscard]] bool is_behind() const noexcept { return was_behind_; }

  /// Has all decided again, for a proxy that is where nothing is solid. What was seen on its
  /// path counts.
  void reopen() noexcept;

  /// Forgets what is decided and what was seen.
  void forget() noexcept;

  /// Confirms the sides that are decided here.
  void confirm(AgreedSides& agreed) const noexcept { agreed.confirm(view_.table.components); }

  /// Copies decisions from `other`, if it has any. They hold for the next face() even if no point
  /// is near.
  void follow(const Facing& other) noexcept;

 private:
  using Component = SegmentTable::Component;
  using Segment = SegmentTable::Segment;
  using Point = SegmentView::Point;
  /// A point that is decided and counts for those that are not.
  struct Reference {
    const void* cloud;  // nullptr: one that is gone
    int source;
    Eigen::Vector3f position;
    Eigen::Vector3f normal;  // turned
    float confidence;
    float residual;
    std::uint8_t label;

    // Was it measured at another time than the segment, by the same source? Then it may be what the
    // segment was, or will be, somewhere else.
    [[nodiscard]] bool is_of_another_time(const Segment& segment) const noexcept {
      return source == segment.source && cloud != segment.key.owner;
    }
  };

  void look(const Points& points, const Stance& stance) noexcept;
  [[nodiscard]] bool is_settled(std::span<const ActiveLayer> layers) const noexcept;
  void list_references(const Eigen::Vector3d& proxy, bool vanished) noexcept;
  void add_references(const Segment& segment) noexcept;
  void each_meeting(const Segment& segment, const auto& visit) noexcept;
  void turn_by(const Eigen::Vector3f& normal) noexcept;
  [[nodiscard]] double votes_on(std::uint32_t component) noexcept;
  void decide_signs(bool continued) noexcept;
  void decide_labels() noexcept;
  struct Meeting;
  using Meetings = std::array<Meeting, simd::kLabels>;
  [[nodiscard]] Meetings meetings(const Segment& segment, double& beyond) noexcept;
  [[nodiscard]] std::uint8_t label_of(const Segment& segment) noexcept;
  [[nodiscard]] bool decides() const noexcept;
  [[nodiscard]] bool write(const Points& points) const noexcept;

  SegmentView view_;
  std::vector<Reference> references_;
  std::vector<Reference> remembered_;                          // of the last call
  Eigen::Vector3d remembered_from_ = Eigen::Vector3d::Zero();  // the proxy then
  bool touched_ = false;                                       // at the last call
  bool was_behind_ =
      false;  // when points near it last decided; those behind which it is do not count
  bool follows_ = false;
  int pairs_ = 0;  // that may still be compared
};

}  // namespace palpate
