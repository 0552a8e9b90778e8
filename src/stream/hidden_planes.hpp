// Declares the planes of a depth frame that go on behind what hides them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "palpate/field/field_options.hpp"
#include "stream/block_faces.hpp"
#include "stream/padded_blocks.hpp"

namespace palpate {

/// Continues planes behind what hides them, along rows and columns of blocks (docs/method.md 6.8):
/// from the far side of a depth jump to where the image shows the same plane again. Where it does
/// not, the plane ends at its rim.
class HiddenPlanes {
 public:
  /// A point of such a plane; nobody saw it.
  struct Point {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< sensor frame, m
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit
    float radius = 0;                                    ///< R, m; 0: there is none
    float area = 0;                                      ///< a R^2, m^2
    float confidence = 0;                                ///< of the normal, 0-1
    float length = std::numeric_limits<float>::max();    ///< of what is hidden along the line, m
  };

  explicit HiddenPlanes(Kernel kernel) : kernel_(kernel) {}

  /// Forgets the frame before. `padded`: where the blocks are. Allocates only to grow.
  void find(const BlockFaces& faces, const PaddedBlocks& padded);

  /// The blocks behind which a plane goes on, in rising order.
  [[nodiscard]] const std::vector<std::uint32_t>& blocks() const { return blocks_; }
  /// The point behind one of these; elsewhere one with R = 0.
  [[nodiscard]] const Point& at(std::size_t block) const { return points_[block]; }
  /// Does the surface that the block shows go on within R of it, so that it has no rim there?
  [[nodiscard]] bool joins(std::size_t block) const { return (notes_[block] & kJoins) != 0; }

 private:
  static constexpr std::uint8_t kJoins = 8;  // a bit

  /// A row or column of blocks.
  struct Line {
    const BlockFaces& faces;
    std::size_t first;
    std::ptrdiff_t by;
    int length;

    [[nodiscard]] bool holds(int i) const { return i >= 0 && i < length; }
    [[nodiscard]] std::size_t at(int i) const { return first + static_cast<std::size_t>(i * by); }
    [[nodiscard]] bool empty(int i) const { return faces.radii[at(i)] == 0; }
  };
  /// Indices on a line: where the plane is seen, is hidden first, and is seen again.
  struct Gap {
    int seen, rim, again;
  };

  void mark(const BlockFaces& faces, const PaddedBlocks& padded, int v);
  void look_at(const Line& line, int i);
  [[nodiscard]] static std::optional<Gap> gap_at(const Line& line, int far, int step);
  void fill(const Line& line, const Gap& gap);
  void join(const Line& line, int i, int step, const Point& point);
  [[nodiscard]] Point between(const Line& line, const Gap& gap, int i) const;
  template <class Visit>
  void each_noted(std::size_t first, std::size_t count, std::uint8_t what,
                  const Visit& visit) const;
  [[nodiscard]] static bool is_hidden(const Line& line, const Gap& gap, int i, const Point& point);

  Kernel kernel_;
  // For each block: is there a jump to the one on the left, or above, a point behind it, or
  // one that its surface joins?
  std::vector<std::uint8_t> notes_;
  std::vector<Point> points_;  // of blocks
  std::vector<std::uint32_t> blocks_;
};

}  // namespace palpate
