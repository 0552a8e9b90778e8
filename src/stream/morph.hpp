// Declares the policy for depth streams and its input.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "depth/frame_timing.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/shapes.hpp"
#include "stream/block_fates.hpp"
#include "stream/block_matches.hpp"
#include "stream/frame_blocks.hpp"
#include "stream/point_moves.hpp"
#include "stream/point_writer.hpp"
#include "stream/shown_points.hpp"
#include "stream/unseen_points.hpp"

namespace palpate {

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
/// decides: about the same position, or what moves as fast as a hand, and the point goes there;
/// something nearer, and it is hidden and stays, trusted ever less over a minute; something
/// farther, and it is gone. Nothing at all, or a camera that looks elsewhere: it stays for a while.
/// Points appear and go by their presence, which is stiffness.
///
/// FrameBlocks finds what the frame shows, ShownPoints what was shown last, BlockMatches who is
/// who, BlockFates what becomes of each (by fate()), PointMoves how it moves then; PointWriter
/// writes it.
class Morph {
 public:
  explicit Morph(const MorphOptions& options);
  Morph(const Morph&) = delete;
  Morph& operator=(const Morph&) = delete;

  /// Does all that needs no start time. Allocates only to grow.
  void look(const MorphInput& input);

  /// The rest: fills `points`, keeping it as what the next frame starts from. Allocates only to
  /// grow.
  void fill(const MorphInput& input, const FrameTiming& moment,
            const std::shared_ptr<SurfacePoints>& points);

  /// The same with nothing before the frame and no motion.
  void fill_still(const MorphInput& input, const FrameTiming& moment,
                  const std::shared_ptr<SurfacePoints>& points);

  /// Forgets the surface: the next frame begins another.
  void forget() {
    shown_.forget();
    matches_.forget();
  }

 private:
  /// Some blocks of the curve, one thread's at a time.
  struct Piece {
    SettledBlocks settled;
    std::vector<std::pair<std::size_t, EdgeMotion>> edges;  // of points
    std::size_t first = 0;                                  // of the points that blocks show
    PointWriter::Extremes extremes;
  };

  void fill(const MorphInput& input, const FrameTiming& moment,
            const std::shared_ptr<SurfacePoints>& points, bool still);
  void start(const MorphInput& input, const FrameTiming& moment, SurfacePoints& points);
  void settle(std::size_t begin, std::size_t end, std::span<Piece> pieces);
  void write(Piece& piece);
  void write(std::size_t at, const PointMotion& motion, Piece& piece);
  void write(std::size_t at, const PointMotion4& motions, Piece& piece);

  MorphOptions options_;
  FrameBlocks blocks_;
  ShownPoints shown_;
  BlockMatches matches_;
  PointMoves moves_;
  BlockFates fates_;

  // The surface that is being made.
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  bool streams_ = false;  // more than one frame has come
  std::vector<Piece> pieces_;
  UnseenPoints unseen_;
  std::vector<Entry> entries_;
  PointWriter writer_;
};

}  // namespace palpate
