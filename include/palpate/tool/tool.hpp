// What touches, if it is not a point: the surface of a rigid tool or a gripper as samples.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "palpate/geometry/pose.hpp"

namespace palpate {

/// Samples of the surface of a rigid tool or of a gripper with two fingers: what a ToolProxy keeps
/// out of all that is solid. All positions are from the handle, in the tool's axes, in metres.
///
/// `spacing` (m) of the shapes below is how far samples are apart at most, along edges and in rows;
/// on a mesh's faces no circle without a sample has a radius above some 1.2 of it. Half of the
/// support radius R of what is touched lets nothing as large as R between them. Immutable: one tool
/// serves any number of proxies and threads.
class Tool {
 public:
  /// A ball of the surface; a point where its radius is 0.
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, at an opening of 0
    double radius = 0;                                   ///< m
    int side = 0;  ///< of its finger: +1 and -1 move along the axis and against it by half of the
                   ///< opening; 0 does not
  };

  /// A ball around some samples of one side, and around their own radii.
  struct Node {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m, at an opening of 0
    double radius = 0;                                 ///< m
    int side = 0;
    std::uint32_t begin = 0;  ///< of its samples
    std::uint32_t end = 0;
    std::int32_t left = -1;  ///< node of the first half of its samples; -1: not divided further
    std::int32_t right = -1;
  };

  /// Corners of a triangle, as indices of vertices.
  using Triangle = std::array<std::uint32_t, 3>;

  /// Corners of a triangle, m, at an opening of 0.
  using Face = std::array<Eigen::Vector3f, 3>;

  static constexpr std::size_t kMostSamples = 100'000;  ///< some 10 MB; more is a typing error

  /// m from the handle: nobody holds a longer tool, which may be one in other units.
  static constexpr double kLongest = 10;

  /// `axis` is the direction in which the finger of side +1 opens. Orders the samples anew, but for
  /// those of a tool: with its axis they make the same tool again, bit for bit.
  /// @throws Error without samples or with more than kMostSamples, for one that is not finite, is
  /// farther out than kLongest, has a radius below 0 or a side other than -1, 0 and 1, and for an
  /// axis without a direction.
  explicit Tool(std::vector<Point> samples, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX());

  /// One ball around the handle: the proxy of three degrees of freedom with its tool radius.
  /// This and the following throw Error for lengths (m) that are not finite and above 0.
  [[nodiscard]] static Tool ball(double radius);
  /// A stylus: balls on a line from the handle to -length z, so dense that it is less than 1 %
  /// thinner between them.
  [[nodiscard]] static Tool capsule(double length, double radius, double spacing);
  /// Edges along the axes.
  [[nodiscard]] static Tool box(const Eigen::Vector3d& size, double spacing,
                                const Eigen::Vector3d& center = Eigen::Vector3d::Zero());
  /// Along z, with flat ends.
  [[nodiscard]] static Tool cylinder(double length, double radius, double spacing,
                                     const Eigen::Vector3d& center = Eigen::Vector3d::Zero());
  /// Two boxes of this size from z = 0 to -size.z: their inner faces meet in x = 0 at an opening of
  /// 0, and move apart along x.
  [[nodiscard]] static Tool gripper(const Eigen::Vector3d& finger, double spacing);
  /// The surface of a mesh: all its corners, points along its creases (more than 20 degrees) and
  /// rims, and on its faces; vertices in one position count as one. The handle is at the origin.
  /// @throws Error also if an index is beyond the vertices, a vertex is not finite, or no triangle
  /// has an area.
  [[nodiscard]] static Tool mesh(std::span<const Eigen::Vector3d> vertices,
                                 std::span<const Triangle> triangles, double spacing);
  /// A shape by name, sizes in millimetres: ball:R, capsule:LxR, cylinder:LxR, box:XxYxZ,
  /// gripper:XxYxZ; as above, R a radius and L a length. Of a ball or a stylus whose radius is more
  /// than 0.6 spacings the surface is sampled: a ball of a sample would sink into points.
  /// @throws Error that names what is wrong, and how to write it.
  [[nodiscard]] static Tool from_text(std::string_view text, double spacing);

  [[nodiscard]] std::span<const Point> samples() const noexcept { return samples_; }
  /// A binary tree of balls for each side, children after their parents.
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  /// The nodes that hold all samples of a side.
  [[nodiscard]] std::span<const std::int32_t> roots() const noexcept { return roots_; }
  /// What a mesh of 50 000 faces at most looks like, for pictures; empty: the convex hull of the
  /// samples of each side.
  [[nodiscard]] std::span<const Face> faces() const noexcept { return faces_; }
  /// Unit vector.
  [[nodiscard]] const Eigen::Vector3d& axis() const noexcept { return axis_; }
  /// Does anything move with the opening?
  [[nodiscard]] bool opens() const noexcept {
    return samples_.front().side != 0 || samples_.back().side != 0;  // they are in order of sides
  }
  /// The farthest that anything is from the handle at an opening of 0, m.
  [[nodiscard]] double extent() const noexcept { return extent_; }
  /// Radius of gyration about the handle: root mean square distance of the samples, m.
  [[nodiscard]] double gyration() const noexcept { return gyration_; }

  /// Where a position of the tool of this side is in the world, m.
  [[nodiscard]] Eigen::Vector3d in_world(const Eigen::Vector3d& position, int side,
                                         const Pose& pose) const noexcept {
    const double opened = 0.5 * side * pose.opening;
    return pose.position + pose.orientation * (position + opened * axis_);
  }

 private:
  std::int32_t add_node(std::uint32_t begin, std::uint32_t end);

  std::vector<Point> samples_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> roots_;
  std::vector<Face> faces_;
  Eigen::Vector3d axis_;
  double extent_ = 0;
  double gyration_ = 0;
};

}  // namespace palpate
