#include "prepare/grow_sheets.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "geometry/neighborhoods.hpp"
#include "geometry/signed_sets.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr std::uint32_t kNobody = ~std::uint32_t{0};

constexpr float kPlanar = 0.5f;   // confidence from which on a fit is a plane
constexpr float kSmooth = 0.03f;  // of R that a quadric may leave: curvature passes, a crease not
constexpr float kNoisySmooth = 1.6f;  // of the noise, likewise
constexpr float kNoiseReach = 2.5f;   // R within which noise is looked for
constexpr float kNoisier = 2.5f;      // than typical that noise may be in places

// An unsure point lies on a sure one's plane where it is off by this share of the way to it, or by
// this many of its residuals.
constexpr float kSnapReach = 1.6f;  // R; where nothing is sure there:
constexpr float kFarSnapReach = 4;  // R
constexpr std::size_t kFewSure = 12;
constexpr float kSnapSlope = 0.12f;
constexpr float kSnapResiduals = 3;
constexpr float kNearness = 0.1f;  // of the way, against the distance from the plane

// A point lies on a second plane where that is another one and it is off it by so many spacings.
constexpr float kOtherPlane = 0.97f;
constexpr float kOnBoth = 0.2f;

// Two points continue each other's sheet.
constexpr float kPairReach = 1.6f;   // spacings
constexpr float kTurn = 0.28f;       // rad (16 degrees) that normals of one sheet may turn, or more
constexpr float kTurnMargin = 1.5f;  // where both fits are bowed so much
constexpr float kChord = 0.6f;       // of the turn: how far off the chord may be; an arc's is half
constexpr float kLeastTolerance = 0.15f;  // spacings that a residual may always be

constexpr std::uint32_t kFewest = 8;  // points of a sheet
constexpr float kTrustOfFew = 0.1f;

/// The curvature that a sure point's fit tells, 1/m: a sphere's cap of radius a and curvature k is
/// off its plane by k a^2 / sqrt(48) RMS.
float bow(const SheetInput& input, const OwnSheets& own, std::uint32_t i) {
  const float reach = 1.15f * input.radii[i];
  const float square = own.residuals[i] * own.residuals[i] - own.bends[i] * own.bends[i];
  return std::sqrt(48 * std::max(square, 0.f)) / (reach * reach);
}

/// What becomes of the points that their own fit does not put on a sheet.
class Snapping {
 public:
  Snapping(const SheetInput& input, OwnSheets& own)
      : input_(input), own_(own), sure_(input.grid.size()) {
    const auto noise = static_cast<float>(input.noise);
    detail::parallel_ranges(sure_.size(), 512, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> near;
      for (std::size_t i = begin; i < end; ++i) {
        if (own.confidences[i] < kPlanar) continue;
        const auto radius = static_cast<double>(input.radii[i]);
        if (static_cast<double>(own.residuals[i]) <= flat_residual(radius, input.noise)) {
          sure_[i] = 1;
          continue;
        }
        const float smooth = kSmooth * input.radii[i];
        float local = noise;
        if (own.bends[i] > std::max(smooth, kNoisySmooth * noise) &&
            own.bends[i] <= kNoisySmooth * kNoisier * noise) {
          local = std::clamp(noise_around(static_cast<std::uint32_t>(i), near), noise,
                             kNoisier * noise);
        }
        sure_[i] = own.bends[i] <= std::max(smooth, kNoisySmooth * local) ? 1 : 0;
      }
    });
  }

  void run() {
    hosts_.assign(sure_.size(), kNobody);
    second_hosts_.assign(sure_.size(), kNobody);
    for (std::uint32_t i = 0; i < sure_.size(); ++i) {
      if (sure_[i] != 0) hosts_[i] = i;
    }
    each_with_memory([this](std::uint32_t i, std::vector<std::uint32_t>& near) {
      if (sure_[i] == 0) {
        take_host(i, near);
      } else if (own_.others[i] != 0) {
        list_sure(i, near);
        second_hosts_[i] = second_host(i, i, near);
      }
    });
    std::vector<std::uint8_t> alone(sure_.size());
    each_with_memory([&](std::uint32_t i, std::vector<std::uint32_t>& near) {
      if (hosts_[i] == kNobody) alone[i] = is_among_homeless(i, near) ? 1 : 0;
    });
    for (std::uint32_t i = 0; i < alone.size(); ++i) {
      if (hosts_[i] != kNobody) continue;
      sure_[i] = alone[i];
      if (alone[i] != 0) hosts_[i] = i;
      if (alone[i] == 0) own_.confidences[i] = 0;
    }
  }

  [[nodiscard]] const std::vector<std::uint8_t>& sure() const { return sure_; }
  /// The sure point whose fit each has: itself, or one that it was snapped to, or kNobody.
  [[nodiscard]] const std::vector<std::uint32_t>& hosts() const { return hosts_; }
  [[nodiscard]] std::vector<Twin> twins() const {
    std::vector<Twin> twins;
    for (std::uint32_t i = 0; i < second_hosts_.size(); ++i) {
      if (second_hosts_[i] != kNobody) twins.push_back({i, second_hosts_[i]});
    }
    return twins;
  }

 private:
  /// Noise is not the same everywhere: what the flattest quarter of the fits around leaves, m.
  float noise_around(std::uint32_t i, std::vector<std::uint32_t>& near) const {
    near.clear();
    input_.grid.within(input_.grid.points()[i], kNoiseReach * input_.radii[i], near);
    const auto quarter = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 4);
    std::nth_element(near.begin(), quarter, near.end(), [this](std::uint32_t a, std::uint32_t b) {
      return own_.bends[a] < own_.bends[b];
    });
    return own_.bends[*quarter];
  }

  /// Sure points around; where they are few, as in the foot of a narrow crease, farther ones too.
  void list_sure(std::uint32_t i, std::vector<std::uint32_t>& near) const {
    for (const float reach : {kSnapReach, kFarSnapReach}) {
      near.clear();
      input_.grid.within(input_.grid.points()[i], reach * input_.radii[i], near);
      std::erase_if(near, [this](std::uint32_t j) { return sure_[j] == 0; });
      if (near.size() >= kFewSure) return;
    }
  }

  template <class Body>
  void each_with_memory(const Body& body) const {
    detail::parallel_ranges(sure_.size(), 512, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> near;
      for (std::size_t i = begin; i < end; ++i) body(static_cast<std::uint32_t>(i), near);
    });
  }

  void take_host(std::uint32_t i, std::vector<std::uint32_t>& near) {
    list_sure(i, near);
    const std::uint32_t host = best_host(i, near);
    if (host == kNobody) return;
    hosts_[i] = host;
    second_hosts_[i] = second_host(i, host, near);
    const float way = (input_.grid.points()[i] - input_.grid.points()[host]).norm();
    const float turn = kTurnMargin * bow(input_, own_, host) * way;
    if (std::abs(own_.normals[i].dot(own_.normals[host])) < 1 - 0.5f * turn * turn) {
      own_.normals[i] = own_.normals[host];
      own_.residuals[i] = own_.residuals[host];
    }
    own_.confidences[i] = std::max(own_.confidences[i], 0.5f * own_.confidences[host]);
  }

  /// Where a thing is so small that hardly a point of it is sure, a plane has to do.
  [[nodiscard]] bool is_among_homeless(std::uint32_t i, std::vector<std::uint32_t>& near) const {
    if (own_.confidences[i] < kPlanar) return false;
    near.clear();
    input_.grid.within(input_.grid.points()[i], input_.radii[i], near);
    const auto homeless =
        std::ranges::count_if(near, [this](std::uint32_t j) { return hosts_[j] == kNobody; });
    return 2 * static_cast<std::size_t>(homeless) >= near.size();
  }

  /// Of sure points the one whose plane the point lies on best.
  [[nodiscard]] std::uint32_t best_host(std::uint32_t i,
                                        const std::vector<std::uint32_t>& near) const {
    float best = std::numeric_limits<float>::infinity();
    std::uint32_t host = kNobody;
    for (const std::uint32_t j : near) {
      const Vector3f way = input_.grid.points()[i] - input_.grid.points()[j];
      const float length = way.norm();
      const float off = std::abs(own_.normals[j].dot(way));
      const float arc = kChord * kTurnMargin * bow(input_, own_, j) * length;
      const float slope = std::max(kSnapSlope, arc);
      if (off > std::max(kSnapResiduals * own_.residuals[j], slope * length)) continue;
      const float cost = off + kNearness * length;
      if (cost >= best) continue;
      best = cost;
      host = j;
    }
    return host;
  }

  /// The nearest sure point of another plane that the point lies on as well.
  [[nodiscard]] std::uint32_t second_host(std::uint32_t i, std::uint32_t first,
                                          const std::vector<std::uint32_t>& near) const {
    float best = std::numeric_limits<float>::infinity();
    std::uint32_t host = kNobody;
    for (const std::uint32_t j : near) {
      if (std::abs(own_.normals[first].dot(own_.normals[j])) > kOtherPlane) continue;
      const Vector3f way = input_.grid.points()[i] - input_.grid.points()[j];
      const float off = std::abs(own_.normals[j].dot(way));
      const float on = std::max(kSnapResiduals * own_.residuals[j], kOnBoth * input_.spacings[i]);
      const float squared = way.squaredNorm();
      if (off > on || squared >= best) continue;
      best = squared;
      host = j;
    }
    return host;
  }

  const SheetInput& input_;
  OwnSheets& own_;
  std::vector<std::uint8_t> sure_;
  std::vector<std::uint32_t> hosts_;
  std::vector<std::uint32_t> second_hosts_;
};

struct Pair {
  std::uint32_t a;
  std::uint32_t b;
  int sign;
};

/// Joins points that continue each other's sheets: within each block on its own, and across blocks
/// afterwards, in a fixed order.
class Growth {
 public:
  /// `hosts`: of each point the one whose fit it has; kNobody: it is on no sheet.
  Growth(const SheetInput& input, const OwnSheets& own, const std::vector<std::uint32_t>& hosts)
      : input_(input), own_(own), hosts_(hosts), sets_(input.grid.size()) {}

  detail::SignedSets& run() {
    const auto blocks = detail::make_blocks(input_.grid, detail::kBlockPoints);
    std::vector<std::vector<Pair>> across(blocks.size());
    detail::parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
      detail::Surroundings surroundings;
      std::vector<simd::Hit> hits;
      for (std::size_t b = begin; b < end; ++b) look(blocks[b], surroundings, hits, across[b]);
    });
    for (const auto& pairs : across) {
      for (const Pair& pair : pairs) sets_.join(pair.a, pair.b, pair.sign);
    }
    return sets_;
  }

 private:
  void look(const detail::Block& block, detail::Surroundings& surroundings,
            std::vector<simd::Hit>& hits, std::vector<Pair>& across) {
    const detail::Reach reach{.of_points = input_.spacings, .times = kPairReach, .of_cells = {}};
    detail::for_each_part(
        input_.grid, reach, block, surroundings,
        [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
          std::size_t candidates = 1;
          for (const simd::Run& run : runs) candidates += run.end - run.begin;
          if (hits.size() < candidates) hits.resize(2 * candidates);
          simd::Row squared = {};
          for (std::uint32_t q = 0; q < count; ++q) {
            const float own = kPairReach * input_.spacings[first + q];
            squared[q] = own * own;
          }
          const simd::Join join = detail::make_join(input_.grid, first, count, runs);
          const std::size_t found = simd::best_joins().within(join, squared, hits.data());
          for (std::size_t h = 0; h < found; ++h) {
            for (std::uint32_t bits = hits[h].queries; bits != 0; bits &= bits - 1) {
              meet(first + static_cast<std::uint32_t>(std::countr_zero(bits)), hits[h].candidate,
                   block, across);
            }
          }
        });
  }

  /// Do i and j, which are near each other, lie on one sheet? Of points that were snapped, their
  /// hosts tell: at a sharp rim, where the two sides meet, these are as far apart as the sides are.
  void meet(std::uint32_t i, std::uint32_t j, const detail::Block& block,
            std::vector<Pair>& across) {
    if (i == j || hosts_[i] == kNobody || hosts_[j] == kNobody) return;
    const bool inside = j >= block.begin && j < block.end;
    if (inside && j < i && sets_.find(i).first == sets_.find(j).first) return;
    const std::uint32_t a = hosts_[i];
    const std::uint32_t b = hosts_[j];
    const Vector3f way = input_.grid.points()[b] - input_.grid.points()[a];
    const float length = way.norm();
    const float near = (input_.grid.points()[j] - input_.grid.points()[i]).norm();
    const float bowed = std::min(bow(input_, own_, a), bow(input_, own_, b));
    const float turn = std::max(kTurn, kTurnMargin * bowed * length);
    const float cosine = own_.normals[i].dot(own_.normals[j]);
    if (std::abs(cosine) < 1 - 0.5f * turn * turn) return;
    const float off =
        std::max(std::abs(own_.normals[a].dot(way)), std::abs(own_.normals[b].dot(way)));
    const float arc = kChord * std::max(kTurn * near, kTurnMargin * bowed * length * length);
    if (off > std::max(sheet_tolerance(input_, own_, a, b), arc)) return;
    const int sign = cosine < 0 ? -1 : 1;
    if (inside) {
      sets_.join(i, j, sign);
    } else {
      across.push_back({i, j, sign});
    }
  }

  const SheetInput& input_;
  const OwnSheets& own_;
  const std::vector<std::uint32_t>& hosts_;
  detail::SignedSets sets_;
};

}  // namespace

float sheet_tolerance(const SheetInput& input, const OwnSheets& own, std::uint32_t i,
                      std::uint32_t j) {
  const float least = std::max(static_cast<float>(input.noise),
                               kLeastTolerance * std::min(input.spacings[i], input.spacings[j]));
  return 3 * std::min(std::max(own.residuals[i], own.residuals[j]), least);
}

Growths grow_sheets(const SheetInput& input, OwnSheets& own) {
  Growths result;
  Snapping snapping(input, own);
  snapping.run();
  result.sure = snapping.sure();
  result.twins = snapping.twins();
  Growth growth(input, own, snapping.hosts());
  detail::SignedSets& sets = growth.run();
  const std::size_t count = input.grid.size();
  std::vector<std::uint32_t>& sheet = result.sheets.sheet;
  sheet.assign(count, PointSheets::kNone);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (snapping.hosts()[i] == kNobody) continue;
    const auto [root, sign] = sets.find(i);
    if (sign < 0) own.normals[i] = -own.normals[i];
    if (root == i) {  // before all others of its sheet
      sheet[i] = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
    }
    ++sizes[sheet[i] = sheet[root]];
  }
  std::erase_if(result.twins,
                [&](const Twin& twin) { return sheet[twin.point] == sheet[twin.host]; });
  result.sheets.part.resize(sizes.size());
  std::iota(result.sheets.part.begin(), result.sheets.part.end(), 0u);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (sheet[i] != PointSheets::kNone && sizes[sheet[i]] < kFewest) {
      own.confidences[i] *= kTrustOfFew;
    }
  }
  return result;
}

}  // namespace palpate
