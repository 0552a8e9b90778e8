// Describes the points of a morphing surface while a snapshot lasts.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "palpate/field/surface_points.hpp"
#include "stream/lanes.hpp"

namespace palpate {

/// The state of a point of a morphing surface.
enum class EntryKind : std::uint8_t {
  live,          ///< the surface that a block shows, or showed last
  hidden,        ///< by what the block shows
  going,         ///< has been seen through, and is trusted less and less
  removed,       ///< cannot be felt any more: its weight goes over one frame
  out_of_range,  ///< outside of the image, since a moving camera looks elsewhere now
  supposed,      ///< of a plane that goes on behind what its block shows: nobody saw it
};

/// Remembers of a point what the field does not need.
struct Entry {
  double confirmed = 0;          ///< stamp of the last frame that showed it, or what hides it, s
  float variance = 0;            ///< of where it is along its ray, m^2
  std::uint32_t index : 29 = 0;  ///< of its block on the curve
  EntryKind kind : 3 = EntryKind::live;
};

/// A point at one end of its motion.
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

/// The edges beside a point at both ends of its motion; share 0: none.
struct EdgeMotion {
  SurfacePoints::EdgePlane start;
  SurfacePoints::EdgePlane end;
};

/// A point while a snapshot lasts.
struct PointMotion {
  PointState from;
  PointState to;
  EdgeMotion edge;
  Entry entry;
  std::uint32_t code = 0;  ///< of its position in the index, never falling from point to point
  /// Unit, to where it was seen from; of an old point that no block shows. Zero: from here.
  Eigen::Vector3f to_eye = Eigen::Vector3f::Zero();
};

/// Four points that their blocks show again, at both ends of their motions.
struct PointMotion4 {
  PointStates from, to;
  Floats variance;
  std::uint32_t index;  ///< the first
};

}  // namespace palpate
