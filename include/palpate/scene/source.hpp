#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// How clouds that follow one another become one surface in time (docs/architecture.md).
enum class Policy {
  replace,    ///< the newest cloud, at once (hard swap)
  average,    ///< the newest N clouds, 1/N each (the paper)
  crossfade,  ///< N + 1 clouds; the newest fades in while the oldest fades out
  /// Blocks of a depth image, filtered in time and by the noise-sized fit. The number is that of
  /// earlier recordings, whose 3 was a policy that was removed.
  morph = 4,
};

/// What stands for a policy that is not set.
inline constexpr Policy kDepthPolicy = Policy::morph;      ///< of depth frames
inline constexpr Policy kCloudPolicy = Policy::crossfade;  ///< of clouds

/// A surface that comes later than this after its cloud's stamp is felt where things were, s; the
/// delay that people begin to notice (judgement).
inline constexpr double kLateCloud = 0.1;

struct PolicyOptions {
  std::optional<Policy> policy = {};  ///< unset: kDepthPolicy or kCloudPolicy
  int history = 4;       ///< N of `average` and `crossfade`, 1 to 7; the others do not use it
  double silence = 0.3;  ///< fade a surface after this long without new data, s
  double fade = 0.5;     ///< duration of that fade, s
  bool fit_everywhere = false;  ///< run the depth filter's fit outside the fields' reach as well
  /// Leave out points of clouds that no tool can come to before the next ones (the paper's section
  /// IV-B). Otherwise that begins after three clouds in a row whose surfaces came late
  /// (kLateCloud).
  bool clip_to_reach = false;
};

struct SourceOptions {
  /// What points of material 0 feel like. Material 1 is as stiff and rough as the proxy's options
  /// set, and between the two it goes in a straight line.
  struct SoftMaterial {
    double stiffness_factor = 1;  ///< 0-1
    double friction_factor = 1;   ///< 0-1
  };

  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();  ///< pose of the sensor's frame
  PrepareOptions prepare = {};
  SoftMaterial soft = {};         ///< applies where preparation makes materials
  PolicyOptions policy = {};      ///< for what is pushed
  DepthFilterOptions depth = {};  ///< for depth frames
  /// Does set() treat an organised cloud as the depth frame that it was made of? Not where that
  /// camera cannot be found (depth_frame_of()), half of its depths are out of the filter's range,
  /// or `prepare` requires what loose points alone have: voxel, clip, viewpoint, materials, the
  /// paper's method.
  bool organised = true;
};

/// What crosses from preparation to the servo: one source's surface over a stretch of time.
/// Immutable, in the world frame. Between start and end everything goes in straight lines; before
/// and after that nothing moves. The weights of a source's layers sum to 1 at every time.
struct Snapshot {
  /// Shared points and how much they count: a weight at the snapshot's start and one at its end.
  struct Layer {
    std::shared_ptr<const SurfacePoints> points;
    double weight_start = 1;
    double weight_end = 1;
  };

  /// Layers of one snapshot (judgement).
  static constexpr std::size_t kMaxLayers = 8;

  double start = 0;           ///< s, on the clock that SceneField::update is given
  double end = 0;             ///< s; not before start
  double presence_start = 1;  ///< 0-1: the sensor's confidence in what it saw
  double presence_end = 1;
  /// From this time on presence fades to 0 in `fade` s, unless a newer snapshot comes: a silent
  /// sensor's surface fades without another publish(). Infinite: never.
  double silent_from = std::numeric_limits<double>::infinity();
  double fade = 0.5;           ///< s
  double interval = 0;         ///< time between its source's frames, s; 0: nothing follows
  double spare = 0;            ///< part of it in which no frame was being prepared, s
  double stamp = 0;            ///< when the newest data in it was taken, s, same clock
  std::uint64_t sequence = 0;  ///< counts a source's snapshots
  /// Counts what a source published of push(), set() and keep(); 0: it came by publish().
  std::uint64_t publication = 0;
  std::vector<Layer> layers;
  /// Where the source has points that no layer holds yet, m, world frame; no more than some, the
  /// nearest to the tools.
  std::vector<Box> missing = {};
};

/// How far `snapshot` has gone at `time` (s): 0 at its start and before, 1 at its end and after.
[[nodiscard]] double progress(const Snapshot& snapshot, double time) noexcept;

/// The sensor's confidence in it at `time` (s), 0-1.
[[nodiscard]] double presence(const Snapshot& snapshot, double time) noexcept;

/// What a depth camera's newest frames show of a ball, or of several as one body.
struct Seen {
  /// In rising order: of several cameras' answers, the last one in this list counts.
  enum class Verdict {
    outside,  ///< it, or part of it, is not in the picture
    nothing,  ///< nothing is measured there
    solid,    ///< it, or part of it, is behind what is seen
    free,     ///< it is in front of that
    old,      ///< the camera looks there, but has been silent for too long
  };

  Verdict verdict = Verdict::outside;
  Verdict rest = Verdict::free;  ///< of a solid one's other parts: outside, nothing or free
  double behind = 0;  ///< m; a solid one that goes so far towards the camera is free, noise allowed
  double lift = 0;    ///< m; how far to move it towards the camera: up to what is measured, less
                      ///< where most of that may be noise; no less than `behind`
  double measured = 0;  ///< m; of `lift`, what the frame shows without what is foreseen
  bool came = false;    ///< a solid one was free some frames before
  double age = 0;       ///< of the frame, s
  double late = 0;      ///< s of it that are more than the quickest frame took to be looked at and
                        ///< the longest gap between two; 0 while that is unknown
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();  ///< unit, from its middle to the camera
};

/// One sensor or file: its pose, and the newest snapshot of what it sees.
class Source {
 public:
  /// State of a source, for display and logs.
  struct State {
    std::uint64_t frames = 0;   ///< frames and clouds that became a surface
    std::uint64_t dropped = 0;  ///< dropped because fields that stand still held all snapshots
    std::string slowest = {};   ///< name of such a field at the last drop; empty: never
    double interval = 0;        ///< time between frames, smoothed, s; 0: none yet
    double latency = 0;         ///< of the last one, from its stamp to the start of its surface, s
    double stamp = 0;           ///< of the last one, s
    std::size_t points = 0;     ///< of the newest surface's newest layer
    /// What is there besides the surface, thinned, world frame: points of all of a store, or of a
    /// cloud beyond the tools' reach. null: the surface is all.
    std::shared_ptr<const PointCloud> overview = {};
    bool clipped = false;    ///< the last cloud was clipped to where tools can be
    double noise = 0;        ///< sigma of one pixel at `depth`, m; 0: no depth frame yet
    double depth = 0;        ///< median depth of the last frame, m
    double correlation = 0;  ///< c of NoiseModel
    double silent_from = 0;  ///< when the surface begins to fade unless a frame comes, s
    double fade = 0;         ///< in which it fades away then, s
    /// Median distance along the normals between this source's surface and the others', where both
    /// see it, m; the worst of the others. Scene::state() only.
    std::optional<double> disagreement = {};

    [[nodiscard]] double rate() const { return interval > 0 ? 1 / interval : 0; }  ///< Hz
  };

  /// Returns the time at which the surface of a pushed frame or cloud is to start being felt, s, on
  /// the clock that SceneField::update is given. Called once, when all that needs no start is done.
  /// Live: now plus a lead in which the rest is done (some ms for a depth frame); a surface that
  /// comes after its start all the same begins where the last one waits and catches up. In
  /// simulated time: the frame's stamp plus the latency. A start before that of the surface pushed
  /// last counts as the same.
  using StartTime = std::function<double()>;

  /// @throws Error when an option is out of its range.
  Source(std::string name, const SourceOptions& options);
  ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  [[nodiscard]] const std::string& name() const;
  /// Any thread but a servo's.
  [[nodiscard]] SourceOptions options() const;
  /// Report on the newest cloud that was prepared here. Any thread but a servo's.
  [[nodiscard]] Prepared::Report report() const;

  /// Where the sensor stands: options().T_world_sensor until set_pose(). Any thread but a servo's.
  [[nodiscard]] Eigen::Isometry3d pose() const;
  /// Moves the sensor, from the next push() or set() on. Any thread but a servo's.
  /// @throws Error when the pose is not rigid.
  void set_pose(const Eigen::Isometry3d& T_world_sensor);

  /// Prepares what comes from the next push() or set() on with other options; the surface begins
  /// again with it. Pose and soft material stay as they are. Any thread but a servo's.
  /// @throws Error when an option is out of its range.
  void change(const SourceOptions& options);

  /// Prepares a static cloud and makes it this source's surface. Not real-time.
  /// @throws Error as prepare() does.
  void set(const PointCloud& cloud);

  /// The same for a depth frame, all of which is fitted. Its pose, where set, stands above pose().
  /// @throws Error as push() does.
  void set(const DepthFrame& frame);

  /// Takes the next frame of a depth camera: filters it, brings it into the surface as the policy
  /// requires, publishes. `frame.T_world_sensor`, where set, stands above pose(). Once frames of
  /// one size have come for a while, nothing is allocated, but where sources are compared, once in
  /// 32 frames. Not real-time; one thread pushes. A frame that measures nothing at all makes no
  /// surface: seen() tells so, and what is felt fades as in silence.
  ///
  /// False when the frame was dropped, because fields that stand still (their threads call no
  /// update()) hold all snapshots that there may be; state() names one of them.
  /// @throws Error as DepthFilter::filter does, and when a time is not finite or the pose not
  /// rigid.
  bool push(const DepthFrame& frame, const StartTime& start);

  /// Takes the next cloud of a sensor that delivers clouds, taken at `stamp` (s). As above, but
  /// preparation allocates.
  /// @throws Error as prepare() does, when a time is not finite, and when the policy needs depth
  /// frames.
  bool push(const PointCloud& cloud, double stamp, const StartTime& start);

  /// Keeps the last surface without fading. Call at the end of a recording. Of a depth frame, what
  /// was out of every tool's reach is fitted first. Points that were fading by themselves go on
  /// fading. Not real-time; the thread that pushes calls it, after the last push.
  void keep();

  /// Makes `snapshot` the newest; nullptr: there is no surface any more. Not real-time.
  /// @throws Error when it has more than Snapshot::kMaxLayers layers, a layer that is not whole, a
  /// weight or presence outside 0-1, or times that are not finite and in order.
  void publish(std::shared_ptr<const Snapshot> snapshot);

  /// What the newest depth frames show of all of these balls, one or more (m, world), at time `now`
  /// (s, on the clock of their stamps). What they show counts where it will be by then, if it goes
  /// on as in the last 0.1 s, and hides them where noise, at three deviations, cannot feign that. A
  /// frame is too old once the next one should have replaced it: at the longest gap between the
  /// stamps of the last 16, lost frames left out, and their longest delay; of the first nine 2.5
  /// mean intervals after it came; at the latest PolicyOptions::silence after that. So is the last
  /// one before keep(); one of set() never is. From raw depths, not from the surface. Nothing for
  /// clouds, and until a frame is pushed after the first call. Any thread but a servo's.
  [[nodiscard]] std::optional<Seen> seen(std::span<const Ball> balls, double now) const;
  [[nodiscard]] std::optional<Seen> seen(const Ball& ball, double now) const {
    return seen(std::span(&ball, 1), now);
  }

  /// The newest surface's newest layer (of one that came by publish(), its first), for those who
  /// draw or explore; may be null. Any thread but a servo's.
  [[nodiscard]] std::shared_ptr<const SurfacePoints> points() const;

  /// Its state. Any thread but a servo's. Scene::state() adds the disagreement with other sources.
  [[nodiscard]] State state() const;

 private:
  friend class OnDemand;
  friend class Scene;
  friend class FollowedSources;
  friend class SourceTrace;  // of recordings and replays
  friend struct Streaming;   // of what is pushed

  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
