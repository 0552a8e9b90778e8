// Decides where a store's cube lies, its step, and which cubes are sorted by themselves.
#include "extras/tile/plan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "extras/tile/pieces.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

using Inputs = const std::vector<TileInput>&;

constexpr std::size_t kSample = std::size_t{1}
                                << 20U;   // points: a chunk of 10^9 has 8000 (judgement)
constexpr std::uint16_t kByteTo16 = 257;  // 255 becomes 65535

// Some of the positions of points: all, or those whose hash ends in zeros. So it does not depend on
// their order.
class Sample {
 public:
  void add(const Numbers& numbers) {
    if (!takes(numbers)) return;
    positions_.push_back(numbers);
    constexpr std::uint64_t kSparsest = 0xFFFF;  // one in so many
    while (positions_.size() > kSample && zeros_ < kSparsest) {
      zeros_ = 2 * zeros_ + 1;
      std::erase_if(positions_, [&](const Numbers& each) { return !takes(each); });
    }
  }

  // The largest cubes of at most `most` points along the Morton curve.
  std::vector<Cell> chunks(const Numbers& lowest, int bits, std::size_t most) {
    for (Numbers& each : positions_) {
      for (std::size_t k = 0; k < 3; ++k) each[k] -= lowest[k];
    }
    std::ranges::sort(positions_, before);
    std::vector<Cell> cells;
    split({}, positions_, bits, most / (zeros_ + 1), cells);
    return cells;
  }

 private:
  [[nodiscard]] bool takes(const Numbers& n) const {
    // Spreads every bit over all of it, as SplitMix64 does at its end.
    std::uint64_t z = (std::uint64_t{n[0]} << 32U | n[1]) ^ n[2] * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return ((z ^ (z >> 31)) & zeros_) == 0;
  }

  void split(const Cell& cell, std::span<const Numbers> inside, int bits, std::size_t most,
             std::vector<Cell>& cells) const {
    if (inside.empty() && zeros_ == 0) return;
    if (inside.size() <= most || cell.level == bits) return cells.push_back(cell);
    for (unsigned i = 0; i < 8; ++i) {
      const auto end = std::ranges::partition_point(
          inside, [&](const Numbers& n) { return child_at(n, cell.level, bits) <= i; });
      const auto count = static_cast<std::size_t>(end - inside.begin());
      split(cell.child(i), inside.first(count), bits, most, cells);
      inside = inside.subspan(count);
    }
  }

  std::vector<Numbers> positions_;
  std::uint64_t zeros_ = 0;  // the bits of a hash that are zero
};

int bits_for(const Eigen::Vector3d& steps) {
  int bits = 0;
  while (bits <= kMostBits && std::ldexp(1.0, bits) < steps.maxCoeff() + 1) ++bits;
  return bits;
}

// The finest step of the surveys, where that of each is a whole number of it; else one that suits
// the longest.
double common_step(Inputs inputs) {
  double finest = std::numeric_limits<double>::infinity();
  double length = 0;
  for (const TileInput& each : inputs) {
    finest = std::min(finest, each.steps.cwiseAbs().minCoeff());
    length = std::max(length, each.length);
  }
  constexpr double kEqual = 1e-9;  // doubles that were computed by two methods (judgement)
  const bool agree = finest > 0 && std::ranges::all_of(inputs, [&](const TileInput& each) {
                       const Eigen::Array3d ratio = each.steps.cwiseAbs().array() / finest;
                       return ((ratio - ratio.round()).abs() < kEqual * ratio).all();
                     });
  return agree ? finest : step_for(length);
}

// Finds out what there is, in steps of one length.
class Survey {
 public:
  Survey(Inputs inputs, const Frame& frame, const Report& report)
      : intensities_(inputs.size()), colors_(inputs.size()) {
    plan_.frame = frame;
    for (const TileInput& each : inputs) plan_.dropped += each.points;
    read_all(inputs, frame, report, [&](const Piece& piece) {
      plan_.points += piece.points.size();
      plan_.dropped -= piece.points.size();
      box_.extend(piece.box);
      for (const StorePoint& point : piece.points) add(point, piece.input);
    });
    if (!box_.empty()) return;
    throw Error(
        fmt::format("{}: no point that can be used ({} are marked as not to be). Give "
                    "another file.",
                    inputs.front().name, plan_.dropped));
  }

  [[nodiscard]] int bits() const { return bits_for(box_.size()); }

  Plan plan(std::size_t most) {
    plan_.frame.low = box_.lower;
    plan_.frame.bits = bits();
    Numbers lowest{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto low = static_cast<std::int64_t>(box_.lower[static_cast<int>(k)]);
      lowest[k] = static_cast<std::uint32_t>(low);
      plan_.highest[k] = static_cast<std::uint32_t>(
          static_cast<std::int64_t>(box_.upper[static_cast<int>(k)]) - low);
    }
    plan_.chunks = sample_.chunks(lowest, plan_.frame.bits, most);
    for (std::size_t i = 0; i < colors_.size(); ++i) finish_columns(i);
    return std::move(plan_);
  }

 private:
  void add(const StorePoint& point, std::size_t input) {
    sample_.add(point.numbers);
    intensities_[input].add(point.intensity);
    for (std::size_t k = 0; k < 3; ++k) colors_[input][k].add(point.color[k]);
  }

  // A column is kept that is in all inputs and nowhere zero throughout.
  void finish_columns(std::size_t input) {
    const auto& color = colors_[input];
    const std::uint16_t most = std::max({color[0].high, color[1].high, color[2].high});
    plan_.layout.intensities &= intensities_[input].high > 0;
    plan_.layout.colors &= most > 0;
    const std::uint16_t factor = most <= 255 ? kByteTo16 : std::uint16_t{1};
    plan_.color_factors.push_back(factor);
    const auto join = [](const Range& range, std::uint16_t by, Range& all) {
      all.add(static_cast<std::uint16_t>(by * range.low));
      all.add(static_cast<std::uint16_t>(by * range.high));
    };
    join(intensities_[input], 1, plan_.intensity);
    for (std::size_t k = 0; k < 3; ++k) join(color[k], factor, plan_.color[k]);
  }

  Plan plan_;
  Box box_;  // steps from the origin
  Sample sample_;
  std::vector<Range> intensities_;  // of each input
  std::vector<std::array<Range, 3>> colors_;
};

}  // namespace

Plan make_plan(const std::vector<TileInput>& inputs, std::size_t most, const Report& report) {
  constexpr std::size_t kMostPoints = std::numeric_limits<std::int32_t>::max();
  std::size_t points = 0;
  for (const TileInput& each : inputs) points += each.points;
  if (points > kMostPoints) {
    throw Error(fmt::format("{} points, but a store holds {} at most. Tile fewer files at once.",
                            points, kMostPoints));
  }
  Frame frame{.step = common_step(inputs), .origin = inputs.front().origin};
  while (true) {
    Survey survey(inputs, frame, report);
    if (survey.bits() <= kMostBits) return survey.plan(most);
    frame.step *= 10;  // the step is too fine for so large a cube
  }
}

}  // namespace palpate::io::tile
