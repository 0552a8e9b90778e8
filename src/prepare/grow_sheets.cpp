// Joins points into sheets, and asks pairs of points how the sheets around them lie.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "field/formulas.hpp"
#include "geometry/neighborhoods.hpp"
#include "prepare/sheets.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr float kNoneNear = std::numeric_limits<float>::infinity();

// The next other sheet along a normal.
constexpr float kGapReach = 1.6f;  // R
constexpr float kGapTube = 1.3f;   // spacings to the side
constexpr float kGapSlope = 0.5f;  // of the way to the side, the least height
constexpr float kGapCosine = 0.8f;
constexpr float kGapTrust = 0.3f;
constexpr float kGapResiduals = 3;
constexpr float kGapSpacings = 0.3f;

// Votes of one sheet on another.
constexpr float kVoteReach = 1.3f;  // R
constexpr std::size_t kVoteSheets = 4;
constexpr int kVotesEach = 3;
/// What the points of one block see of other sheets.
class Outlook {
 public:
  Outlook(const SheetInput& input, const OwnSheets& own, Growths& grown)
      : input_(input), own_(own), sheets_(grown.sheets), sure_(grown.sure) {}

  void look(const detail::Block& block, detail::Surroundings& surroundings,
            std::vector<SheetVote>& votes) {
    const detail::Reach reach{.of_points = input_.radii, .times = kGapReach, .of_cells = {}};
    detail::for_each_part(
        input_.grid, reach, block, surroundings,
        [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
          if (!alone(first, runs)) look_from(first, count, runs, votes);
        });
  }

 private:
  /// Is there but one sheet, and does it not curl up?
  [[nodiscard]] bool alone(std::uint32_t first, std::span<const simd::Run> runs) const {
    constexpr float kCurled = 0.3f;
    const std::uint32_t sheet = sheets_.sheet[first];
    const Vector3f& n = own_.normals[first];
    for (const simd::Run& run : runs) {
      for (std::uint32_t j = run.begin; j < run.end; ++j) {
        if (sheets_.sheet[j] != sheet || !(n.dot(own_.normals[j]) > kCurled)) return false;
      }
    }
    return true;
  }

  void look_from(std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs,
                 std::vector<SheetVote>& votes) {
    for (std::uint32_t q = 0; q < count; ++q) {
      others_[q].clear();
      eyes_[q] = eye_at(first + q);
    }
    pairs_.each(
        input_.grid, first, count, runs,
        [this](std::uint32_t i) {
          return own_.confidences[i] > 0 ? kGapReach * input_.radii[i] : 0;
        },
        [&](std::uint32_t i, std::uint32_t j) { meet(first, i - first, j); });
    for (std::uint32_t q = 0; q < count; ++q) vote(first + q, others_[q], votes);
  }

  /// What a point sees others with: copies, so that a pair costs few reads of memory.
  struct Eye {
    Vector3f at;
    Vector3f normal;
    float tube;    // to the side, m
    float least;   // height of another sheet, m
    float voting;  // squared reach, m^2; below 0: it has no vote
    std::uint32_t sheet;
  };

  [[nodiscard]] Eye eye_at(std::uint32_t i) const {
    const float spacing = input_.spacings[i];
    const float voting = kVoteReach * input_.radii[i];
    return {input_.grid.points()[i],
            own_.normals[i],
            kGapTube * spacing,
            std::max(kGapResiduals * own_.residuals[i], kGapSpacings * spacing),
            sure_[i] != 0 ? voting * voting : -1,
            sheets_.sheet[i]};
  }

  void meet(std::uint32_t first, std::uint32_t q, std::uint32_t j) {
    if (j == first + q) return;
    const Eye& eye = eyes_[q];
    const Vector3f way = input_.grid.points()[j] - eye.at;
    const float squared = way.squaredNorm();
    measure_gap(eye, first + q, j, way, squared);
    const bool votes_on = squared <= eye.voting && sheets_.sheet[j] != eye.sheet && sure_[j] != 0;
    if (votes_on) others_[q].push_back({squared, j});
  }

  void measure_gap(const Eye& eye, std::uint32_t i, std::uint32_t j, const Vector3f& way,
                   float squared) {
    const float height = eye.normal.dot(way);
    const float off = std::abs(height);
    if (off <= eye.least) return;
    const float aside = std::max(0.f, squared - height * height);
    if (aside > eye.tube * eye.tube || off < kGapSlope * std::sqrt(aside)) return;
    if (own_.confidences[j] < kGapTrust) return;
    if (std::abs(eye.normal.dot(own_.normals[j])) < kGapCosine) return;
    float& gap = height > 0 ? sheets_.above[i] : sheets_.below[i];
    gap = std::min(gap, off);
  }

  /// The nearest points of the nearest other sheets.
  void vote(std::uint32_t i, std::vector<std::pair<float, std::uint32_t>>& others,
            std::vector<SheetVote>& votes) {
    std::sort(others.begin(), others.end());
    std::array<std::pair<std::uint32_t, int>, kVoteSheets> heard{};
    std::size_t count = 0;
    for (const auto& [squared, j] : others) {
      const std::uint32_t sheet = sheets_.sheet[j];
      std::size_t k = 0;
      while (k < count && heard[k].first != sheet) ++k;
      if (k == kVoteSheets) continue;
      if (k == count) heard[count++] = {sheet, 0};
      if (heard[k].second++ >= kVotesEach) continue;
      const Vector3f way = input_.grid.points()[j] - input_.grid.points()[i];
      const auto [a, b] = std::minmax(sheets_.sheet[i], sheet);
      votes.push_back(
          {a, b,
           agreement(own_.normals[i], own_.normals[j], way, sheet_tolerance(input_, own_, i, j))});
    }
  }

  const SheetInput& input_;
  const OwnSheets& own_;
  SurfacePoints::Sheets& sheets_;
  const std::vector<std::uint8_t>& sure_;
  detail::NearPairs pairs_;
  std::array<Eye, simd::kQueries> eyes_;
  std::array<std::vector<std::pair<float, std::uint32_t>>, simd::kQueries> others_;
};

}  // namespace

std::vector<SheetVote> look_around(const SheetInput& input, const OwnSheets& own, Growths& grown) {
  grown.sheets.above.assign(input.grid.size(), kNoneNear);
  grown.sheets.below.assign(input.grid.size(), kNoneNear);
  const auto blocks = detail::make_blocks(input.grid, detail::kBlockPoints);
  std::vector<std::vector<SheetVote>> votes(blocks.size());
  detail::parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    detail::Surroundings surroundings;
    Outlook outlook(input, own, grown);
    for (std::size_t b = begin; b < end; ++b) outlook.look(blocks[b], surroundings, votes[b]);
  });
  std::vector<SheetVote> all;
  for (const auto& some : votes) all.insert(all.end(), some.begin(), some.end());
  std::stable_sort(all.begin(), all.end(), [](const SheetVote& x, const SheetVote& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  return all;
}

namespace {

using Eigen::Vector3f;

// Two points continue each other's sheet.
constexpr float kPairReach = 1.6f;  // spacings
constexpr float kTurn = 0.28f;      // rad (16 degrees) that normals of one sheet may turn, or more
constexpr float kLeastTolerance = 0.15f;  // spacings that a residual may always be

constexpr std::uint32_t kFewestOnSheet = 8;  // points of a sheet
constexpr float kTrustOfFew = 0.1f;

struct Pair {
  std::uint32_t a;
  std::uint32_t b;
  int sign;
};

/// Joins points that continue each other's sheets: within each block on its own, and across blocks
/// afterwards, in a fixed order.
class Growth {
 public:
  /// `hosts`: of each point the one whose fit it has; kNoHost: it is on no sheet.
  Growth(const SheetInput& input, const OwnSheets& own, const std::vector<std::uint32_t>& hosts)
      : input_(input), own_(own), hosts_(hosts), sets_(input.grid.size()) {}

  detail::SignedSets& run() {
    const auto blocks = detail::make_blocks(input_.grid, detail::kBlockPoints);
    std::vector<std::vector<Pair>> across(blocks.size());
    detail::parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
      detail::Surroundings surroundings;
      detail::NearPairs pairs;
      for (std::size_t b = begin; b < end; ++b) look(blocks[b], surroundings, pairs, across[b]);
    });
    for (const auto& pairs : across) {
      for (const Pair& pair : pairs) sets_.join(pair.a, pair.b, pair.sign);
    }
    return sets_;
  }

 private:
  void look(const detail::Block& block, detail::Surroundings& surroundings,
            detail::NearPairs& pairs, std::vector<Pair>& across) {
    const detail::Reach reach{.of_points = input_.spacings, .times = kPairReach, .of_cells = {}};
    detail::for_each_part(
        input_.grid, reach, block, surroundings,
        [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
          pairs.each(
              input_.grid, first, count, runs,
              [this](std::uint32_t i) { return kPairReach * input_.spacings[i]; },
              [&](std::uint32_t i, std::uint32_t j) { meet(i, j, block, across); });
        });
  }

  /// Do i and j, which are near each other, lie on one sheet? Of points that were snapped, their
  /// hosts tell: at a sharp rim, where the two sides meet, these are as far apart as the sides are.
  void meet(std::uint32_t i, std::uint32_t j, const detail::Block& block,
            std::vector<Pair>& across) {
    if (i == j || hosts_[i] == kNoHost || hosts_[j] == kNoHost) return;
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
    // An arc's normals turn by twice as much as it leaves their planes.
    const float turned =
        std::sqrt(std::max(0.f, 2 - 2 * std::abs(own_.normals[a].dot(own_.normals[b]))));
    const float bend = std::min(kTurnMargin * bowed * length, turned + kTurn);
    const float arc = kChord * std::max(kTurn * near, bend * length);
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
  const float least = std::max(std::max(input.noise[i], input.noise[j]),
                               kLeastTolerance * std::min(input.spacings[i], input.spacings[j]));
  return 3 * std::min(std::max(own.residuals[i], own.residuals[j]), least);
}

Growths grow_sheets(const SheetInput& input, OwnSheets& own) {
  Growths result;
  Snapped snapped = snap_to_planes(input, own);
  result.sure = std::move(snapped.sure);
  result.twins = std::move(snapped.twins);
  Growth growth(input, own, snapped.hosts);
  detail::SignedSets& sets = growth.run();
  const std::size_t count = input.grid.size();
  std::vector<std::uint32_t>& sheet = result.sheets.sheet;
  sheet.assign(count, SurfacePoints::Sheets::kNone);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (snapped.hosts[i] == kNoHost) continue;
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
    if (sheet[i] != SurfacePoints::Sheets::kNone && sizes[sheet[i]] < kFewestOnSheet) {
      own.confidences[i] *= kTrustOfFew;
    }
  }
  return result;
}

}  // namespace palpate
