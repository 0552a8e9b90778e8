// Prepares a large static cloud, in memory or on disk, block by block: what tools come near first.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <stop_token>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/source.hpp"

namespace palpate {

/// A large static cloud that becomes a source's surface block by block: those that tools come near
/// first, then the rest, until all is as Source::set() would make it. A store on disk stays there:
/// what is around the tools is read, prepared and kept while there is memory for it. Where a block
/// is there, forces are those of the whole, bit for bit, where prepare() goes by blocks; else they
/// are nearly those, and the whole fades in at the end. Where it is missing there is no surface,
/// as FieldNote::not_loaded reports; once it is there its presence goes from 0 to 1 in 0.1 s, so
/// that it pushes nobody.
///
/// Owns no thread: one thread calls advance() again and again. What it publishes depends on how
/// fast it is: runs that are to repeat use Source::set().
class OnDemand {
 public:
  /// Is the cloud so large that a person would wait for it, and prepared with options that allow
  /// it?
  [[nodiscard]] static bool suits(const PointCloud& cloud, const PrepareOptions& options);

  /// Measures the cloud's facts and divides it, which takes about a second for 10 million points.
  /// @throws Error as prepare() does.
  OnDemand(const std::shared_ptr<const PointCloud>& cloud, const PrepareOptions& options,
           const Eigen::Isometry3d& T_world_sensor = Eigen::Isometry3d::Identity());

  /// Reads some hundred nodes to measure the facts, if the options give none. Nodes and prepared
  /// blocks take at most `memory` bytes; what is shown, at most half a million points, and the
  /// block that is being prepared come to it.
  /// @throws Error as prepare() and PointStore::read() do, and for options that need all points.
  OnDemand(const std::shared_ptr<const PointStore>& store, const PrepareOptions& options,
           const Eigen::Isometry3d& T_world_sensor, std::size_t memory);
  ~OnDemand();
  OnDemand(const OnDemand&) = delete;
  OnDemand& operator=(const OnDemand&) = delete;

  /// Prepares one block, or makes what is there the surface of `source` from `now` on (s, on the
  /// clock that SceneField::update is given). Takes up to some tenths of a second, but seconds
  /// where all is prepared together at the end; leaves a core to servos once there are any. Not
  /// real-time. `ahead`: prepare also what no tool comes near yet.
  /// @return false: there was nothing to do. That is for good if done(); around a store it is until
  ///   a tool moves.
  /// @throws Error as prepare() and PointStore::read() do, once for each thing that is wrong. The
  ///   next call goes on: what could not be read counts as missing, and is tried again after 10 s.
  bool advance(Source& source, double now, bool ahead = true, const std::stop_token& stop = {});

  /// Waits until a block or a join is through, and publishes nothing from then on: the source
  /// becomes somebody else's. Any thread.
  void cancel();

  /// The share of the work that is done, 0-1: of the blocks, which are half of it where all is
  /// prepared together after them; 1 once it is done. Of a store, of the blocks around the tools.
  /// Any thread.
  [[nodiscard]] double share() const noexcept;

  /// Is all of the cloud there, or was it cancelled? Any thread.
  [[nodiscard]] bool done() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
