// Declares the policy for depth streams, its options and its input.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/shapes.hpp"
#include "scene/frame_timing.hpp"
#include "scene/policies/block_surface.hpp"
#include "scene/policies/fate.hpp"
#include "scene/policies/point_writer.hpp"

namespace palpate {

struct MorphOptions {
  double silence = 0.3;  ///< a point that nothing confirmed for so long begins to fade, s
  double fade = 0.5;     ///< in which it fades away, s
  Kernel kernel = Kernel::wyvill;
  double minimum_radius = 0;  ///< no R below this, m
};

/// A filtered depth frame, and where to look at it closely.
struct MorphInput {
  const FilteredDepth& depth;
  Pinhole pinhole;                ///< of the undistorted image
  std::span<const Ball> reach{};  ///< where weights beside rims are exact; world frame
  bool everywhere = true;         ///< exact weights everywhere
  bool last = false;              ///< no frame follows: what it shows is there in full at the end
};

/// The policy for depth streams (docs/architecture.md, Time): the points of the blocks move, while
/// a snapshot lasts, from where the surface is at its start to where the new frame has them. So
/// whenever a frame comes, the surface goes on without a step.
///
/// A point's identity is its block, or where a moving camera sees it now. What a block shows next
/// decides: about the same place, or what moves as fast as a hand, and the point goes there;
/// something nearer, and it is hidden and stays, trusted ever less over a minute; something
/// farther, and it is gone. Nothing at all, or a camera that looks elsewhere: it stays for a while.
/// Points appear and go by their presence, which is stiffness.
class Morph {
 public:
  explicit Morph(const MorphOptions& options)
      : options_(options), surface_(options.kernel, options.minimum_radius) {}

  /// Does all that needs no start time. Allocates only to grow.
  void look(const MorphInput& input);

  /// The rest: fills `points`, keeping it as what the next frame starts from. Allocates only to
  /// grow.
  void fill(const MorphInput& input, const FrameTiming& moment,
            const std::shared_ptr<SurfacePoints>& points);

  /// The same with nothing before the frame and no motion.
  void fill_still(const MorphInput& input, const FrameTiming& moment,
                  const std::shared_ptr<SurfacePoints>& points);

  /// There is no surface any more.
  void forget();

 private:
  static constexpr std::uint32_t kNone = EdgeFinder::kNone;  // no point

  // A block is much less sure than what is known from this ratio of variances on, and agrees with
  // it within so many deviations of the difference.
  static constexpr float kUnsure = 4;
  static constexpr float kAgree = 5;  // judgement, both (docs/method.md 7.3)

  // Share by which a point's radius, confidence and edge follow a frame (docs/method.md 7.3).
  static constexpr float kShare = 0.25f;

  // The least cosine of the angle between the normals of one surface before and after a frame: 60
  // degrees (judgement; docs/method.md 7.3).
  static constexpr float kTurns = 0.5f;

  /// The point that the frame shows at a place of the curve; R = 0: none.
  struct alignas(64) Point {
    PointState state;
    float area = 0;  // a_i R_i^2
    float trust = 1;
    float variance = 0;  // along the ray, m^2
    std::uint32_t place = 0;
    std::uint32_t edge = kNone;  // the finder's

    [[nodiscard]] float weight(float radius) const {
      return trust * std::min(1.0f, area / (radius * radius));
    }
  };
  /// The same of four places.
  struct Four {
    Vectors position, normal;
    Floats radius, confidence, area, trust, variance;
    Ints edges;
    std::uint32_t place;  // the first
  };
  /// Four points that their blocks show again, at both ends of their paths.
  struct FourWays {
    PointStates from, to;
    Floats variance;
    std::uint32_t place;  // the first
  };
  /// Some places of the curve, one thread's at a time.
  struct Piece {
    std::vector<FourWays> going_on;
    std::vector<Way> shown;   // of places where there is more to decide, in their order
    std::vector<Way> unseen;  // points that no block shows
    std::vector<std::pair<std::size_t, EdgeWay>> edges;  // of points
    std::size_t count = 0;                               // of points that blocks show
    std::size_t first = 0;                               // of them
    PointWriter::Extremes extremes;
  };

  void start(const MorphInput& input, const FrameTiming& moment, SurfacePoints& points);
  void measure(const MorphInput& input);
  void follow_camera(const MorphInput& input);
  void settle(const FilteredDepth& depth, std::size_t begin, std::size_t end);
  void look_at(const FilteredDepth& depth, std::size_t begin, std::size_t end, Piece& piece) const;
  void settle(const FilteredDepth& depth, const Point& point, Piece& to) const;
  void gather_unseen(const Piece& piece);
  void write(Piece& piece);
  void write(std::size_t at, const Way& way, Piece& piece);
  void write(std::size_t at, const FourWays& ways, Piece& piece);
  void write_unseen();
  [[nodiscard]] bool goes_on(const Four& seen, FourWays& ways) const;
  [[nodiscard]] PointStates old_points(std::uint32_t i) const;
  void follow(const Four& seen, FourWays& ways) const;
  [[nodiscard]] static Point point_of(const Four& seen, int lane);
  [[nodiscard]] bool is_sure(const FilteredDepth& depth, const Point& point, std::uint32_t partner,
                             const PointState& before) const;
  [[nodiscard]] Way way_of(Fate fate, std::uint32_t i) const;
  [[nodiscard]] PointState old_point(std::uint32_t i) const;
  [[nodiscard]] float depth_of(const Eigen::Vector3f& position) const;
  [[nodiscard]] float speed_of(std::uint32_t i) const;
  [[nodiscard]] float share_of(double time) const;
  void prefetch(const FilteredDepth& depth, std::size_t place) const;
  [[nodiscard]] Four new_points(const FilteredDepth& depth, std::size_t place) const;
  [[nodiscard]] std::uint32_t partner_of(const FilteredDepth& depth,
                                         std::span<const std::uint32_t> old, const Point& seen,
                                         PointState& before) const;
  [[nodiscard]] float beside(const FilteredDepth& depth, std::size_t block) const;
  [[nodiscard]] static float advance_of(const Point& seen, const Eigen::Vector3f& from);
  [[nodiscard]] static bool turns(const Point& seen, const Eigen::Vector3f& normal);
  [[nodiscard]] bool turns_away(const Point& seen, std::uint32_t i, const PointState& before) const;
  [[nodiscard]] bool may_move(const FilteredDepth& depth, const Point& seen, std::uint32_t i,
                              const PointState& before) const;
  [[nodiscard]] bool stays(const FilteredDepth& depth, const Point& seen,
                           const PointState& before) const;
  [[nodiscard]] bool came_aside(const Point& seen) const;
  [[nodiscard]] bool may_hide(std::span<const std::uint32_t> old, std::uint32_t i) const;
  [[nodiscard]] float gain_of(const Point& seen, float known, float advance) const;
  [[nodiscard]] Way follow(const Point& seen, std::uint32_t i, const PointState& from) const;
  [[nodiscard]] EdgeWay edge_of(const Point& seen, std::uint32_t i) const;
  [[nodiscard]] Way appear(const Point& point) const;
  [[nodiscard]] Way hold(std::uint32_t i, EntryKind kind) const;
  [[nodiscard]] Way hide(std::uint32_t i) const;
  [[nodiscard]] Way go(std::uint32_t i) const;
  [[nodiscard]] Way keep(std::uint32_t i, const PointState& from, float presence, EntryKind kind,
                         double confirmed) const;
  [[nodiscard]] Way leave(std::uint32_t i) const;
  static void leave(Way& way);
  void add(Way way, const Point& at, Piece& to) const;
  [[nodiscard]] SurfacePoints::EdgePlane old_edge(std::uint32_t i) const;
  [[nodiscard]] SurfacePoints::EdgePlane new_edge(const Point& point) const;

  MorphOptions options_;
  BlockOrder order_;
  BlockSurface surface_;
  EdgeFinder edges_;
  PointWriter writer_;
  std::vector<Ball> local_reach_;

  // The surface that was shown last.
  std::shared_ptr<const SurfacePoints> last_;
  FrameTiming last_moment_;
  std::vector<Entry> entries_;  // of its points
  BlockEntries by_block_;
  std::vector<std::uint32_t> place_of_block_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();

  // The surface that is being made.
  FrameTiming moment_;
  float comes_ = 1;       // presence that what is seen gains
  float doubt_ = 1;       // by which variances of what is known grow
  bool ends_ = false;     // no frame follows
  bool streams_ = false;  // more than one frame has come: what varies among them counts for less
  double progress_ = 1;   // of what was shown last, at the new start
  bool moved_ = false;    // the camera, or its image has another size
  bool still_ = false;
  bool resized_ = false;  // the image, since what was shown last
  std::vector<Piece> pieces_;
  PointWriter::Extremes extremes_;
  std::vector<Entry> next_entries_;
  std::vector<Way> unseen_;                  // points that no block shows
  std::vector<std::uint64_t> unseen_order_;  // their codes, and places among them
  std::vector<std::uint64_t> sorting_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3f turn_ = Eigen::Matrix3f::Identity();  // sensor to world
  Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f old_shift_ = Eigen::Vector3f::Zero();  // from the last origin to this one
  std::size_t held_ = 0;  // points that no block shows; as many as there are blocks may be
};

}  // namespace palpate
