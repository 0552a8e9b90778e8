#include "depth/meeting_planes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/parallel.hpp"

namespace palpate::depth {
namespace {

constexpr std::size_t kRowsAtATime = 8;
constexpr int kAround = 2;             // blocks to each side that are to be explained
constexpr float kSure = 9;             // three deviations
constexpr float kOther = 16;           // four: what is farther away is of another surface
constexpr int kReaches[] = {2, 4, 6};  // blocks; the smallest of all largest windows is 6
constexpr std::pair<int, int> kAxes[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};

// The plane of the block at (u, v) from the one that is looked at, per unit of the ray.
struct Plane {
  float x, y;  // from that one
  float rho, slope_x, slope_y;
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
  return gap * gap > kSure * (of.variance + to.variance_at(of.x, of.y)) ? gap : 0;
}

// Two planes as they are seen where they meet.
struct Pair {
  Plane a, b;
  bool concave;

  [[nodiscard]] const Plane& seen(float x, float y) const {
    return (a.at(x, y) > b.at(x, y)) == concave ? a : b;
  }
};

std::optional<Pair> meeting(const Plane& a, const Plane& b) {
  const float a_ahead = ahead(a, b);
  const float b_ahead = ahead(b, a);
  if (!(a_ahead * b_ahead > 0)) return {};
  return Pair{a, b, a_ahead > 0};
}

// One block and what is around it.
struct Place {
  const Blocks& blocks;
  const BlockFits& fits;
  int column, row;
  float step_x, step_y;
  float variance;  // of one block

  [[nodiscard]] std::optional<Plane> plane(int u, int v) const {
    const int c = column + u;
    const int r = row + v;
    if (c < 0 || r < 0 || c >= fits.grid.columns || r >= fits.grid.rows) return {};
    const std::size_t i = fits.grid.index(c, r);
    const bool fitted = blocks.rho[blocks.at(c, r)] > 0 && fits.states[i] == BlockState::fitted;
    if (!fitted || !fits.flat[i]) return {};
    return Plane{static_cast<float>(u) * step_x,
                 static_cast<float>(v) * step_y,
                 fits.rho[i],
                 fits.slope_x[i],
                 fits.slope_y[i],
                 fits.variance[i],
                 fits.slope_variance[i]};
  }

  // Squares of what `surface` leaves, another surface's capped.
  template <class Surface>
  [[nodiscard]] float misfit(const Surface& surface) const {
    float sum = 0;
    for (int v = -kAround; v <= kAround; ++v) {
      const float* rho = &blocks.rho[blocks.at(column, row + v)];
      for (int u = -kAround; u <= kAround; ++u) {
        if (!(rho[u] > 0)) continue;
        const float off =
            rho[u] - surface(static_cast<float>(u) * step_x, static_cast<float>(v) * step_y);
        sum += std::min(off * off, kOther * variance);
      }
    }
    return sum;
  }

  // The plane that is seen here of the pair around that leaves less than `most`, and the least.
  [[nodiscard]] std::optional<Plane> search(float most) const {
    std::optional<Plane> found;
    for (const int reach : kReaches) {
      for (const auto& [u, v] : kAxes) {
        const std::optional<Plane> a = plane(reach * u, reach * v);
        const std::optional<Plane> b = a ? plane(-reach * u, -reach * v) : a;
        const std::optional<Pair> pair = b ? meeting(*a, *b) : std::nullopt;
        if (!pair) continue;
        const float left = misfit([&](float x, float y) { return pair->seen(x, y).at(x, y); });
        if (!(left < most)) continue;
        most = left;
        found = pair->seen(0, 0);
      }
    }
    return found;
  }
};

}  // namespace

void MeetingPlanes::assign(const Blocks& blocks, const NoiseModel& noise, int first_row,
                           const std::vector<std::int32_t>& columns,
                           const std::vector<std::size_t>& row_begin, BlockFits& fits) {
  const std::size_t rows = row_begin.size() - 1;
  if (changes_.size() < rows) changes_.resize(rows);
  constexpr double kBlocks = (2 * kAround + 1) * (2 * kAround + 1);
  const auto together = static_cast<float>(std::min(shared_error(noise.correlation), kBlocks));
  const auto step_x = static_cast<float>(fits.grid.step_x);
  const auto step_y = static_cast<float>(fits.grid.step_y);
  detail::parallel_ranges(rows, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      changes_[r].clear();
      const int row = first_row + static_cast<int>(r);
      for (std::size_t k = row_begin[r]; k < row_begin[r + 1]; ++k) {
        const std::size_t i = fits.grid.index(columns[k], row);
        if (!fits.at_edge[i]) continue;
        const float rho = blocks.rho[blocks.at(columns[k], row)];
        const float sigma = block_sigma(noise, rho);
        const Place place{blocks, fits, columns[k], row, step_x, step_y, sigma * sigma};
        const Plane own{0,
                        0,
                        fits.rho[i],
                        fits.slope_x[i],
                        fits.slope_y[i],
                        fits.variance[i],
                        fits.slope_variance[i]};
        const float left = place.misfit([&](float x, float y) { return own.at(x, y); });
        const std::optional<Plane> seen = place.search(left - kSure * together * sigma * sigma);
        if (!seen) continue;
        const float off = seen->at(0, 0) - rho;
        if (off * off > kOther * sigma * sigma) continue;
        changes_[r].push_back({i, seen->at(0, 0), seen->variance_at(0, 0), seen->slope_x,
                               seen->slope_y, seen->slope_variance});
      }
    }
  });
  for (std::size_t r = 0; r < rows; ++r) {
    for (const Change& to : changes_[r]) {
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
