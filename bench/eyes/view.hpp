#pragma once

#include <string>
#include <vector>

#include "common/stage.hpp"
#include "sim/simulated_camera.hpp"

/// Scenes before a depth camera or two, the hands that meet them, and what these feel.
namespace palpate::eyes {

using bench::kTick;
using bench::kUp;
using Eigen::Vector3d;

inline constexpr double kK = 500;     ///< N/m; the stiffness of the other benches
inline constexpr double kWarm = 0.5;  ///< s before hands move: filters over time are full

/// How what the camera sees becomes a surface.
enum class Feed {
  still,      ///< a stream from a camera that stands
  moving,     ///< a stream from a camera that swings and tells its pose
  single,     ///< one frame
  points,     ///< the exact points of one frame with their exact normals, as a file has them
  viewpoint,  ///< the same with the camera's place, as a PCD file has it
  opposed,    ///< streams of two cameras that stand, across the scene from each other
};

/// A drawn scene and its cameras. World frame: a table or floor is z = 0, the first camera is on
/// the side of negative x and looks at the origin.
struct View : bench::Stage {
  /// Draws the camera's place.
  explicit View(std::uint64_t number);

  /// `half`: half sizes, z upright before `turn` (rad) about the vertical and `tilt` about y.
  void block(const Vector3d& center, const Vector3d& half, double turn = 0, double tilt = 0);
  /// Around `axis`.
  void rod(const Vector3d& center, const Vector3d& axis, double radius, double length);
  void ball(const Vector3d& center, double radius);

  /// Adds a camera across the scene, with noise of its own.
  void oppose();

  /// The axes of a board that faces the first camera to 25 degrees, 0.15 m above the floor or
  /// before a wall.
  [[nodiscard]] Eigen::Isometry3d board();
  /// A bar in the axes of a board, turned about the second of them (rad).
  void bar(const Eigen::Isometry3d& board, const Vector3d& center, const Vector3d& half,
           double lean = 0);
  /// A way between things that is so wide (m) that a camera sees at least 10 pixels through it.
  double draw_gap();

  std::vector<SimulatedCameraOptions> cameras;  ///< at least one
  std::vector<Vector3d> gaps = {};              ///< middles of such ways
  double gap = 0;                               ///< their width, m
  double behind = 0.1;                          ///< free behind them at least, m
  Feed feed = Feed::still;
};

struct Kind {
  std::string name;
  void (*draw)(View&);
};

/// The kinds of scenes, each drawn by a view's seed.
[[nodiscard]] const std::vector<Kind>& kinds();

/// The noise of a name: "a", "b" and "c" as NoiseKind has them, "structured", "stereo" and "tof" as
/// simulated cameras have them, and "waves": a correlation of 8 to 18 pixels, terraces and a fixed
/// pattern, smoothed by up to 3 pixels, with frames that hop by up to 10 mm.
/// @throws Error for any other.
void set_noise(const std::string& name, View& view);

/// What the camera sees without noise.
struct Picture {
  Picture(const View& view, const SimulatedCameraOptions& of);

  /// Depth of the pixel that sees x, and of those beside it (m): the least within `around` pixels;
  /// 0 outside of the image.
  [[nodiscard]] double depth_at(const Vector3d& x, int around) const;
  /// Along the optical axis, m.
  [[nodiscard]] double depth_of(const Vector3d& x) const { return (T_camera_world * x).z(); }
  [[nodiscard]] Vector3d point(int u, int v) const;

  CameraModel camera;
  Eigen::Isometry3d T_camera_world;
  std::vector<float> depth;
};

/// A hand's path from kWarm on, tick by tick.
struct Hand {
  std::string kind;           ///< slide, poke, aside, behind, through
  std::vector<Vector3d> hip;  ///< m
  bool hidden = false;        ///< it goes where no camera sees anything: nothing may hold it
  bool free = false;          ///< all of its way is free, and seen to be so
};

/// Draws a hand's path; empty where the scene has no place for it.
[[nodiscard]] Hand draw_hand(View& view, const Picture& picture, const std::string& kind);

/// What one hand felt, and what the ideal proxy on the exact solids feels.
struct Felt {
  std::vector<Vector3d> force, ideal;        ///< N
  std::vector<Vector3d> proxy, ideal_proxy;  ///< m
  double microseconds = 0;                   ///< of a step, the mean
};

/// Plays all hands at once.
[[nodiscard]] std::vector<Felt> play(const View& view, const std::vector<Hand>& hands);

/// Counts over hands.
struct Score {
  double hands = 0;
  double held = 0;  ///< hands held in free air in front of all that a camera sees, or where it sees
                    ///< through, above 0.5 N for 50 ms
  double most = 0;  ///< largest force there, N
  double hidden = 0;           ///< hands that go behind things
  double caught = 0;           ///< of them those that something holds
  double thrown = 0;           ///< hands that feel more than 5 N where the ideal feels less than 2
  double steps = 0;            ///< changes of more than 1 N in a tick that the ideal has not
  double asked = 0;            ///< ticks in which the ideal feels 1 N, all of its contact seen
  double lost = 0;             ///< of them those with less than a fifth of it
  double asked_in_shadow = 0;  ///< the same where a part of it was not
  double lost_in_shadow = 0;
  double microseconds = 0;

  Score& operator+=(const Score& other);
};

[[nodiscard]] Score score(const View& view, const std::vector<Picture>& pictures, const Hand& hand,
                          const Felt& felt);

}  // namespace palpate::eyes
