#include "palpate/prepare/prepare.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/normals.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/columns.hpp"
#include "prepare/lines.hpp"
#include "prepare/noise.hpp"
#include "prepare/radii.hpp"
#include "prepare/sheets.hpp"
#include "prepare/strays.hpp"
#include "prepare/weights.hpp"

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;

// A cloud this noisy, against its spacing, is thinned to two spacings; a cleaner one is kept whole.
constexpr double kNoisy = 0.25;

// The paper's multiple m, its k nearest neighbours and the level of its metaball (section V).
constexpr double kPaperMultiple = 2.5;

// Noise is not smoothed away at the price of shape of this part of the cloud's size.
constexpr double kFinestShape = 25;

// R in spacings at least, where points lie irregularly: gaps between random points are wider than
// 2.5 spacings' support bridges.
constexpr double kIrregularMultiple = 3;

// R of strays, in typical spacings: they are not to reach what is sampled finely.
constexpr float kStrayRadius = 2.5f;

constexpr float kSlope = 0.5f;  // of R over distance, as it follows from spacings and noise

/// Adds the time since the last lap to `seconds`.
class Stopwatch {
 public:
  void lap(double& seconds) {
    const auto now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

/// One cloud on its way to surface points.
class Preparation {
 public:
  Preparation(const PointCloud& cloud, const PrepareOptions& options,
              const Eigen::Isometry3d& T_world_sensor)
      : options_(options), cloud_(&cloud) {
    check(options, cloud);
    check_pose(T_world_sensor);
    report_.points_in = cloud.size();
    if (options.clip || !T_world_sensor.matrix().isIdentity(0)) {
      own_ = placed(options.clip ? clip(cloud, *options.clip) : cloud, T_world_sensor);
      cloud_ = &own_;
    }
    viewpoint_ = options.viewpoint ? T_world_sensor * *options.viewpoint : cloud_->viewpoint;
    require_points();
    watch_.lap(report_.seconds_filter);
  }

  Prepared run() {
    index();
    const auto distinct = first_of_each_place(points_.grid);
    if (!options_.paper && distinct.size() < points_.size()) {
      report_.duplicates = points_.size() - distinct.size();
      own_ = select(*cloud_, distinct);
      cloud_ = &own_;
      index();
    }
    choose_voxel();
    choose_radii();
    weigh();
    points_.confidences.resize(points_.size(), 0.0f);
    if (options_.remove_speckle && !options_.paper) silence_speckle();
    if (!cloud_->colors.empty()) points_.colors = in_grid_order(points_.grid, cloud_->colors);
    if (options_.estimate_normals) find_sheets();
    finish(points_);
    report_.points_out = points_.size() - report_.speckle - twins_;
    tell_trust(points_, report_);
    report_.radius = points_.radius;
    report_.radius_smallest = points_.smallest_radius;
    report_.radius_largest = *std::max_element(points_.radii.begin(), points_.radii.end());
    return {std::move(points_), report_};
  }

 private:
  void require_points() const {
    if (!cloud_->empty()) return;
    throw Error(fmt::format("none of the {} points is left: check the clip box and the file",
                            report_.points_in));
  }

  void index() {
    points_.origin = cloud_->origin;
    points_.grid = CellGrid(cloud_->positions);
    watch_.lap(report_.seconds_index);
  }

  void measure_spacing() {
    spacings_ = local_spacings(points_.grid);
    if (!options_.paper && !options_.radius) widen_to_lines(points_.grid, spacings_);
    report_.spacing = median(spacings_);
    watch_.lap(report_.seconds_spacing);
  }

  /// Noise and footprint are those of the raw points; spacings those of the filtered ones.
  void choose_voxel() {
    measure_spacing();
    footprint_ = report_.spacing;
    const Noise noise = options_.paper ? Noise{} : measure_noise(points_.grid, footprint_);
    report_.noise = noise.sigma;
    const bool noisy = report_.noise > kNoisy * footprint_;
    report_.voxel = options_.voxel.value_or(noisy && !options_.paper ? 2 * footprint_ : 0);
    watch_.lap(report_.seconds_spacing);
    if (report_.voxel <= 0) return;
    std::optional<NoiseMap> map;
    if (noisy && !options_.radius) map.emplace(points_.grid, spacings_);
    watch_.lap(report_.seconds_spacing);
    own_ = voxel_downsample(*cloud_, report_.voxel, &counts_);
    cloud_ = &own_;
    watch_.lap(report_.seconds_filter);
    index();
    measure_spacing();
    // Centroids stand closer than their voxels on a slanted surface; s is the voxel.
    const auto leaf = static_cast<float>(report_.voxel);
    for (float& s : spacings_) s = std::max(s, leaf);
    report_.spacing = std::max(report_.spacing, report_.voxel);
    if (map) noise_ = map->at(points_.grid.points(), noise);
    watch_.lap(report_.seconds_spacing);
  }

  void choose_radii() {
    if (options_.radius) {
      points_.radii.assign(points_.size(),
                           static_cast<float>(std::max(*options_.radius, options_.minimum_radius)));
    } else if (options_.paper) {
      report_.spacing = mean_spacing(points_.grid);
      const double radius = options_.radius_multiple.value_or(kPaperMultiple) * report_.spacing;
      points_.radii.assign(points_.size(), static_cast<float>(radius));
    } else {
      choose_radii_by_noise();
    }
    if (!options_.radius && !options_.paper) limit_growth(points_.grid, kSlope, points_.radii);
    watch_.lap(report_.seconds_spacing);
    if (options_.estimate_normals) fit_sheets();
  }

  /// The diagonal of the cloud's box, m; never 0.
  [[nodiscard]] double extent() const {
    const CellGrid::Cell& root = points_.grid.cells().front();
    return std::max(static_cast<double>((root.upper - root.lower).norm()), kLoneSpacing);
  }

  /// Where the cloud is noisy, R follows the noise from place to place.
  void choose_radii_by_noise() {
    SupportOptions support{.multiple = options_.radius_multiple,
                           .noise = report_.noise,
                           .footprint = report_.voxel > 0 ? footprint_ : 0,
                           .normal_error = options_.normal_error,
                           .minimum = options_.minimum_radius,
                           .finest_shape = extent() / kFinestShape};
    if (!support.multiple && report_.voxel <= 0 && is_irregular(points_.grid, spacings_)) {
      support.multiple =
          std::max(kIrregularMultiple, support_multiple(report_.noise, report_.spacing));
    }
    if (noise_.products.empty()) {
      points_.radii = support_radii(spacings_, support);
      return;
    }
    support.noise = 0;
    points_.radii =
        noisy_radii(points_.grid, noise_, options_.normal_error, support_radii(spacings_, support));
  }

  void fit_sheets() {
    if (noise_.sigmas.empty()) {
      noise_.sigmas.assign(points_.size(), static_cast<float>(report_.noise));
    }
    own_sheets_ = fit_own_sheets(points_.grid, spacings_, points_.radii, noise_.sigmas);
    if (!cloud_->normals.empty()) {
      given_ = in_grid_order(points_.grid, cloud_->normals);
      take_given_normals(points_.grid, given_, own_sheets_.normals);
    }
    if (options_.remove_speckle && !options_.radius && !options_.paper) {
      strays_ = find_strays(points_.grid, spacings_, report_.spacing);
      for (std::size_t i = 0; i < strays_.size(); ++i) {
        if (strays_[i] == 0) continue;
        own_sheets_.confidences[i] = 0;
        points_.radii[i] = kStrayRadius * static_cast<float>(report_.spacing);
      }
    }
    watch_.lap(report_.seconds_normals);
  }

  void find_sheets() {
    KnownSigns known;
    const PrepareOptions::Orientation how = options_.orientation;
    if (how == PrepareOptions::Orientation::automatic || how == PrepareOptions::Orientation::given)
      known.given = given_;
    const bool seen = how == PrepareOptions::Orientation::automatic ||
                      how == PrepareOptions::Orientation::viewpoint;
    if (seen && viewpoint_) known.eye = (*viewpoint_ - points_.origin).cast<float>();
    if (options_.viewpoint) known.given = {};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (points_.density_weights[i] <= 0) own_sheets_.confidences[i] = 0;
    }
    std::vector<Twin> twins;
    points_.sheets = make_sheets({points_.grid, spacings_, points_.radii, noise_.sigmas}, known,
                                 own_sheets_, twins);
    points_.normals = std::move(own_sheets_.normals);
    points_.confidences = std::move(own_sheets_.confidences);
    add_twins(twins, points_);
    twins_ = twins.size();
    watch_.lap(report_.seconds_normals);
  }

  void weigh() {
    points_.kernel = options_.kernel;
    sums_ = WeightSums(points_.grid, points_.radii, options_.kernel);
    if (!options_.radius && !options_.paper && options_.estimate_normals &&
        close_gaps(points_.grid, sums_->own, spacings_, points_.radii, own_sheets_) > 0) {
      limit_growth(points_.grid, 1, points_.radii, &own_sheets_);
      sums_ = WeightSums(points_.grid, points_.radii, options_.kernel);
    }
    points_.density_weights = density_weights(*sums_);
    if (!counts_.empty()) {
      weigh_by_counts(points_.grid, in_grid_order(points_.grid, counts_), points_.radii,
                      points_.density_weights);
    }
    if (options_.material_from_intensity) {
      points_.materials = materials_of(points_.grid, cloud_->intensities);
    }
    watch_.lap(report_.seconds_weights);
  }

  /// Points that noise made stay in the index and weigh nothing.
  void silence_speckle() {
    auto mask = speckle_mask(points_.grid, points_.radii, *sums_);
    for (std::size_t i = 0; i < strays_.size(); ++i) mask[i] |= strays_[i];
    const auto speckle = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
    if (speckle < points_.size()) {  // a cloud of nothing else is a sparse one
      report_.speckle = speckle;
      for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] != 0) points_.density_weights[i] = points_.confidences[i] = 0;
      }
    }
    watch_.lap(report_.seconds_filter);
  }

  const PrepareOptions& options_;
  PointCloud own_;           // clipped, turned or thinned
  const PointCloud* cloud_;  // that, or what was given
  std::optional<Eigen::Vector3d> viewpoint_;
  SurfacePoints points_;
  Prepared::Report report_;
  std::vector<float> spacings_;
  std::vector<std::uint32_t> counts_;   // points that each voxel's stands for; empty: one each
  std::vector<Eigen::Vector3f> given_;  // in sorted order; empty: none
  OwnSheets own_sheets_;
  std::vector<std::uint8_t> strays_;  // 1: one; empty: not looked for
  std::optional<WeightSums> sums_;
  double footprint_ = 0;
  LocalNoise noise_;  // without products: the same everywhere
  std::size_t twins_ = 0;
  Stopwatch watch_;
};

}  // namespace

Prepared prepare(const PointCloud& cloud, const PrepareOptions& options,
                 const Eigen::Isometry3d& T_world_sensor) {
  return Preparation(cloud, options, T_world_sensor).run();
}

}  // namespace palpate
