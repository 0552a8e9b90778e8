#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "palpate/field/field.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "viewer/client_sessions.hpp"
#include "viewer/messages.hpp"

namespace palpate::viewer {

/// Triangles around a centre that is stored apart. Seen from the free side their corners go
/// anticlockwise.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  ///< m, relative to the centre
  std::vector<std::array<std::uint16_t, 3>> triangles;
};

/// Region in which a surface is meshed.
struct LocalRegion {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m
  double radius = 0;  ///< R, m; the mesh reaches kReach of it to every side
  /// Surface with less support is left out: the back of a sheet, where the solid ends because
  /// nothing is measured behind it.
  double least_support = 0;
};

/// R's to every side of the centre.
inline constexpr double kReach = 2.4;

/// The surface of `field` in a cube (surface nets): what can be felt there, as far as it is
/// measured. Cubes that are free are passed over, and no more than 32^3 cells looked at, so that it
/// costs a few thousand samples.
[[nodiscard]] Mesh local_surface(const Field& field, const LocalRegion& region);

/// At most `budget` of `count` points, rising: one of each of `budget` equal stretches of their
/// order. Along a CellGrid's Morton order, stretches are neighbourhoods: what is left covers all as
/// the points did, and the same points stay from one call to the next.
[[nodiscard]] std::vector<std::uint32_t> thinned(std::size_t count, std::size_t budget);

/// Divides `budget` points among clouds in proportion to their sizes.
[[nodiscard]] std::vector<std::size_t> shares(const std::vector<std::size_t>& sizes,
                                              std::size_t budget);

/// The points that can be felt, where they are going to be, thinned to `budget`, relative to
/// `origin` (m, world). Source and stamp are left to the caller.
[[nodiscard]] CloudMessage cloud_of(const SurfacePoints& points, const Eigen::Vector3d& origin,
                                    std::size_t budget);

/// The cloud of a source for those who draw `budget` points in all.
struct EncodedCloud {
  std::size_t source = 0;
  std::size_t budget = 0;
  SharedBytes bytes;
};

/// Encodes each source's newest cloud once for each budget that clients have. One thread uses it.
class CloudEncoder {
 public:
  CloudEncoder(const Scene& scene, const Eigen::Vector3d& origin)
      : scene_(scene), origin_(origin), sources_(scene.size()), overviews_(scene.size()) {}

  /// All that is to be seen at `now` (s, on the snapshots' clock); what did not change has the
  /// bytes that it had.
  [[nodiscard]] std::vector<EncodedCloud> encode(const std::set<std::size_t>& budgets, double now);

 private:
  struct Encoded {
    std::weak_ptr<const SurfacePoints> points;
    std::uint64_t frames = 0;
    bool faded = false;
    std::map<std::size_t, SharedBytes> encoded;  // by share
  };

  [[nodiscard]] SharedBytes encode(std::size_t source, const SurfacePoints* points,
                                   std::size_t share);

  /// What was drawn of a source's overview last: a store's stays, and its spacings take a while.
  struct Overview {
    std::weak_ptr<const PointCloud> cloud;
    std::vector<std::uint32_t> kept;
    std::vector<float> radii;  // m
  };

  const Scene& scene_;
  Eigen::Vector3d origin_;
  std::vector<Encoded> sources_;
  std::vector<Overview> overviews_;
};

/// Surface around one tool.
struct EncodedSurface {
  double radius = 0;  ///< R, m; 0: unknown
  SharedBytes bytes;  ///< the newest; null: the servo made no step yet
};

class SurfaceEncoder;

/// All that takes more than some microseconds to make.
struct EncodedScene {
  std::vector<EncodedCloud> clouds;      ///< of every source, for every budget above 0
  std::vector<EncodedSurface> surfaces;  ///< of every device
  SharedBytes sources;                   ///< the message `sources`; null: not now
  std::string complaint;                 ///< why there is no more; empty: nothing is new
};

struct SceneEncoderOptions {
  std::vector<Servo*> servos;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::function<std::vector<ViewedStream>()> streams = {};
  std::function<std::string()> robot = {};
};

/// Makes pictures for those who look. One thread uses it.
class SceneEncoder {
 public:
  SceneEncoder(Scene& scene, SceneEncoderOptions options);
  ~SceneEncoder();
  SceneEncoder(const SceneEncoder&) = delete;
  SceneEncoder& operator=(const SceneEncoder&) = delete;

  /// A picture at `now` (s, on a clock that never goes back) for clients of these point budgets; 0:
  /// that one draws nothing now. What went wrong is in its complaint.
  [[nodiscard]] EncodedScene encode(const std::set<std::size_t>& budgets, double now);

  /// Nobody looks: holds no field until the next picture.
  void rest();

  /// s until the next picture, where the last one took `took` s: no more than 10 a second, and no
  /// more than a quarter of the time.
  [[nodiscard]] static double pause_after(double took) noexcept;

 private:
  void encode(const std::set<std::size_t>& budgets, double now, EncodedScene& encoded);
  void encode_surfaces(EncodedScene& encoded);
  void join_scene();
  void report(EncodedScene& encoded);
  [[nodiscard]] std::string news(std::string complaint);
  [[nodiscard]] double surface_time() const;

  Scene& scene_;
  SceneEncoderOptions options_;
  CloudEncoder clouds_;
  std::vector<std::unique_ptr<SurfaceEncoder>> surfaces_;
  std::string complaint_;     // the last complaint
  double reported_ = -1e300;  // when sources were reported last, s
};

}  // namespace palpate::viewer
