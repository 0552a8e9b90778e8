// Refits blocks beside an edge, each from the blocks of its own face alone.
#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "depth/window_fits.hpp"

namespace palpate::depth {
namespace {

using Eigen::Vector3d;

constexpr int kDirections[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                   {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
constexpr int kBehind = 4;  // blocks from a face's end to one that shows what is beyond (judgement)
constexpr int kLook = 2;    // blocks around the meeting line: 5 x 5 (docs/method.md 6.4)
constexpr int kFarLook = 6;  // blocks; largest reach of the paraboloid (judgement)
// Squared cosine of 45 degrees: what turns less may be round (docs/method.md 6.4)
constexpr double kTurnedSquare = 0.5;
// Variances: three deviations squared between planes, and by which a paraboloid has to fit better
// (docs/method.md 6.4)
constexpr double kClearlyAhead = 9;

FacePlane face_plane(const BlockFits& fits, int column, int row) {
  const std::size_t i = fits.grid.index(column, row);
  const double x = fits.grid.step_x;
  const double y = fits.grid.step_y;
  const double slope_variance = fits.slope_variance[i] * std::max(x * x, y * y);
  return {column,           row,           fits.rho[i], fits.slope_x[i] * x, fits.slope_y[i] * y,
          fits.variance[i], slope_variance};
}

// Normal of the plane, not normalised.
Vector3d direction_of(const BlockGrid& grid, const FacePlane& plane) {
  const double x = plane.x / grid.step_x;
  const double y = plane.y / grid.step_y;
  return {x, y, plane.rho - x * grid.x(plane.column) - y * grid.y(plane.row)};
}

bool is_flat(const BlockFits& fits, int column, int row) {
  const std::size_t i = fits.grid.index(column, row);
  return fits.states[i] == FilteredDepth::State::fitted && fits.flat[i] != 0;
}

// Is the block (u, v) away inside, or does a border cross it?
bool inside_borders(std::span<const HalfImage> borders, int u, int v) {
  return std::ranges::all_of(
      borders, [&](const HalfImage& border) { return border.above(u, v) >= -border.block() / 2; });
}

}  // namespace

// A block that looks for where its face ends.
struct FaceFits::Search {
  const simd::FitInput& in;
  const Blocks& filled;
  const NoiseModel& noise;
  const BlockFits& fits;
  Face& face;
  FacePlane own;
  double variance;   // of a block's measurement
  bool met = false;  // another face

  // Looks in all directions, then fits the face. True when that makes it more precise.
  bool run() {
    const std::size_t i = fits.grid.index(own.column, own.row);
    const int u = 2 * fits.reach_u[i];
    const int v = 2 * fits.reach_v[i];
    for (const auto& [x, y] : kDirections) look(x, y, x == 0 ? v : y == 0 ? u : std::min(u, v));
    if (!met) return false;
    for (int size = simd::kSizes - 1; size >= 0; --size) {  // the largest that is explained
      const auto reach_u = static_cast<int>(std::lround(simd::kRatios[size] * u));
      const auto reach_v = static_cast<int>(std::lround(simd::kRatios[size] * v));
      const auto fit = clipped_fit(in, noise, own, reach_u, reach_v, face.sides());
      if (!fit) continue;
      face.plane = *fit;
      return fit->slope_variance <= kLessPrecise * own.slope_variance;
    }
    return false;
  }

  [[nodiscard]] bool inside(int u, int v) const {
    const int column = own.column + u - in.table.first_column;
    const int row = own.row + v - in.table.first_row;
    return column >= 0 && row >= 0 && column < in.table.columns && row < in.table.rows;
  }

  // Adds the border in the direction (x, y), if one is found.
  void look(int x, int y, int reach) {
    int d = 1;
    for (; inside(d * x, d * y); ++d) {
      if (d > reach) return;
      const float rho = filled.rho[filled.at(own.column + d * x, own.row + d * y)];
      const double off = rho - own.at(d * x, d * y);
      const double room = kOffFace * (variance + own.variance_at(d * x, d * y));
      if (!(rho > 0) || off * off > room) break;
    }
    HalfImage& border = face.borders[face.count++];
    border = {(d - 1.0) * (x * x + y * y), -1.0 * x, -1.0 * y};
    met |= meet((d + kBehind) * x, (d + kBehind) * y, border);
  }

  // Does the plane of the block (u, v) away meet the own one between the two?
  bool meet(int u, int v, HalfImage& border) {
    if (!inside(u, v) || !is_flat(fits, own.column + u, own.row + v)) return false;
    FacePlane other = face_plane(fits, own.column + u, own.row + v);
    const Vector3d here = direction_of(fits.grid, own);
    const Vector3d there = direction_of(fits.grid, other);
    const double cosine = here.dot(there);
    const double same = kTurnedSquare * here.squaredNorm() * there.squaredNorm();
    const double ahead = other.rho - own.at(u, v);
    const double room = kClearlyAhead * (other.variance + own.variance_at(u, v));
    if ((cosine > 0 && cosine * cosine > same) || !(ahead * ahead > room)) return false;
    other.rho -= other.x * u + other.y * v;
    const double sign = ahead > 0 ? 1 : -1;  // the larger inverse depth is seen in a crease
    const HalfImage half{sign * (own.rho - other.rho), sign * (own.x - other.x),
                         sign * (own.y - other.y)};
    const double to = std::max(half.at, 0.0);
    const double t = to / (to + std::abs(ahead));
    const auto to_u = static_cast<int>(std::lround(t * u));
    const auto to_v = static_cast<int>(std::lround(t * v));
    const int apart = std::max(std::abs(u), std::abs(v));
    if (half.at < -half.block() || !explain(other, sign, to_u, to_v)) return false;
    if (is_round(other, sign, to_u, to_v, std::clamp(apart / 2, kLook, kFarLook))) return false;
    border = half;
    border.at -= half.block() / 2;  // blocks that the line crosses see both faces
    return true;
  }

  // Residuals of the edge or crease of both planes at the measured blocks around one, cut off at
  // four deviations.
  struct Left {
    int count = 0;
    double sum = 0;
    double squares = 0;
  };

  [[nodiscard]] Left left_by_both(const FacePlane& other, double sign, int u, int v,
                                  int reach) const {
    const double most = std::sqrt(kOffFace * variance);
    Left left;
    for (int y = v - reach; y <= v + reach; ++y) {
      for (int x = u - reach; x <= u + reach; ++x) {
        const float rho = in.blocks.rho[(own.row + y) * in.blocks.stride + own.column + x];
        if (!(rho > 0)) continue;
        const double off = sign * rho - std::max(sign * own.at(x, y), sign * other.at(x, y));
        const double cut = std::clamp(off, -most, most);
        ++left.count;
        left.sum += cut;
        left.squares += cut * cut;
      }
    }
    return left;
  }

  // Do both planes explain what lies around the block (u, v) away?
  [[nodiscard]] bool explain(const FacePlane& other, double sign, int u, int v) const {
    const Left left = left_by_both(other, sign, u, v, kLook);
    return left.count > 0 &&
           left.squares <= (left.count + 3 * std::sqrt(2.0 * left.count)) * variance;
  }

  // Does one bent surface explain it clearly better than both do, moved along the ray together?
  [[nodiscard]] bool is_round(const FacePlane& other, double sign, int u, int v, int reach) const {
    FacePlane here = own;
    here.column += u;
    here.row += v;
    here.rho = own.at(u, v);
    const auto bent = left_by_paraboloid(in, here, reach);
    const Left left = left_by_both(other, sign, u, v, reach);
    const double both = left.squares - left.sum * left.sum / std::max(left.count, 1);
    return bent && *bent + kClearlyAhead * variance < both;
  }
};

void FaceFits::find(const simd::FitInput& input, const Blocks& filled, const NoiseModel& noise,
                    const KeptTiles& kept, const BlockFits& fits, int tile_row) {
  tiles_.each_middle(fits.grid, tile_row, [&](std::size_t index, int column, int row) {
    if (kept.at(column, row) && is_flat(fits, column, row)) return;  // it was fitted last time
    Face& face = faces_[index];
    face.count = 0;
    face.found = false;
    if (!is_flat(fits, column, row) || fits.reach_u[fits.grid.index(column, row)] == 0) return;
    const FacePlane own = face_plane(fits, column, row);
    const float sigma = block_sigma(noise, static_cast<float>(own.rho));
    face.found = Search{input, filled, noise, fits, face, own, double{sigma} * sigma}.run();
  });
}

// Gives a block the nearest plane that it lies on.
void FaceFits::give(std::span<const Face* const> faces, float rho, float sigma, int column, int row,
                    BlockFits& fits) {
  const std::size_t i = fits.grid.index(column, row);
  const bool flat = fits.flat[i] != 0;
  int least = std::numeric_limits<int>::max();
  for (const Face* face : faces) {
    const FacePlane& plane = face->plane;
    const int u = column - plane.column;
    const int v = row - plane.row;
    const double off = plane.at(u, v) - rho;
    if (u * u + v * v >= least || off * off > kOffFace * sigma * sigma) continue;
    if (std::abs(u) > plane.reach_u || std::abs(v) > plane.reach_v) continue;
    if (!(flat || plane.straight) || !inside_borders(face->sides(), u, v)) continue;
    least = u * u + v * v;
    fits.set(i, plane.at(u, v), plane.variance_at(u, v), plane.x, plane.y, plane.slope_variance);
  }
}

void FaceFits::share(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                     int tile_row, BlockFits& fits) const {
  for (int tile = 0; tile < tiles_.columns; ++tile) {
    if (kept.at(tile * kTile, tile_row * kTile)) continue;
    const Face* near[(2 * kAround + 1) * (2 * kAround + 1)];
    std::size_t count = 0;
    tiles_.each_near(tile, tile_row, [&](std::size_t index) {
      if (faces_[index].found) near[count++] = &faces_[index];
    });
    if (count == 0) continue;
    tiles_.each_block(fits.grid, tile, tile_row, [&](int column, int row) {
      const std::size_t i = fits.grid.index(column, row);
      if (fits.states[i] != FilteredDepth::State::fitted) return;
      const float rho = input.blocks.rho[row * input.blocks.stride + column];
      give({near, count}, rho, block_sigma(noise, rho), column, row, fits);
    });
  }
}

void FaceFits::refit(const simd::FitInput& input, const Blocks& filled, const NoiseModel& noise,
                     const KeptTiles& kept, BlockFits& fits) {
  faces_.resize(tiles_.set(fits.grid, input.table));
  constexpr std::size_t kAtATime = 4;  // rows of tiles that a thread takes at once (judgement)
  tiles_.for_rows(kAtATime, [&](int row) { find(input, filled, noise, kept, fits, row); });
  tiles_.for_rows(kAtATime, [&](int row) { share(input, noise, kept, row, fits); });
}

}  // namespace palpate::depth
