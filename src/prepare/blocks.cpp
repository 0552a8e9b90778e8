// Cuts a cloud into blocks, prepares each with what lies around it and joins them.

#include "prepare/blocks.hpp"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "geometry/cell_builder.hpp"
#include "geometry/parallel.hpp"
#include "prepare/assemble.hpp"
#include "prepare/at_once.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/stopwatch.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Points that two cores prepare in some 15 s, which people may wait for (judgement). By blocks,
// parts are not felt that are sampled more than some 12 times as sparsely as most
// (docs/preparation.md).
constexpr std::size_t kMostAtOnce = std::size_t{1} << 22;

// R: edge of a block. On a surface it has 60 000 to 140 000 points, half a second's work of a core
// at most, and the halo adds an eighth; half the edge would add a quarter.
constexpr double kBlockEdge = 96;  // judgement

// R: the halo of a block as dense as the typical place. Measured: of 2, 3 and 5 all leave blocks
// alike (docs/preparation.md).
constexpr double kHalo = 3;
// Times that where points are sparser, at most: few strays are not worth all that is around them.
constexpr double kSparsest = 4;  // judgement

constexpr double kMostPlaces =
    1 << 20;                       // of blocks along an axis either way; derived: 21 bits each
constexpr int kMostHalvings = 11;  // derived: levels of a CellGrid's curve

/// The elements of a column at `kept`; empty of an empty one.
template <class T>
std::vector<T> some_of(const std::vector<T>& column, std::span<const std::uint32_t> kept) {
  std::vector<T> some;
  if (column.empty()) return some;
  some.reserve(kept.size());
  for (const std::uint32_t i : kept) some.push_back(column[i]);
  return some;
}

/// Calls visit(column) for each that has an element for each point, of several surfaces alike.
template <class Visit, class... Points>
void each_column(const Visit& visit, Points&... points) {
  visit(points.normals...);
  visit(points.density_weights...);
  visit(points.radii...);
  visit(points.confidences...);
  visit(points.colors...);
  visit(points.presences...);
  visit(points.end_presences...);
  visit(points.sheets.sheet...);
  visit(points.sheets.residual...);
  visit(points.sheets.above...);
  visit(points.sheets.below...);
}

/// Gives the members of `numbers`, but kNone, new numbers from 0 on in the order in which they
/// come. Returns the old ones.
std::vector<std::uint32_t> renumber(std::vector<std::uint32_t>& numbers) {
  std::unordered_map<std::uint32_t, std::uint32_t> fresh;
  std::vector<std::uint32_t> old;
  for (std::uint32_t& number : numbers) {
    if (number == SurfacePoints::Sheets::kNone) continue;
    const auto [known, is_new] = fresh.try_emplace(number, static_cast<std::uint32_t>(old.size()));
    if (is_new) old.push_back(number);
    number = known->second;
  }
  return old;
}

/// The sheets and parts that are left on some points.
void renumber(const SurfacePoints::Sheets& from, SurfacePoints::Sheets& to) {
  for (const std::uint32_t sheet : renumber(to.sheet)) to.part.push_back(from.part[sheet]);
  for (const std::uint32_t part : renumber(to.part)) to.known.push_back(from.known[part]);
}

void append(const SurfacePoints::Sheets& from, SurfacePoints::Sheets& to) {
  const auto parts = static_cast<std::uint32_t>(to.known.size());
  for (const std::uint32_t part : from.part) to.part.push_back(parts + part);
  to.known.insert(to.known.end(), from.known.begin(), from.known.end());
}

/// The times of all steps.
std::array<double*, 5> times(Prepared::Report& report) {
  return {&report.seconds_filter, &report.seconds_index, &report.seconds_spacing,
          &report.seconds_normals, &report.seconds_weights};
}

void add(Prepared::Report one, Prepared::Report& all) {
  all.points_in += one.points_in;
  all.points_out += one.points_out;
  all.duplicates += one.duplicates;
  all.speckle += one.speckle;
  for (std::size_t k = 0; k < times(all).size(); ++k) *times(all)[k] += *times(one)[k];
}

/// Makes times that passed side by side shares of the time that passed.
void share_out(double seconds, std::span<Piece> pieces) {
  double sum = 0;
  for (Piece& piece : pieces) {
    for (const double* time : times(piece.report)) sum += *time;
  }
  for (Piece& piece : pieces) {
    for (double* time : times(piece.report)) *time *= sum > 0 ? seconds / sum : 0;
  }
}

}  // namespace

bool goes_by_blocks(std::size_t points, const PrepareOptions& options) {
  if (options.paper || options.material_from_intensity) return false;  // both are of all points
  return options.facts ? options.facts->radius > 0 : points > kMostAtOnce;
}

Blocks::Blocks(const Placed& placed, const PrepareOptions& options)
    : cloud_(placed.cloud()), viewpoint_(placed.viewpoint), options_(options) {
  options_.clip.reset();
  if (options_.viewpoint) options_.viewpoint = viewpoint_;  // given normals count beside a file's
  if (options_.facts) {
    detail::require_finite(cloud_.positions);
  } else {
    options_.facts = measure_facts(cloud_, options_);
  }
  facts_ = *options_.facts;
  edge_ = kBlockEdge * facts_.radius;
  divide();
}

Blocks::Place Blocks::place_of(const Vector3d& point) const {
  const Vector3d at = (point - facts_.extent.lower) / edge_;
  Place place;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double cube = std::clamp(std::floor(at[axis]), -kMostPlaces, kMostPlaces - 1);
    place[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(cube);
  }
  return place;
}

void Blocks::divide() {
  std::unordered_map<std::uint64_t, std::size_t> known;
  Place last{};
  std::size_t block = 0;
  for (std::uint32_t i = 0; i < cloud_.size(); ++i) {
    const Place at = place_of(cloud_.point(i));
    if (i == 0 || at != last) {
      std::uint64_t key = 0;
      for (const std::int32_t cube : at) {
        key = key << 21 | static_cast<std::uint64_t>(cube + static_cast<std::int32_t>(kMostPlaces));
      }
      const auto [found, is_new] = known.try_emplace(key, blocks_.size());
      if (is_new) blocks_.push_back({at, {}});
      block = found->second;
      last = at;
    }
    blocks_[block].points.push_back(i);
  }
  std::ranges::sort(blocks_, {}, &Block::at);
}

const Blocks::Block* Blocks::find(const Place& at) const {
  const auto found = std::ranges::lower_bound(blocks_, at, {}, &Block::at);
  return found != blocks_.end() && found->at == at ? &*found : nullptr;
}

Vector3d Blocks::corner_of(const Place& at) const {
  return facts_.extent.lower + edge_ * Vector3d(at[0], at[1], at[2]);
}

Box Blocks::box(std::size_t block) const {
  const Vector3d corner = corner_of(blocks_[block].at);
  return {corner, corner + Vector3d::Constant(edge_)};
}

double Blocks::halo(std::size_t block) const {
  const double usual = edge_ / facts_.spacing;  // points along an edge
  const double sparse = usual / std::sqrt(static_cast<double>(blocks_[block].points.size()));
  return kHalo * facts_.radius * std::clamp(sparse, 1., kSparsest);
}

std::vector<std::uint32_t> Blocks::with_halo(std::size_t number) const {
  const Block& block = blocks_[number];
  const double reach = halo(number);
  std::vector<std::uint32_t> near = block.points;
  const Vector3d corner = corner_of(block.at);
  for (int k = 0; k < 27; ++k) {
    const Place at{block.at[0] + k % 3 - 1, block.at[1] + k / 3 % 3 - 1, block.at[2] + k / 9 - 1};
    const Block* const other = at == block.at ? nullptr : find(at);
    if (other == nullptr) continue;
    for (const std::uint32_t i : other->points) {
      const Vector3d way = cloud_.point(i) - corner;
      const Vector3d off = way - way.cwiseMax(0).cwiseMin(edge_);
      if (off.cwiseAbs().maxCoeff() <= reach) near.push_back(i);
    }
  }
  std::ranges::sort(near);
  return near;
}

Piece Blocks::prepare(std::size_t number) const {
  const Block& block = blocks_[number];
  const PointCloud near = select(cloud_, with_halo(number));
  const Placed part{near, {}, viewpoint_};
  Prepared all = prepare_at_once(part, options_, {});
  SurfacePoints& points = all.points;
  const auto is_own = [&](std::uint32_t i) {
    return place_of(points.origin + points.grid.points()[i].cast<double>()) == block.at;
  };
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (is_own(i)) kept.push_back(i);
  }
  Piece piece;
  for (const std::uint32_t i : kept) piece.positions.push_back(points.grid.points()[i]);
  piece.columns.kernel = points.kernel;
  each_column([&](const auto& from, auto& to) { to = some_of(from, kept); }, points, piece.columns);
  renumber(points.sheets, piece.columns.sheets);
  piece.report = all.report;
  piece.report.points_in = block.points.size();
  piece.report.points_out = piece.report.speckle = piece.report.duplicates = 0;
  std::vector<std::uint8_t> first(points.size());  // a twin stands at its point's place
  for (const std::uint32_t i : first_of_each_place(points.grid)) first[i] = 1;
  for (const std::uint32_t i : kept) {
    if (first[points.grid.order()[i]] == 0) continue;
    ++(points.density_weights[i] > 0 ? piece.report.points_out : piece.report.speckle);
  }
  if (!(all.report.voxel > 0)) {
    piece.report.duplicates = block.points.size() - piece.report.points_out - piece.report.speckle;
  }
  return piece;
}

std::vector<Piece> Blocks::prepare_all() const {
  Stopwatch watch;
  std::vector<Piece> pieces(blocks_.size());
  detail::parallel_each(pieces.size(), 1, [&](std::size_t k) {
    // A thread that waits for parts of this block is not to begin another one.
    tbb::this_task_arena::isolate([&] { pieces[k] = prepare(k); });
  });
  double seconds = 0;
  watch.lap(seconds);
  share_out(seconds, pieces);
  return pieces;
}

Prepared Blocks::join(std::span<const Piece* const> pieces) const {
  Stopwatch watch;
  Prepared joined;
  SurfacePoints& points = joined.points;
  std::vector<Vector3f> positions;
  for (const Piece* const piece : pieces) {
    const auto sheets = static_cast<std::uint32_t>(points.sheets.part.size());
    const std::size_t before = points.sheets.sheet.size();
    positions.insert(positions.end(), piece->positions.begin(), piece->positions.end());
    each_column([](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); },
                piece->columns, points);
    for (std::size_t i = before; i < points.sheets.sheet.size(); ++i) {
      std::uint32_t& sheet = points.sheets.sheet[i];
      if (sheet != SurfacePoints::Sheets::kNone) sheet += sheets;
    }
    append(piece->columns.sheets, points.sheets);
    add(piece->report, joined.report);
  }
  points.kernel = options_.kernel;
  points.origin = cloud_.origin;
  CellGrid::Cube cube{facts_.extent.lower - points.origin, edge_};
  const double longest = facts_.extent.size().maxCoeff();
  for (int k = 0; k < kMostHalvings && cube.edge < longest; ++k) cube.edge *= 2;
  points.grid = CellGrid(positions, cube);
  positions = {};
  each_column([&](auto& column) { column = in_grid_order(points.grid, column); }, points);
  watch.lap(joined.report.seconds_index);
  joined.report.spacing = facts_.spacing;
  joined.report.noise = facts_.noise.sigma;
  for (const Piece* const piece : pieces) joined.report.voxel = piece->report.voxel;
  complete(joined);
  return joined;
}

}  // namespace palpate
