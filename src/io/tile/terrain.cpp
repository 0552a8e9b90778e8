// Makes terrain of any size: the height of each point is computed from its place alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "io/tile/input.hpp"

namespace palpate::io::tile {
namespace {

// Metres, all judgement but where it is said otherwise.
constexpr double kSpacing = 0.1;
constexpr double kStep = 1e-3;
constexpr double kNoise = 0.03;
constexpr std::size_t kPiece = 65536;  // points made at once (judgement)

// Spreads every bit of a number over all of it, as SplitMix64 does at its end.
std::uint64_t hash(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

std::uint64_t hash(std::int64_t x, std::int64_t y, std::uint64_t kind) {
  const std::uint64_t both =
      static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(y);
  return hash(both * 0xd1342543de82ef95U + kind);
}

// Four numbers in [0, 1) of a hash.
double part(std::uint64_t bits, unsigned index) {
  return static_cast<double>(bits >> (16 * index) & 0xFFFF) * 0x1p-16;
}

// Hills of one wavelength: heights at the corners of squares, smooth in between. Keeps the last
// square, in which the next place mostly is.
class Hills {
 public:
  Hills(std::uint64_t kind, double wavelength, double height)
      : kind_(kind), frequency_(1 / wavelength), height_(height) {}

  double at(double x, double y) {
    const double u = x * frequency_;
    const double v = y * frequency_;
    const auto i = static_cast<std::int64_t>(std::floor(u));
    const auto j = static_cast<std::int64_t>(std::floor(v));
    if (i != i_ || j != j_) enter(i, j);
    const double s = smooth(u - static_cast<double>(i));
    const double t = smooth(v - static_cast<double>(j));
    const double low = corners_[0] + s * (corners_[1] - corners_[0]);
    const double high = corners_[2] + s * (corners_[3] - corners_[2]);
    return low + t * (high - low);
  }

 private:
  static double smooth(double t) { return t * t * (3 - 2 * t); }

  void enter(std::int64_t i, std::int64_t j) {
    i_ = i;
    j_ = j;
    for (unsigned k = 0; k < 4; ++k) {
      corners_[k] = height_ * (part(hash(i + (k & 1U), j + (k >> 1U), kind_), 0) - 0.5);
    }
  }

  std::uint64_t kind_;
  double frequency_;  // 1/m
  double height_;     // m
  std::int64_t i_ = -1;
  std::int64_t j_ = -1;
  std::array<double, 4> corners_{};  // m
};

class Ground {
 public:
  double at(double x, double y) {
    double z = 0;
    for (Hills& each : hills_) z += each.at(x, y);
    return z;
  }

 private:
  std::array<Hills, 7> hills_{{{1, 640, 60},
                               {2, 320, 30},
                               {3, 160, 15},
                               {4, 80, 7},
                               {5, 40, 3},
                               {6, 10, 0.6},
                               {7, 2, 0.08}}};
};

// A house or a tree on a square of the ground. Keeps the last one, as Hills does.
struct Thing {
  bool there = false;
  double x = 0, y = 0;  // its middle
  double width = 0;     // half of it along x, or the radius of the crown
  double depth = 0;     // along y
  double height = 0;    // over the ground
  double base = 0;      // height of the ground at its middle
  std::int64_t i = -1, j = -1;
};

class Scenery {
 public:
  double height(double x, double y, std::uint64_t drawn) {
    if (settle(house_, x, y, kPlot)) {
      const double inside =
          std::min(house_.width - std::abs(x - house_.x), house_.depth - std::abs(y - house_.y));
      constexpr double kWall = 0.3;  // points so near to the rim are on the wall
      if (inside > kWall) return house_.base + house_.height;
      if (inside > 0) return house_.base + house_.height * part(drawn, 3);
    }
    const double ground = ground_.at(x, y);
    if (settle(tree_, x, y, kTree)) {
      const double square =
          tree_.width * tree_.width - (x - tree_.x) * (x - tree_.x) - (y - tree_.y) * (y - tree_.y);
      constexpr double kThrough = 0.4;  // share of the rays that reach the ground
      const double share = part(drawn, 3);
      if (square > 0 && share > kThrough) {
        return tree_.base + tree_.height + (share > 0.7 ? 1 : -1) * std::sqrt(square);
      }
    }
    return ground;
  }

 private:
  static constexpr double kPlot = 40;
  static constexpr double kTree = 8;

  // Finds the thing on the square of a place; false: there is none.
  bool settle(Thing& thing, double x, double y, double square) {
    const auto i = static_cast<std::int64_t>(x / square);
    const auto j = static_cast<std::int64_t>(y / square);
    if (i == thing.i && j == thing.j) return thing.there;
    const std::uint64_t drawn = hash(i, j, square == kPlot ? 100 : 101);
    const double middle = 0.5 * square;
    thing = {.there = part(drawn, 0) < 0.3,
             .x = static_cast<double>(i) * square + middle,
             .y = static_cast<double>(j) * square + middle,
             .width = square * (0.15 + 0.2 * part(drawn, 1)),
             .depth = square * (0.15 + 0.2 * part(drawn, 2)),
             .height = 4 + 8 * part(drawn, 3),
             .i = i,
             .j = j};
    if (thing.there) thing.base = middle_.at(thing.x, thing.y);
    return thing.there;
  }

  Ground ground_;
  Ground middle_;  // another, so that both keep their squares
  Thing house_;
  Thing tree_;
};

class Terrain final : public TileInput {
 public:
  explicit Terrain(std::size_t points)
      : columns_(static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(points))))) {
    const double side = kSpacing * static_cast<double>(columns_);
    facts_.name = "synthetic:terrain";
    facts_.format = "made terrain";
    facts_.points = points;
    facts_.scale = Eigen::Vector3d::Constant(kStep);
    facts_.offset = Eigen::Vector3d::Zero();
    facts_.box = {{0, 0, -64}, {side, side, 80}};  // wider than all hills and houses
    facts_.intensities = facts_.colors = false;
    facts_.surveyed = true;
  }

  [[nodiscard]] const Facts& facts() const override { return facts_; }
  [[nodiscard]] std::size_t pieces() const override {
    return (facts_.points + kPiece - 1) / kPiece;
  }

  [[nodiscard]] std::vector<LasPoint> read(std::size_t piece) const override {
    const std::size_t first = piece * kPiece;
    std::vector<LasPoint> points(std::min(kPiece, facts_.points - first));
    Scenery scenery;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = point(first + i, scenery);
    return points;
  }

 private:
  [[nodiscard]] LasPoint point(std::size_t i, Scenery& scenery) const {
    const std::uint64_t place = hash(i * 0x9e3779b97f4a7c15U);
    const std::uint64_t noise = hash(place + 1);
    const double x = kSpacing * (static_cast<double>(i % columns_) + part(place, 0));
    const double y = kSpacing * (static_cast<double>(i / columns_) + part(place, 1));
    double sum = -2;  // four even numbers together are nearly normal, with variance 4 / 12
    for (unsigned k = 0; k < 4; ++k) sum += part(noise, k);
    const double z = scenery.height(x, y, place) + kNoise * std::sqrt(3.0) * sum;
    LasPoint point{};
    point.number = {number(x), number(y), number(z)};
    return point;
  }

  static std::int32_t number(double metres) {
    return static_cast<std::int32_t>(std::floor(metres / kStep + 0.5));
  }

  std::size_t columns_;
  Facts facts_;
};

}  // namespace

std::unique_ptr<TileInput> open_terrain(std::size_t points) {
  return std::make_unique<Terrain>(points);
}

}  // namespace palpate::io::tile
