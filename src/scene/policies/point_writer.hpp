#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "scene/policies/block_entries.hpp"
#include "scene/policies/lanes.hpp"

namespace palpate {

/// A point at one end of its way.
struct PointState {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to the points' origin, m
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, or zero
  float weight = 0;                                    ///< a_i
  float radius = 0;                                    ///< R_i, m
  float confidence = 0;                                ///< c_i
  float presence = 1;
};

/// Of points side by side.
struct PointStates {
  Vectors position, normal;
  Floats weight, radius, confidence, presence;
};

/// What a point meets at either end of its way; share 0: no edge.
struct EdgeWay {
  SurfacePoints::EdgePlane start;
  SurfacePoints::EdgePlane end;
};

/// Of a point while a snapshot lasts.
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
  /// What is to be known of all points together.
  struct Extremes {
    Floats radius = Floats{} + std::numeric_limits<float>::max();  ///< the smallest in each lane, m
    Floats presence = Floats{} + 1.0f;                             ///< the least

    void add(const Extremes& other) {
      radius = least(radius, other.radius);
      presence = least(presence, other.presence);
    }
  };

  /// What `points` held is lost. `expected`: about how many points will come.
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
