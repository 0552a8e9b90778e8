// Reads the points of inputs side by side, in whole steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "extras/tile/in_order.hpp"
#include "extras/tile/plan.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::io::tile {

/// What reading a piece of an input gave.
struct Piece {
  std::size_t input = 0;
  std::vector<StorePoint> points;  ///< their numbers modulo 2^32
  Box box;                         ///< of these, steps from the frame's corner
};

[[nodiscard]] inline Piece piece_of(const std::vector<InputPoint>& points, const Frame& frame) {
  constexpr double kFar = 1e18;  // steps: an int64 holds them
  Piece piece;
  piece.points.reserve(points.size());
  for (const InputPoint& point : points) {
    const Eigen::Vector3d steps = (point.position - frame.origin) / frame.step;
    const Eigen::Vector3d rounded = (steps.array() + 0.5).floor().matrix() - frame.low;
    piece.box.extend(rounded);
    const auto number = [&](int axis) {
      return static_cast<std::uint32_t>(
          static_cast<std::int64_t>(std::clamp(rounded[axis], -kFar, kFar)));
    };
    piece.points.push_back({{number(0), number(1), number(2)}, point.intensity, point.color});
  }
  return piece;
}

/// Reads all points of all inputs and calls take() with one piece after another.
template <class Take>
void read_all(const std::vector<TileInput>& inputs, const Frame& frame, const Report& report,
              const Take& take) {
  constexpr std::size_t kAhead = 8;  // pieces that wait or are read at once (judgement)
  std::vector<std::pair<std::size_t, std::size_t>> pieces;  // input, its piece
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t k = 0; k < inputs[i].pieces; ++k) pieces.emplace_back(i, k);
  }
  std::size_t done = 0;
  const auto read = [&](std::size_t i) {
    Piece piece = piece_of(inputs[pieces[i].first].read(pieces[i].second), frame);
    piece.input = pieces[i].first;
    return piece;
  };
  in_order(pieces.size(), kAhead, read, [&](const Piece& piece) {
    take(piece);
    report(static_cast<double>(++done) / static_cast<double>(pieces.size()));
  });
}

}  // namespace palpate::io::tile
