#include "depth/meeting_planes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/parallel.hpp"

namespace palpate::depth {
namespace {

constexpr std::size_t kRowsPerPiece = 8;
constexpr int kHalfWidth = 2;  // blocks to each side that are to be explained
constexpr int kWidth = 2 * kHalfWidth + 1;
constexpr int kBlocks = kWidth * kWidth;
constexpr float kLeftByNoise = kBlocks + 21;  // 3 sqrt(2 n): what noise leaves, three deviations up
constexpr float kCertain = 9;                 // three deviations
constexpr float kElsewhere = 16;              // four: what is farther away is of another surface
constexpr int kReaches[] = {2, 4, 6};         // blocks; the smallest of all largest windows is 6
constexpr std::pair<int, int> kAxes[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};

// A block's plane, as seen from another block: in units of the ray, with that one at (0, 0).
struct Plane {
  float x, y;  // of the block
  float rho;   // there
  float slope_x, slope_y;
  float variance, slope_variance;

  [[nodiscard]] float at(float to_x, float to_y) const {
    return rho + slope_x * (to_x - x) + slope_y * (to_y - y);
  }
  [[nodiscard]] float variance_at(float to_x, float to_y) const {
    const float dx = to_x - x;
    const float dy = to_y - y;
    return variance + slope_variance * (dx * dx + dy * dy);
  }
};

// By how much `of`, at its own block, is nearer than `to` continued there; 0: noise may be it.
float ahead(const Plane& of, const Plane& to) {
  const float gap = of.rho - to.at(of.x, of.y);
  return gap * gap > kCertain * (of.variance + to.variance_at(of.x, of.y)) ? gap : 0;
}

// Two planes as they are seen where they meet.
struct Pair {
  Plane a, b;
  bool concave;

  [[nodiscard]] const Plane& here() const { return (a.at(0, 0) > b.at(0, 0)) == concave ? a : b; }
};

std::optional<Pair> meeting(const Plane& a, const Plane& b) {
  const float a_ahead = ahead(a, b);
  const float b_ahead = ahead(b, a);
  if (!(a_ahead * b_ahead > 0)) return {};
  return Pair{a, b, a_ahead > 0};
}

// What was measured around a block, in lanes for the compiler to take side by side.
struct Around {
  static constexpr int kLanes = 8;
  static constexpr int kPlaces = 32;
  float x[kPlaces] = {}, y[kPlaces] = {};
  float rho[kPlaces] = {}, counts[kPlaces] = {};  // 0: nothing was

  Around(float step_x, float step_y) {
    for (int k = 0; k < kBlocks; ++k) {
      x[k] = static_cast<float>(k % kWidth - kHalfWidth) * step_x;
      y[k] = static_cast<float>(k / kWidth - kHalfWidth) * step_y;
    }
  }

  void look(const Blocks& blocks, int column, int row) {
    const float* from = &blocks.rho[blocks.at(column - kHalfWidth, row - kHalfWidth)];
    for (int k = 0; k < kBlocks; k += kWidth, from += blocks.stride) {
      for (int u = 0; u < kWidth; ++u) {
        rho[k + u] = from[u];
        counts[k + u] = from[u] > 0 ? 1.0F : 0.0F;
      }
    }
  }

  // Squares of what the pair leaves, those of other surfaces capped.
  [[nodiscard]] float misfit(const Pair& pair, float variance) const {
    const float sign = pair.concave ? 1.0F : -1.0F;
    const float most = kElsewhere * variance;
    float sums[kLanes] = {};
    for (int k = 0; k < kPlaces; k += kLanes) {
      for (int l = 0; l < kLanes; ++l) {
        const float a = sign * pair.a.at(x[k + l], y[k + l]);
        const float b = sign * pair.b.at(x[k + l], y[k + l]);
        const float off = rho[k + l] - sign * (a > b ? a : b);
        const float square = off * off;
        sums[l] += counts[k + l] * (square < most ? square : most);
      }
    }
    float sum = 0;
    for (const float part : sums) sum += part;
    return sum;
  }
};

// One block on the search for the planes that meet near it.
struct Search {
  const Blocks& blocks;
  const BlockFits& fits;
  int column, row;

  // Of the block (u, v) away; nothing if that is not on a plane.
  [[nodiscard]] std::optional<Plane> plane(int u, int v) const {
    const BlockGrid& grid = fits.grid;
    const int c = column + u;
    const int r = row + v;
    if (c < 0 || r < 0 || c >= grid.columns || r >= grid.rows) return {};
    const std::size_t i = grid.index(c, r);
    const bool fitted = blocks.rho[blocks.at(c, r)] > 0 && fits.states[i] == BlockState::fitted;
    if (!fitted || !fits.flat[i]) return {};
    return own_plane(i, u, v);
  }

  [[nodiscard]] Plane own_plane(std::size_t i, int u, int v) const {
    return {static_cast<float>(u * fits.grid.step_x),
            static_cast<float>(v * fits.grid.step_y),
            fits.rho[i],
            fits.slope_x[i],
            fits.slope_y[i],
            fits.variance[i],
            fits.slope_variance[i]};
  }

  // The plane that is seen here of the pair that leaves least of what is around: less than `most`.
  [[nodiscard]] std::optional<Plane> run(const Around& around, float variance, float most) const {
    std::optional<Plane> found;
    for (const int reach : kReaches) {
      for (const auto& [u, v] : kAxes) {
        const std::optional<Plane> a = plane(reach * u, reach * v);
        const std::optional<Plane> b = a ? plane(-reach * u, -reach * v) : a;
        const std::optional<Pair> pair = b ? meeting(*a, *b) : std::nullopt;
        const float left = pair ? around.misfit(*pair, variance) : most;
        if (!(left < most)) continue;
        most = left;
        found = pair->here();
      }
    }
    return found;
  }
};

}  // namespace

std::size_t MeetingPlanes::search_row(const Blocks& blocks, const NoiseModel& noise, int row,
                                      std::span<const std::int32_t> columns, const BlockFits& fits,
                                      Change* changes) {
  const auto together = static_cast<float>(shared_error(noise.correlation, 2, kBlocks));
  Around around(static_cast<float>(fits.grid.step_x), static_cast<float>(fits.grid.step_y));
  std::size_t count = 0;
  for (const std::int32_t column : columns) {
    const std::size_t i = fits.grid.index(column, row);
    if (!fits.at_edge[i]) continue;
    const float rho = blocks.rho[blocks.at(column, row)];
    const float sigma = block_sigma(noise, rho);
    const float variance = sigma * sigma;
    around.look(blocks, column, row);
    const Search search{blocks, fits, column, row};
    const Plane own = search.own_plane(i, 0, 0);
    const float left = around.misfit({own, own, true}, variance);
    if (!(left > kBlocks * variance)) continue;
    const float most = std::min(left - kCertain * together * variance, kLeftByNoise * variance);
    const std::optional<Plane> seen = search.run(around, variance, most);
    const float off = seen ? seen->at(0, 0) - rho : 0;
    if (!seen || off * off > kElsewhere * variance) continue;
    changes[count++] = {i,
                        seen->at(0, 0),
                        seen->variance_at(0, 0),
                        seen->slope_x,
                        seen->slope_y,
                        seen->slope_variance};
  }
  return count;
}

void MeetingPlanes::assign(const Blocks& blocks, const NoiseModel& noise, int first_row,
                           const std::vector<std::int32_t>& columns,
                           const std::vector<std::size_t>& row_begin, BlockFits& fits) {
  const std::size_t rows = row_begin.size() - 1;
  changes_.reserve(fits.size());
  changes_.resize(columns.size());
  counts_.resize(static_cast<std::size_t>(fits.grid.rows));
  detail::parallel_ranges(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const auto of_row = std::span(columns).subspan(row_begin[r], row_begin[r + 1] - row_begin[r]);
      counts_[r] = search_row(blocks, noise, first_row + static_cast<int>(r), of_row, fits,
                              changes_.data() + row_begin[r]);
    }
  });
  for (std::size_t r = 0; r < rows; ++r) {
    for (const Change& to : std::span(changes_).subspan(row_begin[r], counts_[r])) {
      fits.rho[to.block] = to.rho;
      fits.variance[to.block] = to.variance;
      fits.slope_x[to.block] = to.slope_x;
      fits.slope_y[to.block] = to.slope_y;
      fits.slope_variance[to.block] = to.slope_variance;
      fits.confidences[to.block] = 1;
    }
  }
}

}  // namespace palpate::depth
