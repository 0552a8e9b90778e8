// Declares what writes moving points into columns.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "stream/lanes.hpp"
#include "stream/moving_points.hpp"

namespace palpate {

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

  /// Makes room for so many points behind those there are; returns where. Allocates only to grow.
  std::size_t append(std::size_t count);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Writes a point into the room for it. Codes of points never fall.
  void write(std::size_t at, const PointMotion& motion, Extremes& extremes);

  /// Writes points side by side that lie beside no edge.
  void write(std::size_t at, const std::uint32_t* codes, const PointStates& from,
             const PointStates& to, Extremes& extremes);

  /// Puts a written point beside an edge. One thread, in rising order of points.
  void add_edge(std::size_t at, const EdgeMotion& edge);

  /// Writes where the next of the last points was seen from: a point that is new, from the eye of
  /// all others.
  void add_eye(const PointMotion& motion);

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
