// Holds what a source is made of: its state and its handoff, and what the floors above do for it.
#pragma once

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/source.hpp"
#include "scene/handoff.hpp"
#include "scene/tool_reach.hpp"

namespace palpate {

/// How far apart two surfaces are where both are there: the median distance, along the normal of
/// `b`, from points of `a` to the nearest point of `b`, m, where they are going. Points count that
/// have a neighbour within three radii whose normal agrees within 45 degrees; nothing when fewer
/// than 30 of about a thousand that are tried do.
[[nodiscard]] std::optional<double> disagreement(const SurfacePoints& a, const SurfacePoints& b);

/// How wide supports have to be for the surfaces of sources that disagree to be one.
///
/// Heights of sources unite where the supports of both reach (united_shift()). Further apart
/// than that there is a gap between two surfaces, into which a proxy slips where one of them ends.
/// So where two surfaces of a scene lie up to 1.5 R apart, no R of either is below 2.5 times that
/// distance. What lies further apart stays two.
class Seams {
 public:
  /// Compares the newest points of the source at `index` with those of the others that have called
  /// this. The source outlives it. Takes milliseconds, and memory; any thread but a servo's.
  void compare(std::size_t index, const Source& source);

  /// No support radius of that source is to be below this, m. Changes; may be read by any thread.
  [[nodiscard]] const std::atomic<double>& least_radius(std::size_t index) const noexcept {
    return least_radii_[index];
  }

  /// Sets it until the next compare(), for a replay that has recorded it.
  void set_least_radius(std::size_t index, double radius) noexcept {
    least_radii_[index].store(radius);
  }

 private:
  std::mutex mutex_;
  std::array<const Source*, Scene::kMaxSources> sources_{};
  std::array<std::array<double, Scene::kMaxSources>, Scene::kMaxSources> common_{};  // R, m
  std::array<std::atomic<double>, Scene::kMaxSources> least_radii_{};
};

/// What a source needs for frames, and for clouds that come one after another: floor `stream` has
/// it. A core by itself has none, as its sources hold still.
struct Streaming;

/// @throws Error when an option is out of its range.
[[nodiscard]] std::shared_ptr<Streaming> make_streaming(const SourceOptions& options);

/// Forgets what frames showed of free space. `streaming`: what make_streaming() made.
void forget_frames(Streaming* streaming);

/// Makes an organised cloud the source's surface as the depth frame that it was made of. False: it
/// is none, or is not to be treated so.
/// @throws Error as Source::set() of a frame does.
[[nodiscard]] bool set_as_frame(Source& source, const PointCloud& cloud);

/// The eye of a cloud, if all of it was seen from one position. `T_world_sensor`: of its frame.
[[nodiscard]] std::optional<SurfaceEye> eye_of(const PointCloud& cloud,
                                               const PrepareOptions& options,
                                               const Eigen::Isometry3d& T_world_sensor);

/// Errors of what `act` does, with the source's name.
template <class Act>
auto named(const std::string& name, const Act& act) {
  try {
    return act();
  } catch (const Error& error) {
    throw Error(fmt::format("source '{}': {}", name, error.what()));
  }
}

/// Where a source stands among those of its scene, whose seams it has. By itself it has none.
struct SceneSlot {
  std::shared_ptr<Seams> seams;
  std::size_t number = 0;

  void compare(const Source& source) const {
    if (seams) seams->compare(number, source);
  }
};

/// The parts of a source. Its scene and the fields of that scene use them.
struct Source::Inside {
  /// For those who draw.
  template <class T>
  [[nodiscard]] T copy(T Inside::*member) const {
    const std::lock_guard lock(mutex);
    return this->*member;
  }

  std::string name;
  mutable std::mutex mutex;  // of what follows: those who draw, and the preparing thread
  SourceOptions options;
  Eigen::Isometry3d pose;
  Prepared::Report report;
  std::shared_ptr<const SurfacePoints> points;
  Source::State state;

  std::shared_ptr<Streaming> streaming;
  std::uint64_t publications = 0;  // the preparing thread's
  ReachTable reaches;
  SceneSlot slot;
  Handoff<Snapshot> handoff;
};

}  // namespace palpate
