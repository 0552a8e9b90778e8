// Makes a cloud into surface points that a field can be made of.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "palpate/field/field_options.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/cloud_facts.hpp"

namespace palpate {

/// How a cloud becomes surface points. What is not set is chosen from the data.
struct PrepareOptions {
  /// The source of normals' signs. They help segments to form oriented components; the free side of
  /// each is the one that the tool comes from or, with a viewpoint that proves true, the one that
  /// was seen. Components without any evidence point outward.
  enum class Orientation {
    automatic,  ///< what is given; else a viewpoint where there is one
    viewpoint,  ///< towards PrepareOptions::viewpoint or the cloud's own
    outward,    ///< nothing: outward, or up where points bound nothing
    given,      ///< the cloud's normals alone
  };

  std::optional<double> voxel = {};   ///< leaf of the voxel filter, m; 0: keep every point
  std::optional<double> radius = {};  ///< one support radius R for all points, m; of depth
                                      ///< frames the smallest
  double smoothing = 1;               ///< factor on the R that is chosen where none is given
  double minimum_radius = 0;          ///< no R below this, m (a tool's radius / 0.3)
  double normal_error = 0.02;         ///< wanted error of normals, rad (theta: 1.15 degrees)
  /// Position of the sensor, in the cloud's frame, m. Gives the signs instead of given normals,
  /// unless these alone are requested; components whose side it decides hold from there alone.
  std::optional<Eigen::Vector3d> viewpoint = {};
  Orientation orientation = Orientation::automatic;
  std::optional<Box> clip = {};          ///< keep points inside only, in the cloud's frame, m
  bool remove_speckle = true;            ///< let isolated points that noise made weigh nothing
  bool estimate_normals = true;          ///< false: metaball only
  bool material_from_intensity = false;  ///< from `intensities`, 0-1 over their range
  bool paper = false;                    ///< the paper's s (mean of k = 3 neighbours), R = 2.5 s
  Kernel kernel = Kernel::wyvill;        ///< that the density weights are made for
  std::optional<CloudFacts> facts = {};  ///< of the whole that the cloud is a part of
  /// Called with the share of the work that is done, 0 to 1, now and then, not always to the end:
  /// by whichever thread has come so far, one at a time. What it throws ends the preparation, and
  /// prepare() throws it. A Source calls it for its first cloud alone.
  std::function<void(double share)> progress = {};
  /// Names of refinements that are left out, for benches that measure what each is worth: outliers,
  /// gaps, segments, outliers_off_segments, second_planes.
  std::set<std::string, std::less<>> without = {};
};

/// A cloud as a surface.
struct Prepared {
  /// What preparation found and how long it took (wall time, s).
  struct Report {
    std::size_t points_in = 0;
    std::size_t points_out = 0;  ///< that are felt: after clip, voxel filter, outliers
    std::size_t duplicates = 0;  ///< points left out: others are at the same position
    std::size_t speckle = 0;     ///< outliers, which weigh nothing
    double spacing = 0;          ///< s, median, m
    double noise = 0;            ///< rms distance from a smooth surface, m
    double voxel = 0;            ///< leaf used, m; 0: none
    double radius = 0;           ///< R, median, m
    double radius_smallest = 0;
    double radius_largest = 0;
    double trust_low = 0;  ///< a tenth of what is felt has a smaller SurfacePoints::confidences
    double untrusted = 0;  ///< share of what is felt whose normals are not trusted (below 0.5),
                           ///< 0-1; it is felt as metaball
    double seconds_filter = 0;
    double seconds_index = 0;
    double seconds_spacing = 0;
    double seconds_normals = 0;
    double seconds_weights = 0;
  };

  SurfacePoints points;
  Report report;
};

/// Filters and indexes a cloud, finds its smooth segments and places it in the world. Runs on every
/// core; the result does not depend on their number.
/// @throws Error when no point is left, an option makes no sense, a point is not finite, a column
/// is neither empty nor as long as the points, or the pose is not rigid.
[[nodiscard]] Prepared prepare(
    const PointCloud& cloud, const PrepareOptions& options = {},
    const Eigen::Isometry3d& T_world_sensor = Eigen::Isometry3d::Identity());

}  // namespace palpate
