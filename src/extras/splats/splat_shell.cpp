// Finds the surface of a splat scene: cells that light reaches.
#include "extras/splats/splat_shell.hpp"

#include <algorithm>
#include <vector>

#include "extras/splats/splat_cells.hpp"
#include "extras/splats/splat_choice.hpp"
#include "extras/splats/splat_sheet.hpp"
#include "geometry/parallel.hpp"
#include "geometry/signed_sets.hpp"

namespace palpate {
namespace {

using detail::Record;
using detail::SplatCell;
using detail::SplatGrid;

constexpr float kLit = 0.5F;           // transmittance that reaches a kept cell (measured)
constexpr float kLeastDepth = 0.15F;   // optical depth of a kept cell (measured)
constexpr float kHalfOpaque = 0.7F;    // the same with its neighbours along the normal (measured)
constexpr float kSameSheet = 0.9063F;  // cos 25 degrees, between normals that agree (measured)

constexpr std::int64_t kMostIndices = std::int64_t{1} << SplatGrid::kBits;  // an axis (derived)

using Step = std::array<int, 3>;

// One of each two opposite directions to the 26 neighbours; its first step is +1.
std::vector<Step> half_of_directions() {
  std::vector<Step> steps;
  for (int code = 14; code < 27; ++code) {
    steps.push_back({code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1});
  }
  return steps;
}

// The cells, line by line in one direction, and along each line in the order of their keys.
void sort_lines(std::span<const SplatCell> cells, const Step& step, std::vector<Record>& lines,
                std::vector<Record>& scratch) {
  const std::size_t axis = step[0] != 0 ? 0 : step[1] != 0 ? 1 : 2;  // along which it runs
  detail::parallel_each(cells.size(), 4096, [&](std::size_t c) {
    const auto at = SplatGrid::indices_of(cells[c].key);
    std::uint64_t line = 0;  // where it meets index 0 of that axis
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == axis) continue;
      const std::int64_t meets = at[k] - step[k] * at[axis] + (step[k] > 0 ? kMostIndices : 0);
      line = line << (SplatGrid::kBits + 1) | static_cast<std::uint64_t>(meets);
    }
    lines[c] = line << detail::kIndexBits | c;
  });
  detail::sort_records(lines, scratch, detail::kKeyBits);
}

// The light that comes to a cell from all sides.
struct Light {
  float passes = 0;     // share that the cell lets through
  float brightest = 0;  // transmittance up to the cell, of the best direction
  float before = 0;     // sums of what comes from either side of its normal
  float behind = 0;
};

template <class Lines>
void sweep(Lines first, Lines last, std::span<const SplatCell> cells, const Eigen::Vector3f& from,
           std::vector<Light>& light) {
  float left = 1;
  for (auto before = first; first != last; before = first++) {
    if ((*before ^ *first) >> detail::kIndexBits != 0) left = 1;
    const std::size_t cell = *first & detail::kIndexMask;
    Light& there = light[cell];
    there.brightest = std::max(there.brightest, left);
    const float cosine = cells[cell].normal.dot(from);
    (cosine > 0 ? there.before : there.behind) += left * std::abs(cosine);
    left *= there.passes;
  }
}

std::vector<Light> light_of(std::span<const SplatCell> cells,
                            const std::function<void(double)>& progress) {
  std::vector<Light> light(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) light[c].passes = std::exp(-cells[c].depth);
  const std::vector<Step> steps = half_of_directions();
  std::vector<Record> lines(cells.size());
  std::vector<Record> scratch(cells.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Step& step = steps[k];
    sort_lines(cells, step, lines, scratch);
    const Eigen::Vector3f along = Eigen::Vector3f(step[0], step[1], step[2]).normalized();
    sweep(lines.begin(), lines.end(), cells, -along, light);
    sweep(lines.rbegin(), lines.rend(), cells, along, light);
    progress(static_cast<double>(k + 1) / static_cast<double>(steps.size()));
  }
  return light;
}

// The optical depth of a cell and of its two neighbours along the normal that agree on it.
float sheet_depth(std::span<const SplatCell> cells, const SplatCell& cell) {
  if (!cell.confident) return cell.depth;
  const auto step = SplatGrid::step(static_cast<int>(std::lround(cell.normal.x())),
                                    static_cast<int>(std::lround(cell.normal.y())),
                                    static_cast<int>(std::lround(cell.normal.z())));
  float depth = cell.depth;
  for (const std::uint64_t key : {cell.key - step, cell.key + step}) {
    const auto there = std::ranges::lower_bound(cells, key, {}, &SplatCell::key);
    if (there == cells.end() || there->key != key || !there->confident) continue;
    if (std::abs(there->normal.dot(cell.normal)) >= kSameSheet) depth += there->depth;
  }
  return depth;
}

// Keeps the cells on the outside, whose normals it turns to the light.
std::vector<SplatCell> lit_cells(std::span<const SplatCell> cells, std::span<const Light> light) {
  std::vector<char> keeps(cells.size());
  detail::parallel_each(cells.size(), 1024, [&](std::size_t c) {
    keeps[c] = light[c].brightest >= kLit && cells[c].depth >= kLeastDepth &&
               sheet_depth(cells, cells[c]) >= kHalfOpaque;
  });
  std::vector<SplatCell> kept;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (keeps[c] == 0) continue;
    kept.push_back(cells[c]);
    if (light[c].before < light[c].behind) kept.back().normal *= -1;
    const float both = light[c].before + light[c].behind;
    if (both > 0) kept.back().behind = std::min(light[c].before, light[c].behind) / both;
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

void take_cells(std::span<const SplatCell> cells, SplatShell& shell) {
  std::size_t uncertain = 0;
  for (const SplatCell& cell : cells) {
    shell.cloud.positions.push_back(cell.position);
    shell.cloud.normals.push_back(cell.confident ? cell.normal : Eigen::Vector3f::Zero());
    const auto byte = [&](int k) { return static_cast<std::uint8_t>(std::lround(cell.color[k])); };
    shell.cloud.colors.push_back({byte(0), byte(1), byte(2)});
    uncertain += cell.confident ? 0 : 1;
  }
  shell.without_normal = static_cast<double>(uncertain) / static_cast<double>(cells.size());
}

}  // namespace

SplatShell shell_of(std::span<const Splat> splats, const std::function<void(double)>& progress) {
  const auto report = [&](double done) {
    if (progress) progress(done);
  };
  SplatShell shell;
  shell.visible = static_cast<std::size_t>(std::ranges::count_if(
      splats, [](const Splat& splat) { return splat.opacity >= kLeastOpacity; }));
  const detail::SplatChoice choice = detail::choose_splats(splats);
  const SplatGrid& grid = choice.grid;
  shell.far = choice.far;
  shell.huge = choice.huge;
  shell.samples = choice.samples;
  shell.spacing = static_cast<double>(grid.edge);
  if (!(grid.edge > 0)) return shell;
  report(0.05);
  const std::vector<detail::SplatShare> shares = detail::shares_of(choice.splats, grid);
  std::vector<SplatCell> cells = detail::cells_of(shares, choice.splats, grid);
  report(0.3);
  cells = lit_cells(cells, light_of(cells, [&](double done) { report(0.3 + 0.3 * done); }));
  shell.pieces = drop_small_pieces(cells);
  cells = detail::drawn_together(std::move(cells), shares, choice.splats, grid,
                                 [&](double done) { report(0.6 + 0.4 * done); });
  if (!cells.empty()) take_cells(cells, shell);
  report(1);
  return shell;
}

}  // namespace palpate
