// Cuts a cloud into blocks, prepares each with what lies around it and joins them.

#include "large/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/requirement.hpp"
#include "geometry/cell_builder.hpp"
#include "geometry/elements_at.hpp"
#include "geometry/parallel.hpp"
#include "large/shared_progress.hpp"
#include "prepare/assemble.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/stopwatch.hpp"
#include "prepare/surfels.hpp"
#include "refine/refinements.hpp"

// Null where the C library has none; glibc has.
extern "C" [[gnu::weak]] int malloc_trim(std::size_t) noexcept;

namespace palpate {
namespace {

// Gives free memory back to the system, where the heap can.
void trim_heap() {
  if (malloc_trim != nullptr) malloc_trim(0);
}

using Eigen::Vector3d;
using Eigen::Vector3f;

// Points that two cores prepare in some 2 s. The first block of a smaller cloud would be a third of
// it, which is not worth the halos; judgement.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 19;

// Typical R of its level: the halo of a block. Measured: 2, 3 and 5 give nearly the same columns
// (docs/preparation.md).
constexpr double kHalo = 3;
// The same on further levels, where R is 1.5 to 6 of these; there it costs little; judgement.
constexpr double kSparseHalo = 12;

// Points of pieces that are freed between two looks for memory to give back: some 60 MB; judgement.
constexpr std::size_t kFreed = std::size_t{1} << 20;

constexpr int kMostHalvings = 11;  // derived: levels of a CellGrid's curve

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
  visit(points.segments.segment...);
  visit(points.segments.residual...);
}

/// Gives the members of `numbers`, but kNone, new numbers from 0 on in the order in which they
/// come. Returns the old ones.
std::vector<std::uint32_t> renumber(std::vector<std::uint32_t>& numbers) {
  std::unordered_map<std::uint32_t, std::uint32_t> fresh;
  std::vector<std::uint32_t> old;
  for (std::uint32_t& number : numbers) {
    if (number == SurfacePoints::Segments::kNone) continue;
    const auto [entry, is_new] = fresh.try_emplace(number, static_cast<std::uint32_t>(old.size()));
    if (is_new) old.push_back(number);
    number = entry->second;
  }
  return old;
}

/// The segments and components that are left on some points.
void renumber(const SurfacePoints::Segments& from, SurfacePoints::Segments& to) {
  for (const std::uint32_t segment : renumber(to.segment))
    to.component.push_back(from.component[segment]);
  for (const std::uint32_t component : renumber(to.component))
    to.known.push_back(from.known[component]);
}

void append(const SurfacePoints::Segments& from, SurfacePoints::Segments& to) {
  const auto components = static_cast<std::uint32_t>(to.known.size());
  for (const std::uint32_t component : from.component)
    to.component.push_back(components + component);
  to.known.insert(to.known.end(), from.known.begin(), from.known.end());
}

/// The times of all steps.
std::array<double*, 5> times(Prepared::Report& report) {
  return {&report.seconds_filter, &report.seconds_index, &report.seconds_spacing,
          &report.seconds_normals, &report.seconds_weights};
}

void add(Prepared::Report one, Prepared::Report& all) {
  all.voxel = std::max(all.voxel, one.voxel);  // 0 of one without points
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

bool can_go_by_blocks(const PrepareOptions& options) {
  if (options.paper || options.material_from_intensity) return false;  // both are of all points
  return !options.facts || options.facts->radius > 0;
}

bool goes_by_blocks(std::size_t points, const PrepareOptions& options) {
  return can_go_by_blocks(options) && (options.facts || points > kMostAtOnce);
}

namespace {

PrepareOptions of_one_block(const Placed& placed, PrepareOptions options) {
  options.clip.reset();
  options.progress = {};  // it counts all blocks
  // A viewpoint of the file must not become one of the options: that would disable its normals.
  if (options.viewpoint) options.viewpoint = placed.viewpoint;
  if (options.facts) {
    detail::require_finite(placed.cloud().positions);
    const Requirement require{"preparation"};
    require.positive("facts.radius", options.facts->radius, "give a typical R above 0, in metres");
  } else {
    options.facts = measure_facts(placed.cloud(), options);
  }
  return options;
}

}  // namespace

Blocks::Blocks(const Placed& placed, const PrepareOptions& options, int halvings)
    : cloud_(placed.cloud()),
      options_(of_one_block(placed, options)),
      viewpoint_(placed.viewpoint),
      facts_(*options_.facts),
      division_(cloud_, facts_, halvings) {}

double Blocks::halo(std::size_t block) const {
  const double radius = division_.radius(block);
  return (radius > facts_.radius ? kSparseHalo : kHalo) * radius;
}

Piece Blocks::prepare(std::size_t number, const detail::Progress& progress) const {
  const PointCloud near = select(cloud_, division_.around(number, halo(number)));
  const Placed part{near, {}, viewpoint_};
  PrepareOptions options = options_;
  options.facts->radius = division_.radius(number);
  options.progress = progress;
  Prepared all = prepare_at_once(part, options, refinements(), {});
  SurfacePoints& points = all.points;
  const auto is_own = [&](std::uint32_t i) {
    return division_.owns(number, points.origin + points.grid.points()[i].cast<double>());
  };
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (is_own(i)) kept.push_back(i);
  }
  Piece piece;
  piece.positions = detail::elements_at(points.grid.points(), kept);
  piece.columns.kernel = points.kernel;
  each_column([&](const auto& from, auto& to) { to = detail::elements_at(from, kept); }, points,
              piece.columns);
  renumber(points.segments, piece.columns.segments);
  piece.report = all.report;
  piece.report.points_in = division_.points(number);
  piece.report.points_out = piece.report.speckle = piece.report.duplicates = 0;
  std::vector<std::uint8_t> first(points.size());  // a second plane is at its point's position
  for (const std::uint32_t i : distinct_points(points.grid)) first[i] = 1;
  for (const std::uint32_t i : kept) {
    if (first[points.grid.order()[i]] == 0) continue;
    ++(points.density_weights[i] > 0 ? piece.report.points_out : piece.report.speckle);
  }
  if (!(all.report.voxel > 0)) {
    piece.report.duplicates =
        piece.report.points_in - piece.report.points_out - piece.report.speckle;
  }
  return piece;
}

std::vector<Piece> Blocks::prepare_all(const detail::Progress& progress) const {
  Stopwatch watch;
  std::vector<Piece> pieces(size());
  SharedProgress shared(progress, cloud_.size());
  detail::parallel_each(pieces.size(), 1, [&](std::size_t k) {
    shared.run(division_.points(k), [&](const detail::Progress& of_block) {
      // A thread that waits for parts of this block is not to begin another one.
      detail::isolated([&] { pieces[k] = prepare(k, of_block); });
    });
  });
  shared.end();
  double seconds = 0;
  watch.lap(seconds);
  share_out(seconds, pieces);
  return pieces;
}

namespace {

/// Blocks that become one surface, one after the other.
class Joining {
 public:
  explicit Joining(std::size_t points) : points_(points) {}

  void add(const Piece& piece) {
    SurfacePoints& points = joined_.points;
    const auto segments = static_cast<std::uint32_t>(points.segments.component.size());
    const std::size_t before = points.segments.segment.size();
    append_to(positions_, piece.positions);
    each_column([&](const auto& from, auto& to) { append_to(to, from); }, piece.columns, points);
    for (std::size_t i = before; i < points.segments.segment.size(); ++i) {
      std::uint32_t& segment = points.segments.segment[i];
      if (segment != SurfacePoints::Segments::kNone) segment += segments;
    }
    append(piece.columns.segments, points.segments);
    palpate::add(piece.report, joined_.report);
  }

  [[nodiscard]] Prepared end(const CloudFacts& facts, const Vector3d& origin, Kernel kernel) {
    SurfacePoints& points = joined_.points;
    points.kernel = kernel;
    points.origin = origin;
    CellGrid::Cube cube{facts.extent.lower - points.origin, Division::kBlockEdge * facts.radius};
    const double longest = facts.extent.size().maxCoeff();
    for (int k = 0; k < kMostHalvings && cube.edge < longest; ++k) cube.edge *= 2;
    points.grid = CellGrid(positions_, cube);
    positions_ = {};
    each_column([&](auto& column) { column = in_grid_order(points.grid, column); }, points);
    joined_.report.spacing = facts.spacing;
    joined_.report.noise = facts.noise.sigma;
    watch_.lap(joined_.report.seconds_index);
    complete(joined_);
    return std::move(joined_);
  }

 private:
  /// Room that no point has filled yet costs address space, not memory.
  template <class T>
  void append_to(std::vector<T>& column, const std::vector<T>& more) const {
    if (!more.empty()) column.reserve(points_);
    column.insert(column.end(), more.begin(), more.end());
  }

  std::size_t points_;  // of all blocks
  Stopwatch watch_;
  Prepared joined_;
  std::vector<Vector3f> positions_;
};

}  // namespace

Prepared join(std::span<const Piece* const> pieces, const CloudFacts& facts, const Vector3d& origin,
              Kernel kernel) {
  std::size_t points = 0;
  for (const Piece* const piece : pieces) points += piece->positions.size();
  Joining joining(points);
  for (const Piece* const piece : pieces) joining.add(*piece);
  return joining.end(facts, origin, kernel);
}

Prepared join(std::vector<Piece> pieces, const CloudFacts& facts, const Vector3d& origin,
              Kernel kernel) {
  std::size_t points = 0;
  for (const Piece& piece : pieces) points += piece.positions.size();
  Joining joining(points);
  std::size_t freed = 0;  // points, since memory went back to the system
  for (Piece& piece : pieces) {
    joining.add(piece);
    freed += piece.positions.size();
    piece = {};
    if (freed < kFreed) continue;
    trim_heap();  // many small pieces would stay in the heap
    freed = 0;
  }
  pieces = {};
  trim_heap();
  return joining.end(facts, origin, kernel);
}

}  // namespace palpate
