// Finds points that lie on lines, nearer to each other than the lines are, and the gaps between.

#include "prepare/lines.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/places.hpp"

namespace palpate {

namespace {

// What separates lines from surfaces; judgement but for kLines (docs/preparation.md, Spacing).
constexpr float kOpposite = -0.5f;      // cosine between two that lie on opposite sides
constexpr int kLineWidenings = 7;       // reaches, each twice the last: lines up to 256 points away
constexpr std::size_t kEnough = 2048;   // points in reach: not sparse any more
constexpr std::size_t kOnLine = 5;      // nearest, the point itself among them, that show a line
constexpr int kLineScales = 4;          // 4, 8, 16, 32 others: noise hides a line among few
constexpr float kAside = 0.7f;          // cosine: 45 degrees to a line and more are beside it
constexpr std::size_t kAlongLine = 16;  // nearest, over which the gap to the next line is averaged
constexpr float kSameDirection = 0.99f;  // cosine: of two points so alike the nearer one counts
constexpr float kThin = 0.2f;            // deviation of a line across, against along
// Share of the sampled points on lines: a cloud of lines. Surfaces have 0.05 and less (measured:
// 480 drawn clouds, 30 real ones), vertices of marching cubes 0.12, scans of rooms and roads 0.2
// and more.
constexpr float kLines = 0.15f;

/// The line that a point and the nearest positions are on.
struct Line {
  Eigen::Vector3f along = Eigen::Vector3f::UnitX();
  float spacing = 0;  // m, to the farthest of the nearest
  float step = 0;     // m, from one of them to the next
  float off = 1;      // deviation across the line, against that along it
};

/// The further of the nearest two, aside of the line that a point is on, that lie on opposite
/// sides of it; 0: there are none among those that are near, m.
float gap_among(const CellGrid& grid, std::uint32_t i, const Line& line,
                std::span<const std::uint32_t> near) {
  std::vector<std::pair<float, Eigen::Vector3f>> aside;  // by distance; directions
  for (const std::uint32_t j : near) {
    const Eigen::Vector3f offset = grid.points()[j] - grid.points()[i];
    const float length = offset.norm();
    if (length > 0 && std::abs(offset.dot(line.along)) <= kAside * length) {
      aside.emplace_back(length, offset / length);
    }
  }
  std::ranges::sort(aside, {}, [](const auto& a) { return a.first; });
  std::vector<Eigen::Vector3f> directions;  // a dense line beside this one has many alike
  for (const auto& [length, direction] : aside) {
    bool alike = false;
    for (const Eigen::Vector3f& other : directions) {
      const float cosine = direction.dot(other);
      if (cosine < kOpposite) return length;
      alike = alike || cosine > kSameDirection;
    }
    if (!alike) directions.push_back(direction);
  }
  return 0;
}

/// The side of the square grid whose holes are as wide as those between lines, m: their half
/// diagonals are equal. `along`: from a point to the next one on its line, m.
float side_of_square(float gap, float along) {
  return std::sqrt((gap * gap + along * along) / 2);
}

/// Calls find(reach) once `near` holds the points within `reach` of a point, then within twice as
/// much each time that it finds 0, kLineWidenings times in all. @return what it found
template <class Find>
float search_wider(const CellGrid& grid, std::uint32_t i, float reach,
                   std::vector<std::uint32_t>& near, const Find& find) {
  for (int k = 0; k < kLineWidenings; ++k, reach *= 2) {
    near.clear();
    grid.within(grid.points()[i], reach, near, kEnough + 1);
    if (near.size() > kEnough) break;
    if (const float found = find(reach); found > 0) return found;
  }
  return 0;
}

/// The line that a point and those of the `nearest` are on, itself among them, the farthest last.
Line line_among(const CellGrid& grid, std::uint32_t i,
                std::span<const CellGrid::Neighbor> nearest) {
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  Line line;
  for (const CellGrid::Neighbor& found : nearest) {
    const Eigen::Vector3f offset = grid.points()[found.index] - grid.points()[i];
    squares += offset * offset.transpose();
    line.spacing = std::sqrt(found.squared_distance);
  }
  line.step = 2 * line.spacing / static_cast<float>(std::max<std::size_t>(nearest.size(), 2) - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(squares);
  line.along = solver.eigenvectors().col(2);
  const Eigen::Vector3f spread = solver.eigenvalues().cwiseMax(0);
  line.off = spread[2] > 0 ? std::sqrt(spread[1] / spread[2]) : 1;
  return line;
}

/// The line at the smallest scale at which there is one: of the point and the four positions
/// nearest to it, or of more of its nearest. `nearest`: memory.
Line noisy_line_at(const CellGrid& grid, std::uint32_t i,
                   std::vector<CellGrid::Neighbor>& nearest) {
  nearest_distinct(grid, i, kOnLine, nearest);
  Line line = line_among(grid, i, nearest);
  if (line.off < kThin) return line;
  const std::size_t most = (kOnLine - 1) << (kLineScales - 1);
  grid.nearest(grid.points()[i], most + 1, nearest);
  for (std::size_t others = 2 * (kOnLine - 1); others <= most && line.off >= kThin; others *= 2) {
    const std::size_t count = std::min(others + 1, nearest.size());
    line = line_among(grid, i, std::span<const CellGrid::Neighbor>(nearest).first(count));
  }
  return line;
}

/// The gap that a point lies in, m: the further of the nearest two beside its line, on opposite
/// sides of it. Looks within `reach` (m), and within twice as much each time that it finds none, up
/// to kLineWidenings times; 0: there is none. `near`: memory.
float gap_across(const CellGrid& grid, std::uint32_t i, const Line& line, float reach,
                 std::vector<std::uint32_t>& near) {
  return search_wider(grid, i, reach, near, [&](float) { return gap_among(grid, i, line, near); });
}

/// About 500 points, spread over the cloud. None of a cloud of fewer than 100, which
/// decides nothing.
std::vector<std::uint32_t> samples_of(const CellGrid& grid) {
  constexpr std::size_t kSamples = 500;  // points, about: a share of 0.05 errs by 0.01 (derived)
  constexpr std::size_t kFewest = 100;   // points of a cloud; judgement
  std::vector<std::uint32_t> samples;
  if (grid.size() < kFewest) return samples;
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kSamples);
  for (std::size_t i = step / 2; i < grid.size(); i += step) {
    samples.push_back(static_cast<std::uint32_t>(i));
  }
  return samples;
}

}  // namespace

bool lies_in_lines(const CellGrid& grid) {
  const std::vector<std::uint32_t> samples = samples_of(grid);
  const auto enough =
      static_cast<std::size_t>(std::ceil(kLines * static_cast<float>(samples.size())));
  std::vector<CellGrid::Neighbor> nearest;
  std::size_t lines = 0;
  for (std::size_t k = 0; k < samples.size() && lines + samples.size() - k >= enough; ++k) {
    if (noisy_line_at(grid, samples[k], nearest).off < kThin) ++lines;
    if (lines >= enough) return true;
  }
  return false;
}

namespace {

/// The spacing of the nearest point beside a line whose own gap is as wide as its distance, m; 0:
/// there is none. The square of a gap is at most 2 s^2 (side_of_square).
float spacing_beside(const CellGrid& grid, std::uint32_t i, const Line& line,
                     std::span<const float> spacings, std::vector<std::uint32_t>& near) {
  return search_wider(grid, i, 2 * line.spacing, near, [&](float nearest) {
    float spacing = 0;
    for (const std::uint32_t j : near) {
      const Eigen::Vector3f offset = grid.points()[j] - grid.points()[i];
      const float length = offset.norm();
      if (length >= nearest || offset.squaredNorm() >= 2 * spacings[j] * spacings[j]) continue;
      if (std::abs(offset.dot(line.along)) > kAside * length) continue;
      nearest = length;
      spacing = spacings[j];
    }
    return spacing;
  });
}

/// The line that each point is on.
std::vector<Line> lines_of(const CellGrid& grid) {
  std::vector<Line> lines(grid.size());
  detail::parallel_each_with<std::vector<CellGrid::Neighbor>>(
      lines.size(), 64, [&](std::size_t i, auto& found) {
        lines[i] = noisy_line_at(grid, static_cast<std::uint32_t>(i), found);
      });
  return lines;
}

/// The side of the square grid whose holes are as wide as those between lines, m, at each point of
/// a line with others on both sides; 0 elsewhere.
std::vector<float> sides_of_squares(const CellGrid& grid, const std::vector<Line>& lines) {
  std::vector<float> sides(grid.size());
  detail::parallel_each_with<std::vector<std::uint32_t>>(
      sides.size(), 64, [&](std::size_t i, auto& near) {
        const Line& line = lines[i];
        if (line.off >= kThin) return;
        const float gap =
            gap_across(grid, static_cast<std::uint32_t>(i), line, 2 * line.spacing, near);
        if (gap > 0) sides[i] = side_of_square(gap, line.step);
      });
  return sides;
}

/// The median of the sides at the nearest points along a line; 0: none has one.
std::vector<float> averaged_along(const CellGrid& grid, const std::vector<float>& sides) {
  std::vector<float> averaged(sides.size());
  detail::parallel_ranges(sides.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<CellGrid::Neighbor> found;
    std::vector<float> around;
    for (std::size_t i = begin; i < end; ++i) {
      grid.nearest(grid.points()[i], kAlongLine, found);
      around.clear();
      for (const CellGrid::Neighbor& other : found) {
        if (sides[other.index] > 0) around.push_back(sides[other.index]);
      }
      averaged[i] = static_cast<float>(median(around));
    }
  });
  return averaged;
}

}  // namespace

std::vector<float> spacings_of_lines(const CellGrid& grid) {
  const std::vector<Line> lines = lines_of(grid);
  const std::vector<float> sides = averaged_along(grid, sides_of_squares(grid, lines));
  std::vector<float> spacings = sides;
  detail::parallel_each_with<std::vector<std::uint32_t>>(
      spacings.size(), 64, [&](std::size_t i, auto& near) {
        if (sides[i] > 0 || lines[i].off >= kThin) return;
        spacings[i] = spacing_beside(grid, static_cast<std::uint32_t>(i), lines[i], sides, near);
      });
  return spacings;
}

void widen_to_lines(const std::vector<float>& of_lines, std::vector<float>& spacings) {
  for (std::size_t i = 0; i < of_lines.size(); ++i)
    spacings[i] = std::max(spacings[i], of_lines[i]);
}

}  // namespace palpate
