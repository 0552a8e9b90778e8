#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/field/surface_points.hpp"
#include "scene/policies/lanes.hpp"

namespace palpate {

/// The blocks of an image along a Z-order curve, on which neighbours in the image stay near each
/// other: points in this order are indexed without sorting.
struct BlockOrder {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint32_t> blocks;  ///< in the curve's order; row by row numbers
  std::vector<std::uint32_t> codes;   ///< where on the curve, rising; two bits a level

  [[nodiscard]] std::size_t size() const { return blocks.size(); }
};

/// @param columns, rows: 0 to 32768.
[[nodiscard]] BlockOrder make_block_order(int columns, int rows);

/// Calls visit(block) for those around a block, row by row.
template <class Visit>
void visit_beside(int columns, int rows, std::size_t block, const Visit& visit) {
  const int u = static_cast<int>(block) % columns;
  const int v = static_cast<int>(block) / columns;
  for (int y = std::max(0, v - 1); y <= std::min(rows - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(columns - 1, u + 1); ++x) {
      const auto other = static_cast<std::size_t>(y * columns + x);
      if (other != block) visit(other);
    }
  }
}

/// The state of a point of a morphing surface.
enum class EntryKind : std::uint8_t {
  live,     ///< the surface that a block shows, or showed last
  hidden,   ///< by what the block shows
  going,    ///< has been seen through, and is trusted less and less
  leaving,  ///< nobody feels it any more: its weight goes over one frame
  outside,  ///< has left the image, which a moving camera looks elsewhere now
};

/// Remembers of a point what the field does not need.
struct Entry {
  double confirmed = 0;          ///< stamp of the last frame that showed it, or what hides it, s
  float variance = 0;            ///< of where it is along its ray, m^2
  std::uint32_t place : 29 = 0;  ///< of its block on the curve
  EntryKind kind : 3 = EntryKind::live;
};

/// Lists which entries are at which block.
class BlockEntries {
 public:
  /// Entries by their places on the curve, equal places in rising order of entries.
  void sort(std::span<const Entry> entries, std::size_t blocks);

  /// Numbers of the entries at a place of the curve.
  [[nodiscard]] std::span<const std::uint32_t> at(std::size_t place) const {
    return std::span(sorted_).subspan(begin_[place], begin_[place + 1] - begin_[place]);
  }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no entry

  /// The first of four entries that follow one another, one at each of four places; else kNone.
  [[nodiscard]] std::uint32_t four_at(std::size_t place) const {
    const std::uint32_t begin = begin_[place];
    if (begin_[place + kLanes] != begin + kLanes) return kNone;
    const Ints one = load<Ints>(&begin_[place + 1]) - load<Ints>(&begin_[place]) == 1;
    const auto entries = load<Ints>(&sorted_[begin]);
    return all(one & (entries == entries[0] + Ints{0, 1, 2, 3})) ? sorted_[begin] : kNone;
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> sorted_;
};

/// A point at one end of its way.
struct PointState {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to the points' origin, m
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, or zero
  float weight = 0;                                    ///< a_i
  float radius = 0;                                    ///< R_i, m
  float confidence = 0;                                ///< c_i
  float presence = 1;
};

/// Four points side by side.
struct PointStates {
  Vectors position, normal;
  Floats weight, radius, confidence, presence;
};

/// The edges beside a point at both ends of its path; share 0: none.
struct EdgeWay {
  SurfacePoints::EdgePlane start;
  SurfacePoints::EdgePlane end;
};

/// A point while a snapshot lasts.
struct Way {
  PointState from;
  PointState to;
  EdgeWay edge;
  Entry entry;
  std::uint32_t code = 0;  ///< of its place in the index, never falling from point to point
};

/// Writes moving points into the columns of surface points, using their memory again. Several
/// threads may write points of their own.
class PointWriter {
 public:
  /// The extremes of all points together.
  struct Extremes {
    Floats radius = Floats{} + std::numeric_limits<float>::max();  ///< the smallest in each lane, m
    Floats presence = Floats{} + 1.0f;                             ///< the least

    void add(const Extremes& other) {
      radius = least(radius, other.radius);
      presence = least(presence, other.presence);
    }
  };

  /// Discards what `points` held. `expected`: about how many points will come.
  void begin(SurfacePoints& points, std::size_t expected);

  /// Makes room for so many points behind those there are; tells where. Allocates only to grow.
  std::size_t append(std::size_t count);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Writes a point into the room for it. Codes of points never fall.
  void write(std::size_t at, const Way& way, Extremes& extremes);

  /// Writes points side by side that lie beside no edge.
  void write(std::size_t at, const std::uint32_t* codes, const PointStates& from,
             const PointStates& to, Extremes& extremes);

  /// Puts a written point beside an edge. One thread, in rising order of points.
  void add_edge(std::size_t at, const EdgeWay& edge);

  /// Indexes the points and finishes them as palpate::finish() does.
  void end(const Extremes& extremes);

 private:
  void make_room(std::size_t room);
  void measure_reach();
  void measure_radii();

  SurfacePoints* points_ = nullptr;
  std::vector<Eigen::Vector3f> starts_;
  std::vector<std::uint32_t> codes_;
  std::vector<float> sample_;
  std::size_t count_ = 0;
  std::size_t room_ = 0;
};

}  // namespace palpate
