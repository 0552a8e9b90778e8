// Decides where a store's cube lies, its step, and which cubes are sorted by themselves.
#include "io/tile/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/cloud_builder.hpp"
#include "io/tile/in_order.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

constexpr std::size_t kAhead = 8;  // pieces that wait or are read at once (judgement)

Piece convert(const TileInput::Facts& facts, const Frame& frame,
              const std::vector<LasPoint>& points) {
  const Eigen::Vector3d factor = facts.scale / frame.step;
  const Eigen::Vector3d shift = (facts.offset - frame.lower) / frame.step;
  const double end = std::ldexp(1.0, frame.bits);
  Piece piece;
  piece.points.reserve(points.size());
  for (const LasPoint& point : points) {
    const Eigen::Vector3d numbers(point.number[0], point.number[1], point.number[2]);
    if (point.withheld || !is_usable(numbers.cwiseProduct(facts.scale) + facts.offset)) {
      ++piece.dropped;
      continue;
    }
    const Eigen::Vector3d place =
        (numbers.cwiseProduct(factor) + shift).array().unaryExpr([](double x) {
          return std::floor(x + 0.5);
        });
    piece.box.extend(place);
    if ((place.array() < 0).any() || (place.array() >= end).any()) {
      ++piece.outside;
      continue;
    }
    piece.points.push_back(
        {{static_cast<std::uint32_t>(place.x()), static_cast<std::uint32_t>(place.y()),
          static_cast<std::uint32_t>(place.z())},
         point.intensity,
         point.color});
  }
  return piece;
}

int bits_for(const Eigen::Vector3d& steps) {
  int bits = 0;
  while (bits <= kMostBits && std::ldexp(1.0, bits) < steps.maxCoeff() + 1) ++bits;
  return bits;
}

// The finest step of the surveys, where that of each is a whole number of it.
double common_step(const Inputs& inputs, double length) {
  double finest = std::numeric_limits<double>::infinity();
  for (const auto& each : inputs)
    finest = std::min(finest, each->facts().scale.cwiseAbs().minCoeff());
  const bool agree = std::ranges::all_of(inputs, [&](const auto& each) {
    const Eigen::Array3d ratio = each->facts().scale.cwiseAbs().array() / finest;
    constexpr double kEqual = 1e-9;  // doubles that were computed in two ways (judgement)
    return each->facts().surveyed && ((ratio - ratio.round()).abs() < kEqual * ratio).all();
  });
  return agree ? finest : step_for(length);
}

// The smallest cube of whole bits over a box (m). Where the step is too fine for it, ten times as
// coarse, and again.
Frame frame_over(const Box& box, double step, const Eigen::Vector3d& offset) {
  Frame frame{.step = step};
  while ((frame.bits = bits_for(box.size() / frame.step)) > kMostBits) frame.step *= 10;
  const Eigen::Array3d lower = ((box.lower - offset) / frame.step).array().round();
  frame.lower = offset.array() + frame.step * lower;
  return frame;
}

bool is_box(const Box& box) {
  return is_usable(box.lower) && is_usable(box.upper) && !box.empty();
}

class Planner {
 public:
  Planner(const Inputs& inputs, std::size_t most, const Told& told)
      : inputs_(inputs), most_(most), told_(told) {}

  Plan run() {
    Box announced;
    std::size_t points = 0;
    for (const auto& each : inputs_) {
      points += each->facts().points;
      announced.extend(each->facts().box);
    }
    if (points > kMostCounted) {
      throw Error(fmt::format("{} points, but a store holds {} at most. Tile fewer files at once.",
                              points, kMostCounted));
    }
    if (!is_box(announced)) announced = {{0, 0, 0}, {0, 0, 0}};
    step_ = common_step(inputs_, announced.size().maxCoeff());
    Box box = survey(announced);
    // Headers that are wrong cost a second reading.
    if (outside_ > 0 || bits_for(box.size() / plan_.frame.step) != plan_.frame.bits)
      box = survey(box);
    for (CellCounter& counter = *counter_; counter.refine(most_);) count_again(counter);
    finish(box);
    return std::move(plan_);
  }

 private:
  // Counts all points in a cube over `box`; gives the box in which they are (m).
  Box survey(const Box& box) {
    plan_ = {};
    plan_.frame = frame_over(box, step_, inputs_.front()->facts().offset);
    counter_ = std::make_unique<CellCounter>(plan_.frame.bits);
    outside_ = 0;
    intensities_.assign(inputs_.size(), {});
    colors_.assign(inputs_.size(), {});
    Box numbers;
    read_all(inputs_, plan_.frame, told_, [&](const Piece& piece) {
      plan_.points += piece.points.size();
      plan_.dropped += piece.dropped;
      outside_ += piece.outside;
      numbers.extend(piece.box);
      for (const StorePoint& point : piece.points) add(point, piece.input);
    });
    if (numbers.empty()) {
      throw Error(
          fmt::format("{}: no point that can be used ({} are marked as not to be). Give "
                      "another file.",
                      inputs_.front()->facts().name, plan_.dropped));
    }
    const Eigen::Vector3d& lower = plan_.frame.lower;
    return {lower + plan_.frame.step * numbers.lower, lower + plan_.frame.step * numbers.upper};
  }

  void add(const StorePoint& point, std::size_t input) {
    counter_->add(point.numbers);
    intensities_[input].add(point.intensity);
    for (std::size_t k = 0; k < 3; ++k) colors_[input][k].add(point.color[k]);
  }

  void count_again(CellCounter& counter) {
    read_all(inputs_, plan_.frame, told_, [&](const Piece& piece) {
      for (const StorePoint& point : piece.points) counter.add(point.numbers);
    });
  }

  void finish(const Box& box) {
    plan_.chunks = counter_->chunks(most_);
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      const auto number = [&](double place) {
        return static_cast<std::uint32_t>(
            std::lround((place - plan_.frame.lower[axis]) / plan_.frame.step));
      };
      plan_.lowest[k] = number(box.lower[axis]);
      plan_.highest[k] = number(box.upper[axis]);
    }
    plan_.layout = {true, true};
    for (std::size_t i = 0; i < inputs_.size(); ++i) finish_columns(i);
  }

  // A column is kept that is in all inputs and nowhere zero throughout.
  void finish_columns(std::size_t input) {
    constexpr std::uint16_t kByteTo16 = 257;  // 255 becomes 65535
    const auto& color = colors_[input];
    const std::uint16_t most = std::max({color[0].high, color[1].high, color[2].high});
    plan_.layout.intensities &= intensities_[input].high > 0;
    plan_.layout.colors &= most > 0;
    const std::uint16_t factor = most <= 255 ? kByteTo16 : std::uint16_t{1};
    plan_.color_factors.push_back(factor);
    plan_.intensity.add(intensities_[input]);
    for (std::size_t k = 0; k < 3; ++k) {
      plan_.color[k].add(static_cast<std::uint16_t>(factor * color[k].low));
      plan_.color[k].add(static_cast<std::uint16_t>(factor * color[k].high));
    }
  }

  const Inputs& inputs_;
  std::size_t most_;
  const Told& told_;
  double step_ = 0;
  Plan plan_;
  std::unique_ptr<CellCounter> counter_;
  std::size_t outside_ = 0;
  std::vector<Range> intensities_;  // of each input
  std::vector<std::array<Range, 3>> colors_;
};

}  // namespace

void read_all(const Inputs& inputs, const Frame& frame, const Told& told,
              const std::function<void(const Piece&)>& take) {
  std::vector<std::pair<std::size_t, std::size_t>> pieces;  // input, its piece
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t k = 0; k < inputs[i]->pieces(); ++k) pieces.emplace_back(i, k);
  }
  std::size_t done = 0;
  in_order(
      pieces.size(), kAhead,
      [&](std::size_t i) {
        const TileInput& input = *inputs[pieces[i].first];
        Piece piece = convert(input.facts(), frame, input.read(pieces[i].second));
        piece.input = pieces[i].first;
        return piece;
      },
      [&](const Piece& piece) {
        take(piece);
        told(static_cast<double>(++done) / static_cast<double>(pieces.size()));
      });
}

Plan make_plan(const Inputs& inputs, std::size_t most, const Told& told) {
  return Planner(inputs, most, told).run();
}

}  // namespace palpate::io::tile
