// Makes terrain of any size, each point from its number alone.
#include <algorithm>
#include <cmath>

#include "extras/tile/input.hpp"

namespace palpate::io::tile {
namespace {

constexpr double kSpacing = 0.1;         // m, between points
constexpr double kStep = 1e-3;           // m, of coordinates
constexpr double kNoise = 0.1;           // m, from side to side: 3 cm of deviation
constexpr double kPlot = 40;             // m, edge of a square with a house or none
constexpr std::size_t kPiece = 1 << 16;  // points made at once (judgement)

// Four numbers in [0, 1) of a number: spreads every bit over all, as SplitMix64 does at its end.
Eigen::Array4d drawn(std::uint64_t z) {
  z *= 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  z ^= z >> 31;
  const auto part = [&](unsigned k) {
    return 0x1p-16 * static_cast<double>(z >> (16 * k) & 0xFFFF);
  };
  return {part(0), part(1), part(2), part(3)};
}

double ground(double x, double y) {
  return 25 * std::sin(x / 97) * std::cos(y / 71) + 0.3 * std::sin(x / 3.1 + y / 17);
}

// Hills, and a flat roof on three plots of ten.
double height(double x, double y) {
  const double i = std::floor(x / kPlot);
  const double j = std::floor(y / kPlot);
  const Eigen::Array4d house = drawn(static_cast<std::uint64_t>(j * 65536 + i));
  const Eigen::Array2d off(x - kPlot * (i + 0.5), y - kPlot * (j + 0.5));
  const bool under = house[0] < 0.3 && (off.abs() < 5 + 10 * house.segment<2>(1)).all();
  return under ? ground(kPlot * (i + 0.5), kPlot * (j + 0.5)) + 4 + 8 * house[3] : ground(x, y);
}

InputPoint point(std::size_t i, std::size_t columns) {
  const Eigen::Array4d chance = drawn(i);
  const double x = kSpacing * (static_cast<double>(i % columns) + chance[0]);
  const double y = kSpacing * (static_cast<double>(i / columns) + chance[1]);
  return {{x, y, height(x, y) + kNoise * (chance[2] - 0.5)}};
}

}  // namespace

TileInput make_terrain(std::size_t points) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(points))));
  TileInput input{.name = "synthetic:terrain", .points = points};
  input.pieces = (points + kPiece - 1) / kPiece;
  input.steps = Eigen::Vector3d::Constant(kStep);
  input.read = [points, columns](std::size_t piece) {
    const std::size_t first = piece * kPiece;
    std::vector<InputPoint> made(std::min(kPiece, points - first));
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = point(first + k, columns);
    return made;
  };
  return input;
}

}  // namespace palpate::io::tile
