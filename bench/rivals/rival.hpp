#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"

/// Other published ways to feel depth images and point clouds, each as short as it can be told.
/// They are measured beside palpate and are in no library, no package and at no device.
namespace palpate::rivals {

inline constexpr double kStiffness = 500;  ///< K, N/m; derived: as in table A

/// What a method is given to feel.
struct Shown {
  const DepthFrame* frame = nullptr;  ///< with its T_world_sensor; null: there are points only
  const PointCloud* cloud = nullptr;  ///< the same measurements as points of the world, m
  double spacing = 0;                 ///< s of these points, m
};

/// What a method answers to a place of the hand.
struct Step {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the hand, N, world
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();  ///< m, world
  bool touching = false;
};

/// A method. It is asked every millisecond; it may allocate in show() and never in step().
class Rival {
 public:
  virtual ~Rival() = default;
  /// The first or the next frame.
  virtual void show(const Shown& shown) = 0;
  /// The hand stands at `hip` (m, world) in free air; contact is forgotten.
  virtual void reset(const Eigen::Vector3d& hip) = 0;
  virtual Step step(const Eigen::Vector3d& hip) = 0;
};

/// The least that a method can be given. All are shown the frame where there is one.
enum class Needs {
  points,
  frame,
  filtered_frame,  ///< the frame after palpate's depth filter
};

/// A method by its name, and what a table says of it.
struct Method {
  const char* name;
  const char* after;   ///< whose it is
  const char* rule;    ///< in a few words
  const char* length;  ///< its one free length; empty: palpate's own choice
  double scale = 1;    ///< of that length: the best of 1/2, 1 and 2 (compare_bench --tune)
  Needs needs = Needs::points;
  std::unique_ptr<Rival> (*make)(double scale) = nullptr;
};

/// All of them, palpate's own first.
[[nodiscard]] const std::vector<Method>& methods();

/// @throws Error that lists the names when it is none of them.
[[nodiscard]] const Method& method_named(std::string_view name);

/// K (proxy - hip), and no force where they are at the same place.
[[nodiscard]] Step spring(const Eigen::Vector3d& proxy, const Eigen::Vector3d& hip);

}  // namespace palpate::rivals
