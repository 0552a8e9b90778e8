#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/field/surface_points.hpp"

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

/// What a point meets at either end of its way; share 0: no edge.
struct EdgeWay {
  EdgePlane start;
  EdgePlane end;
};

/// Writes moving points, which come in the order of a curve, into the columns of surface points,
/// using their memory again.
class PointWriter {
 public:
  /// What `points` held is lost. `expected`: about how many points will come.
  void begin(SurfacePoints& points, std::size_t expected);

  void add(std::uint32_t code, const PointState& start, const PointState& end,
           const EdgeWay& edge) {
    if (count_ == room_) make_room(count_ + count_ / 4 + 1024);
    codes_[count_] = code;
    starts_[count_] = start.position;
    SurfacePoints& p = *points_;
    p.normals[count_] = start.normal;
    p.density_weights[count_] = start.weight;
    p.radii[count_] = start.radius;
    p.confidences[count_] = start.confidence;
    p.presences[count_] = start.presence;
    p.end_positions[count_] = end.position;
    p.end_normals[count_] = end.normal;
    p.end_density_weights[count_] = end.weight;
    p.end_radii[count_] = end.radius;
    p.end_confidences[count_] = end.confidence;
    p.end_presences[count_] = end.presence;
    const bool beside = edge.start.share != 0 || edge.end.share != 0;
    p.edges.of_point[count_] = beside ? add_edge(edge) : PointEdges::kNone;
    unsure_ = unsure_ || start.presence < 1 || end.presence < 1;
    ++count_;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Indexes the points and finishes them as palpate::finish() does.
  void end();

 private:
  void make_room(std::size_t room);
  [[nodiscard]] std::uint32_t add_edge(const EdgeWay& edge);
  void measure_reach();
  void measure_radii();

  SurfacePoints* points_ = nullptr;
  std::vector<Eigen::Vector3f> starts_;
  std::vector<std::uint32_t> codes_;
  std::vector<float> sample_;
  std::size_t count_ = 0;
  std::size_t room_ = 0;
  bool unsure_ = false;
};

}  // namespace palpate
