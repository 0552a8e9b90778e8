// Finds the surface of a splat scene: cells that light reaches, drawn together to a sheet.
#include "geometry/splat_shell.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <vector>

#include "geometry/parallel.hpp"
#include "geometry/signed_sets.hpp"
#include "geometry/splat_cells.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {
namespace {

using detail::SplatCell;
using detail::SplatGrid;

constexpr float kLit = 0.5F;            // transmittance that reaches a kept cell (measured)
constexpr float kLeastDepth = 0.15F;    // optical depth of a kept cell (measured)
constexpr float kHalfOpaque = 0.7F;     // the same with its neighbours along the normal (measured)
constexpr float kSameSheet = 0.9063F;   // cos 25 degrees, between normals that agree (measured)
constexpr float kSameSide = 0.7071F;    // cos 45 degrees, between normals that mix (measured)
constexpr std::size_t kNeighbors = 32;  // that a point is drawn towards, at most (measured)
constexpr float kFar = 4;               // edges, to the farthest of them (measured)
constexpr float kWidth = 2;             // edges, deviation of their weight (measured)
constexpr int kProjections = 3;  // after two, two layers of a thick shell may be left (measured)

using Step = std::array<int, 3>;

// One of each two opposite directions to the 26 neighbours; its first step is +1.
std::vector<Step> half_of_directions() {
  std::vector<Step> steps;
  for (int code = 14; code < 27; ++code) {
    steps.push_back({code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1});
  }
  return steps;
}

// A cell on a line of cells that runs in one direction.
struct OnLine {
  std::uint64_t line = 0;
  std::int64_t place = 0;
  std::uint32_t cell = 0;

  [[nodiscard]] bool operator<(const OnLine& other) const {
    return line != other.line ? line < other.line : place < other.place;
  }
};

std::vector<OnLine> lines_of(std::span<const SplatCell> cells, const Step& step) {
  const std::size_t axis = step[0] != 0 ? 0 : step[1] != 0 ? 1 : 2;  // along which places count
  std::vector<OnLine> lines(cells.size());
  detail::parallel_each(cells.size(), 4096, [&](std::size_t c) {
    const auto at = SplatGrid::place_of(cells[c].key);
    // A line's name is where it meets place 0; the upper two of its 66 bits never change.
    std::uint64_t line = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t meets = at[k] - step[k] * at[axis] + 2 * SplatGrid::kHalf;
      line = line << (SplatGrid::kBits + 2) | static_cast<std::uint64_t>(meets);
    }
    lines[c] = {line, at[axis], static_cast<std::uint32_t>(c)};
  });
  tbb::parallel_sort(lines.begin(), lines.end());
  return lines;
}

// The light that comes to each cell from all sides.
struct Light {
  std::vector<float> brightest;             // transmittance up to each cell, of the best direction
  std::vector<Eigen::Vector3f> directions;  // sum of directions that light comes from
};

template <class Lines>
void sweep(Lines first, Lines last, std::span<const SplatCell> cells, const Eigen::Vector3f& from,
           Light& light) {
  float left = 1;
  for (auto before = last; first != last; before = first++) {
    if (before == last || before->line != first->line) left = 1;
    light.brightest[first->cell] = std::max(light.brightest[first->cell], left);
    light.directions[first->cell] += left * from;
    left *= std::exp(-cells[first->cell].depth);
  }
}

Light light_of(std::span<const SplatCell> cells, const std::function<void(double)>& progress) {
  Light light{std::vector<float>(cells.size(), 0),
              std::vector<Eigen::Vector3f>(cells.size(), Eigen::Vector3f::Zero())};
  const std::vector<Step> steps = half_of_directions();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Step& step = steps[k];
    const std::vector<OnLine> lines = lines_of(cells, step);
    const Eigen::Vector3f along = Eigen::Vector3f(step[0], step[1], step[2]).normalized();
    sweep(lines.begin(), lines.end(), cells, -along, light);
    sweep(lines.rbegin(), lines.rend(), cells, along, light);
    progress(static_cast<double>(k + 1) / static_cast<double>(steps.size()));
  }
  return light;
}

// The optical depth of a cell and of its two neighbours along the normal that agree on it.
float sheet_depth(std::span<const SplatCell> cells, const SplatCell& cell) {
  if (!cell.sure) return cell.depth;
  const auto step = SplatGrid::step(static_cast<int>(std::lround(cell.normal.x())),
                                    static_cast<int>(std::lround(cell.normal.y())),
                                    static_cast<int>(std::lround(cell.normal.z())));
  float depth = cell.depth;
  for (const std::uint64_t key : {cell.key - step, cell.key + step}) {
    const auto there = std::ranges::lower_bound(cells, key, {}, &SplatCell::key);
    if (there == cells.end() || there->key != key || !there->sure) continue;
    if (std::abs(there->normal.dot(cell.normal)) >= kSameSheet) depth += there->depth;
  }
  return depth;
}

// Keeps the cells on the outside, whose normals it turns to the light.
std::vector<SplatCell> lit_cells(std::span<const SplatCell> cells, const Light& light) {
  std::vector<char> keeps(cells.size());
  detail::parallel_each(cells.size(), 1024, [&](std::size_t c) {
    keeps[c] = light.brightest[c] >= kLit && cells[c].depth >= kLeastDepth &&
               sheet_depth(cells, cells[c]) >= kHalfOpaque;
  });
  std::vector<SplatCell> kept;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (keeps[c] == 0) continue;
    kept.push_back(cells[c]);
    if (kept.back().normal.dot(light.directions[c]) < 0) kept.back().normal *= -1;
  }
  return kept;
}

// Removes small pieces. @return how many
std::size_t drop_small_pieces(std::vector<SplatCell>& cells) {
  detail::SignedSets pieces(cells.size());
  for (const Step& step : half_of_directions()) {
    const std::uint64_t ahead = SplatGrid::step(step[0], step[1], step[2]);
    for (std::size_t a = 0, b = 0; a < cells.size(); ++a) {
      while (b < cells.size() && cells[b].key < cells[a].key + ahead) ++b;
      if (b < cells.size() && cells[b].key == cells[a].key + ahead) {
        pieces.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), 1);
      }
    }
  }
  const auto root_of = [&](std::size_t c) {
    return pieces.find(static_cast<std::uint32_t>(c)).first;
  };
  std::vector<std::size_t> sizes(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) ++sizes[root_of(c)];
  std::size_t dropped = 0;
  std::size_t kept = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::size_t root = root_of(c);
    const bool small = sizes[root] < kSmallestPiece;
    dropped += small && root == c ? 1 : 0;
    if (!small) cells[kept++] = cells[c];
  }
  cells.resize(kept);
  return dropped;
}

// Moves a point along its normal to the mean of its neighbours of the same sheet.
SplatCell projected(const SplatCell& point, std::span<const SplatCell> points,
                    std::span<const CellGrid::Neighbor> neighbors, float edge) {
  float sum = 0;
  float height = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  for (const CellGrid::Neighbor& neighbor : neighbors) {
    const SplatCell& other = points[neighbor.index];
    const float square = neighbor.squared_distance / (edge * edge);
    const float agreement = other.normal.dot(point.normal);
    if (square > kFar * kFar || !(std::abs(agreement) >= kSameSide)) continue;
    const float weight = other.depth * std::exp(-square / (2 * kWidth * kWidth));
    sum += weight;
    height += weight * point.normal.dot(other.position - point.position);
    normal += std::copysign(weight, agreement) * other.normal;
  }
  SplatCell moved = point;
  if (!(sum > 0)) return moved;
  moved.position += height / sum * point.normal;
  moved.normal = normal.normalized();
  return moved;
}

// Makes one point of those that share a cell.
SplatCell merged(std::span<const SplatCell> points) {
  SplatCell mean;
  mean.key = points.front().key;
  float sure = 0;
  for (const SplatCell& each : points) {
    mean.depth += each.depth;
    mean.position += each.depth * (each.position - points.front().position);
    mean.color += each.depth * each.color;
    mean.normal += std::copysign(each.depth, each.normal.dot(points.front().normal)) * each.normal;
    sure += each.sure ? each.depth : 0;
  }
  mean.position = points.front().position + mean.position / mean.depth;
  mean.color /= mean.depth;
  mean.normal.normalize();
  mean.sure = 2 * sure >= mean.depth;
  return mean;
}

std::vector<SplatCell> one_a_cell(std::vector<SplatCell> points, const SplatGrid& grid) {
  for (SplatCell& each : points) each.key = grid.key_of(each.position).value_or(each.key);
  std::ranges::stable_sort(points, {}, &SplatCell::key);
  std::vector<SplatCell> merged_points;
  for (std::size_t i = 0, end = 0; i < points.size(); i = end) {
    while (end < points.size() && points[end].key == points[i].key) ++end;
    merged_points.push_back(merged(std::span(points).subspan(i, end - i)));
  }
  return merged_points;
}

std::vector<SplatCell> project(std::span<const SplatCell> cells, const SplatGrid& grid) {
  std::vector<Eigen::Vector3f> positions(cells.size());
  std::ranges::transform(cells, positions.begin(), &SplatCell::position);
  const CellGrid index(positions);
  std::vector<SplatCell> sorted(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) sorted[i] = cells[index.order()[i]];
  std::vector<SplatCell> moved(cells.size());
  detail::parallel_each_with<std::vector<CellGrid::Neighbor>>(
      cells.size(), 256, [&](std::size_t i, std::vector<CellGrid::Neighbor>& neighbors) {
        index.nearest(sorted[i].position, kNeighbors, neighbors);
        moved[i] = projected(sorted[i], sorted, neighbors, grid.edge);
      });
  return one_a_cell(std::move(moved), grid);
}

void take_cells(std::span<const SplatCell> cells, SplatShell& shell) {
  std::size_t unsure = 0;
  for (const SplatCell& cell : cells) {
    shell.cloud.positions.push_back(cell.position);
    shell.cloud.normals.push_back(cell.sure ? cell.normal : Eigen::Vector3f::Zero());
    const auto byte = [&](int k) { return static_cast<std::uint8_t>(std::lround(cell.color[k])); };
    shell.cloud.colors.push_back({byte(0), byte(1), byte(2)});
    unsure += cell.sure ? 0 : 1;
  }
  shell.unsure = static_cast<double>(unsure) / static_cast<double>(cells.size());
}

}  // namespace

SplatShell shell_of(std::span<const Splat> splats, const std::function<void(double)>& progress) {
  const auto tell = [&](double done) {
    if (progress) progress(done);
  };
  SplatShell shell;
  shell.visible = static_cast<std::size_t>(std::ranges::count_if(
      splats, [](const Splat& splat) { return splat.opacity >= kLeastOpacity; }));
  SplatGrid grid = detail::grid_for(splats);
  if (!(grid.edge > 0)) return shell;
  tell(0.05);
  std::vector<SplatCell> cells = detail::cells_of(splats, grid);
  shell.spacing = static_cast<double>(grid.edge);
  tell(0.3);
  const Light light = light_of(cells, [&](double done) { tell(0.3 + 0.3 * done); });
  cells = lit_cells(cells, light);
  shell.pieces = drop_small_pieces(cells);
  for (int k = 0; k < kProjections; ++k) {
    tell(0.6 + 0.4 * k / kProjections);
    cells = project(cells, grid);
  }
  if (!cells.empty()) take_cells(cells, shell);
  tell(1);
  return shell;
}

}  // namespace palpate
