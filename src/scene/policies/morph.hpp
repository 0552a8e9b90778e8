#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "palpate/depth/filtered_depth.hpp"
#include "palpate/geometry/ball.hpp"
#include "palpate/geometry/pinhole.hpp"
#include "scene/policies/block_entries.hpp"
#include "scene/policies/block_order.hpp"
#include "scene/policies/block_surface.hpp"
#include "scene/policies/edge_finder.hpp"
#include "scene/policies/moment.hpp"
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
/// What appears and goes does so by its presence, which is stiffness.
class Morph {
 public:
  explicit Morph(const MorphOptions& options)
      : options_(options), surface_(options.kernel, options.minimum_radius) {}

  /// What can be done of a frame before it is known when it starts. Allocates only to grow.
  void look(const MorphInput& input);

  /// The rest: fills `points`, keeping it as what the next frame starts from. Allocates only to
  /// grow.
  void fill(const MorphInput& input, const Moment& moment,
            const std::shared_ptr<SurfacePoints>& points);

  /// Likewise, with nothing before the frame and no motion.
  void fill_still(const MorphInput& input, const Moment& moment,
                  const std::shared_ptr<SurfacePoints>& points);

  /// There is no surface any more.
  void forget();

 private:
  struct alignas(64) Point {
    PointState state;
    float area = 0;  // a_i R_i^2
    float trust = 1;
    float variance = 0;  // along the ray, m^2

    [[nodiscard]] float weight(float radius) const {
      return trust * std::min(1.0f, area / (radius * radius));
    }
  };
  struct Unseen {
    PointState from;
    PointState to;
    EdgeWay edge;
    Entry entry;
  };

  void start(const MorphInput& input, const Moment& moment, SurfacePoints& points);
  void measure(const MorphInput& input);
  void follow_camera(const MorphInput& input);
  void settle(const FilteredDepth& depth, std::size_t place);
  void write_unseen();
  void hold_one(std::span<const std::uint32_t> old);
  [[nodiscard]] PointState old_point(std::uint32_t i) const;
  [[nodiscard]] float depth_of(const Eigen::Vector3f& position) const;
  [[nodiscard]] float speed_of(std::uint32_t i) const;
  [[nodiscard]] float share_of(double time) const;
  [[nodiscard]] Point new_point(const FilteredDepth& depth, std::size_t block) const;
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
  void follow(const Point& seen, std::uint32_t i, const PointState& from);
  void appear(const Point& point);
  void hold(std::uint32_t i, EntryKind kind);
  void hide(std::uint32_t i);
  void go(std::uint32_t i);
  void keep(std::uint32_t i, const PointState& from, float presence, EntryKind kind,
            double confirmed);
  void leave(std::uint32_t i);
  void add(const PointState& from, const PointState& to, const EdgeWay& edge, const Entry& entry);
  [[nodiscard]] EdgePlane old_edge(std::uint32_t i) const;
  [[nodiscard]] EdgePlane new_edge() const;

  MorphOptions options_;
  BlockOrder order_;
  BlockSurface surface_;
  EdgeFinder edges_;
  PointWriter writer_;
  std::vector<Ball> local_reach_;

  // What was shown last.
  std::shared_ptr<const SurfacePoints> last_;
  Moment last_moment_;
  std::vector<Entry> entries_;  // of its points
  BlockEntries by_block_;
  std::vector<std::uint32_t> place_of_block_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();

  // What is being made.
  Moment moment_;
  float comes_ = 1;       // presence that what is seen gains
  float doubt_ = 1;       // by which variances of what is known grow
  bool ends_ = false;     // no frame follows
  bool streams_ = false;  // more than one frame has come: what varies among them counts for less
  double progress_ = 1;   // of what was shown last, at the new start
  bool moved_ = false;    // the camera, or its image has another size
  bool still_ = false;
  bool resized_ = false;  // the image, since what was shown last
  std::uint32_t place_ = 0;
  std::vector<Point> points_;  // that the frame shows, row by row; R = 0: none
  std::vector<Entry> next_entries_;
  std::vector<Unseen> unseen_;               // points that no block shows
  std::vector<std::uint64_t> unseen_order_;  // their codes, and places among them
  std::vector<std::uint64_t> sorting_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3f turn_ = Eigen::Matrix3f::Identity();  // sensor to world
  Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f old_shift_ = Eigen::Vector3f::Zero();  // from the last origin to this one
  std::size_t held_ = 0;  // points that no block shows; as many as there are blocks may be
};

}  // namespace palpate
