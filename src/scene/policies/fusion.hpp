#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/source.hpp"
#include "scene/frame_timing.hpp"

namespace palpate {

/// The policies that weigh whole clouds: replace, average and crossfade (docs/method.md 7.2).
/// Clouds are indexed once and shared by the snapshots that they count in.
class LayerHistory {
 public:
  /// `policy`: one of the three. `history`: N.
  LayerHistory(Policy policy, int history) : policy_(policy), history_(history) {}

  /// Fills `layers` with the newest cloud and those before it. Weights sum to 1 at every time, and
  /// under crossfade they go on from what they are at the moment's start.
  void add(std::shared_ptr<const SurfacePoints> newest, const FrameTiming& moment,
           std::vector<Snapshot::Layer>& layers);

  void forget() { layers_.clear(); }

 private:
  void age(const FrameTiming& moment);
  void drop();
  void weigh();

  Policy policy_;
  int history_;
  FrameTiming last_;
  std::vector<Snapshot::Layer> layers_;  // oldest first
};

/// The policy for clouds of a scene that stands still: a running mean in each voxel, over about
/// eight clouds, whose points go in straight lines from one mean to the next
/// (docs/method.md 7.2). A voxel that no cloud fills any more fades away.
class Fusion {
 public:
  explicit Fusion(const PrepareOptions& prepare) : prepare_(prepare) {}

  /// Mixes one more cloud in, which is in the sensor's frame. Points that are not finite, or lie
  /// farther off than voxels can be counted, are left out.
  /// `one_view`: all of them so far were seen from their viewpoints, their normals are by these
  /// alone.
  /// @throws Error as prepare() does; then nothing has changed.
  void add(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor, bool one_view = false);

  /// The surface from that cloud on.
  [[nodiscard]] SurfacePoints surface(const FrameTiming& moment);

  [[nodiscard]] const Prepared::Report& report() const { return prepared_.report; }

  /// Nothing is shown any more; what was mixed stays, and fades in again.
  void forget() {
    for (auto& [key, voxel] : voxels_) voxel.start = voxel.end = {};
  }

 private:
  using Key = std::array<std::int32_t, 3>;

  /// What a voxel's point was when a snapshot ended; relative to origin_.
  struct Shown {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float weight = 0;
    float radius = 0;
    float confidence = 0;
  };

  struct Voxel {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< of points in a cloud, running mean, m
    double count = 0;                               ///< of points in a cloud, running mean
    double occupancy = 0;                           ///< 0-1: share of clouds that fill it
    int clouds = 0;
    Shown start;  ///< of the snapshot that is being made
    Shown end;

    [[nodiscard]] Eigen::Vector3d mean() const { return sum / count; }
  };

  [[nodiscard]] std::vector<Eigen::Vector3d> usable(const PointCloud& cloud,
                                                    const Eigen::Isometry3d& T_world_sensor) const;
  void age(const FrameTiming& moment);
  void choose_leaf(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor);
  void mix(const std::vector<Eigen::Vector3d>& points);
  [[nodiscard]] PointCloud means() const;
  void show();
  [[nodiscard]] SurfacePoints place(const SurfacePoints& ends) const;

  PrepareOptions prepare_;
  double leaf_ = 0;                     // m; 0: no cloud yet
  std::size_t told_by_ = 0;             // points of the cloud that told it
  std::optional<Eigen::Vector3d> eye_;  // of the first cloud, m, world
  bool one_eye_ = true;                 // all clouds were seen from there
  bool one_view_ = false;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  FrameTiming last_;
  Prepared prepared_;            // of the running means
  std::map<Key, Voxel> voxels_;  // in a fixed order
};

}  // namespace palpate
