// Gives points at edges and creases the plane of a confident point nearby, or one that they share.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "prepare/plane_fits.hpp"
#include "prepare/segment_fit.hpp"
#include "refine/segments.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// An uncertain point lies on a confident one's plane where it is off by this share of the
// distance to it, or by this many of its residuals.
constexpr float kSnapReach = 1.6f;  // R; judgement
constexpr float kFarSnapReach = 4;  // R, where few are confident within kSnapReach; judgement
constexpr std::size_t kFewConfident = 12;  // points; judgement
constexpr float kSnapSlope = 0.12f;        // 7 degrees; judgement
constexpr float kSnapResiduals = 3;        // three sigma

// The share of the area within R that lies on a plane which holds there: a third at a corner of
// three faces (derived), less a margin for jitter (judgement).
constexpr float kShared = 0.3f;

// Cost of the distance to a point over that to its plane; judgement.
constexpr float kNearness = 0.1f;

// When a point lies on a second plane as well; judgement.
constexpr float kOtherPlane = 0.97f;  // cosine (14 degrees): planes that differ by more are two
constexpr float kOnBoth = 0.2f;       // spacings off the second plane, at most

using Around = std::span<const std::uint32_t>;  // a point's neighbours, and others of its row
using Confident = std::vector<std::uint32_t>;   // points around, that are confident

/// What a second fit needs; keeps its memory in between.
struct Refit {
  std::vector<std::uint32_t> near;
  std::vector<std::uint32_t> some;
  SegmentFitter fitter;
};

/// Finds a plane for each point that its own fit does not put on a segment.
class Snapping {
 public:
  Snapping(const SegmentInput& input, PointFits& own)
      : input_(input), own_(own), confident_(input.grid().size()) {
    detail::parallel_ranges(confident_.size(), 512, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) confident_[i] = is_confident(i) ? 1 : 0;
    });
  }

  void run() {
    assigned_.assign(confident_.size(), kUnassigned);
    second_planes_.assign(confident_.size(), kUnassigned);
    assign_planes(std::vector<std::uint8_t>(confident_.size(), 1));
    assign_planes(fit_unassigned());
    std::vector<std::uint8_t> alone(confident_.size());
    input_.graph.for_each_point<Confident>([&](std::uint32_t i, Around around, Confident&) {
      if (assigned_[i] == kUnassigned) alone[i] = is_among_unassigned(i, around) ? 1 : 0;
    });
    for (std::uint32_t i = 0; i < alone.size(); ++i) {
      if (assigned_[i] == kUnassigned) {
        confident_[i] = alone[i];
        if (alone[i] != 0) assigned_[i] = i;
        if (alone[i] == 0) own_.confidences[i] = 0;
      } else if (assigned_[i] != i) {
        take_over(i, assigned_[i]);
      }
    }
  }

  /// The result for all points, after run().
  [[nodiscard]] Snapped finish() && {
    Snapped snapped{std::move(confident_), std::move(assigned_), {}};
    for (std::uint32_t i = 0; i < second_planes_.size(); ++i) {
      if (second_planes_[i] != kUnassigned) snapped.second_planes.push_back({i, second_planes_[i]});
    }
    return snapped;
  }

 private:
  [[nodiscard]] bool is_confident(std::size_t i) const {
    return fit_of(own_, i).is_smooth(static_cast<double>(input_.radii[i]),
                                     static_cast<double>(input_.noise[i]));
  }

  /// Assigns planes to the points that are `marked`. One that has a plane keeps it where no other
  /// holds.
  void assign_planes(const std::vector<std::uint8_t>& marked) {
    if (std::ranges::count(marked, 1) == 0) return;
    index_confident();
    input_.graph.for_each_point<Confident>([&](std::uint32_t i, Around around, Confident& near) {
      if (marked[i] == 0) return;
      if (confident_[i] == 0) {
        assign_plane(i, around, near);
        return;
      }
      assigned_[i] = i;
      second_planes_[i] = kUnassigned;
      if (own_.others[i] == 0) return;
      list_confident(i, near);
      second_planes_[i] = second_plane(i, i, near);
    });
  }

  /// Fits unassigned points to each other: what lies on others' planes hid theirs, such as that of
  /// a wall which is lower than R. Marks the points that may have another plane now.
  std::vector<std::uint8_t> fit_unassigned() {
    std::vector<std::uint8_t> found(confident_.size());
    input_.graph.for_each_point<Refit>([&](std::uint32_t i, Around around, Refit& refit) {
      if (assigned_[i] == kUnassigned) found[i] = fit_again(i, around, refit) ? 1 : 0;
    });
    std::vector<Vector3f> positions;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      if (found[i] == 0) continue;
      confident_[i] = 1;
      positions.push_back(input_.grid().points()[i]);
    }
    if (positions.empty()) return found;
    const CellGrid new_ones(positions);
    detail::parallel_each_with<std::vector<std::uint32_t>>(
        found.size(), 512, [&](std::size_t i, auto& near) {
          if (confident_[i] != 0 && own_.others[i] == 0) return;
          near.clear();
          new_ones.within(input_.grid().points()[i], kFarSnapReach * input_.radii[i], near);
          found[i] = near.empty() ? 0 : 1;
        });
    return found;
  }

  /// Fits a plane to the unassigned points around, then a segment to all uncertain ones that lie on
  /// it.
  bool fit_again(std::uint32_t i, Around around, Refit& refit) {
    const auto radius = static_cast<double>(input_.radii[i]);
    const auto noise = static_cast<double>(input_.noise[i]);
    const float reach = kNormalsReach * input_.radii[i];
    const Vector3f& p = input_.grid().points()[i];
    refit.near.clear();
    std::ranges::copy_if(around, std::back_inserter(refit.near), [&](std::uint32_t j) {
      return confident_[j] == 0 && is_within(reach, i, j);
    });
    const auto fit_to = [&](const auto& belongs) {
      refit.some.clear();
      std::ranges::copy_if(refit.near, std::back_inserter(refit.some), belongs);
      return refit.fitter.fit(input_.grid(), p, refit.some, static_cast<double>(reach), 0, 0);
    };
    SegmentFit fit = fit_to([this](std::uint32_t j) { return assigned_[j] == kUnassigned; });
    if (!fit.is_smooth(radius, noise)) return false;
    const Vector3f normal = fit.normal.cast<float>();
    fit = fit_to([&](std::uint32_t j) {
      return std::abs(normal.dot(input_.grid().points()[j] - p)) <= kSnapSlope * input_.radii[i];
    });
    if (!fit.is_segment(radius, noise)) return false;
    take_fit(fit, i, own_);
    own_.others[i] = 1;
    return true;
  }

  void index_confident() {
    confident_points_.clear();
    std::vector<Vector3f> positions;
    for (std::uint32_t i = 0; i < confident_.size(); ++i) {
      if (confident_[i] == 0) continue;
      confident_points_.push_back(i);
      positions.push_back(input_.grid().points()[i]);
    }
    confident_grid_ = CellGrid(positions);
  }

  /// Confident points around; where they are few, as in the foot of a narrow crease, farther ones
  /// too.
  void list_confident(std::uint32_t i, Confident& near) const {
    for (const float reach : {kSnapReach, kFarSnapReach}) {
      near.clear();
      confident_grid_.within(input_.grid().points()[i], reach * input_.radii[i], near);
      for (std::uint32_t& j : near) j = confident_points_[confident_grid_.order()[j]];
      if (near.size() >= kFewConfident) return;
    }
  }

  [[nodiscard]] bool is_within(float reach, std::uint32_t i, std::uint32_t j) const {
    const auto points = input_.grid().points();
    return detail::squared_distance(points[i], points[j]) <= reach * reach;
  }

  void assign_plane(std::uint32_t i, Around around, Confident& near) {
    list_confident(i, near);
    const std::uint32_t owner = best_plane(i, near);
    if (owner == kUnassigned) return;
    const std::uint32_t second = second_plane(i, owner, near);
    if (!is_shared(i, owner, around)) return;
    assigned_[i] = owner;
    second_planes_[i] = second;
  }

  /// Gives a point the fit of its plane's owner, or at least its trust where an arc joins both.
  void take_over(std::uint32_t i, std::uint32_t owner) {
    const float distance = (input_.grid().points()[i] - input_.grid().points()[owner]).norm();
    const float turn = kTurnMargin * fitted_curvature(input_, own_, owner) * distance;
    if (std::abs(own_.normals[i].dot(own_.normals[owner])) < 1 - 0.5f * turn * turn) {
      own_.normals[i] = own_.normals[owner];
      own_.residuals[i] = own_.residuals[owner];
    }
    own_.confidences[i] = std::max(own_.confidences[i], 0.5f * own_.confidences[owner]);
  }

  /// Does enough of the area around lie on the owner's plane, too? At a corner of three faces a
  /// third does.
  [[nodiscard]] bool is_shared(std::uint32_t i, std::uint32_t owner, Around around) const {
    const Vector3f& p = input_.grid().points()[i];
    const float on = std::max(kSnapResiduals * own_.residuals[owner], kSnapSlope * input_.radii[i]);
    float shared = 0;
    float all = 0;
    for (const std::uint32_t j : around) {
      if (!is_within(input_.radii[i], i, j)) continue;
      const float area = input_.spacings[j] * input_.spacings[j];
      all += area;
      if (std::abs(own_.normals[owner].dot(input_.grid().points()[j] - p)) <= on) shared += area;
    }
    return shared >= kShared * all;
  }

  /// Are half of the points around unassigned, too? On a thing so small a plane has to do.
  [[nodiscard]] bool is_among_unassigned(std::uint32_t i, Around around) const {
    if (static_cast<double>(own_.confidences[i]) < kPlanar) return false;
    int excess = 0;  // of unassigned points over others
    for (const std::uint32_t j : around) {
      if (is_within(input_.radii[i], i, j)) excess += assigned_[j] == kUnassigned ? 1 : -1;
    }
    return excess >= 0;
  }

  /// The confident point on whose plane the point lies best.
  [[nodiscard]] std::uint32_t best_plane(std::uint32_t i, const Confident& near) const {
    float best = std::numeric_limits<float>::infinity();
    std::uint32_t owner = kUnassigned;
    for (const std::uint32_t j : near) {
      const Vector3f offset = input_.grid().points()[i] - input_.grid().points()[j];
      const float length = offset.norm();
      const float off = std::abs(own_.normals[j].dot(offset));
      const float cost = off + kNearness * length;
      if (cost >= best) continue;
      const bool on_plane =
          off <= std::max(kSnapResiduals * own_.residuals[j], kSnapSlope * length);
      const float turn = kTurnMargin * fitted_curvature(input_, own_, j) * length;
      if (!on_plane && off > kChord * turn * length) continue;
      best = cost;
      owner = j;
    }
    return owner;
  }

  /// The nearest confident point of another plane that the point lies on as well.
  [[nodiscard]] std::uint32_t second_plane(std::uint32_t i, std::uint32_t first,
                                           const Confident& near) const {
    float best = std::numeric_limits<float>::infinity();
    std::uint32_t owner = kUnassigned;
    for (const std::uint32_t j : near) {
      if (std::abs(own_.normals[first].dot(own_.normals[j])) > kOtherPlane) continue;
      const Vector3f offset = input_.grid().points()[i] - input_.grid().points()[j];
      const float off = std::abs(own_.normals[j].dot(offset));
      const float squared = offset.squaredNorm();
      if (off > kOnBoth * input_.spacings[i] || squared >= best) continue;
      best = squared;
      owner = j;
    }
    return owner;
  }

  const SegmentInput& input_;
  PointFits& own_;
  std::vector<std::uint8_t> confident_;
  CellGrid confident_grid_;
  std::vector<std::uint32_t> confident_points_;  // in the order that the index was given them
  std::vector<std::uint32_t> assigned_;
  std::vector<std::uint32_t> second_planes_;
};

}  // namespace

float fitted_curvature(const SegmentInput& input, const PointFits& own, std::uint32_t i) {
  const float reach = kNormalsReach * input.radii[i];
  const float square =
      own.residuals[i] * own.residuals[i] - own.quadric_residuals[i] * own.quadric_residuals[i];
  return std::sqrt(48 * std::max(square, 0.f)) / (reach * reach);
}

Snapped snap_to_planes(const SegmentInput& input, PointFits& own) {
  Snapping snapping(input, own);
  snapping.run();
  return std::move(snapping).finish();
}

}  // namespace palpate
