// Finds where the faces of a depth frame meet.
#include <algorithm>
#include <cmath>

#include "geometry/parallel.hpp"
#include "stream/block_surface.hpp"
#include "stream/lanes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// Blocks: between the two are a block that an edge crosses and one to each side, whose slopes it
// spoils (derived).
constexpr int kApart = 4;

// Limits of edges and creases (docs/method.md 6.5; judgement).
constexpr float kTurned = 0.866f;  // cosine of the least angle between two faces: 30 degrees
constexpr float kCertainly = BlockFaces::kCertainly;  // derived
constexpr int kMostAway = 8;                          // blocks
constexpr std::size_t kTogether = 8;   // blocks, of which each has a byte of one word (derived)
constexpr std::uint8_t kInRow = 1;     // a bit
constexpr std::uint8_t kInColumn = 2;  // a bit

/// Does the face of a block go on for R, or as far as is looked?
bool goes_on(const BlockFaces& faces, std::size_t block, int x, int y) {
  const float reach = faces.radii[block];
  for (int k = 1; k <= kMostAway; ++k) {
    const std::size_t next = faces.beside(block, k * x, k * y);
    if (!faces.shares_face(next, block)) return false;
    const Vector3f offset = faces.depth.positions[next] - faces.depth.positions[block];
    if (offset.squaredNorm() >= reach * reach) return true;
  }
  return true;
}

}  // namespace

void EdgeFinder::look(const FilteredDepth& depth, const BlockSurface& surface) {
  meets_.resize(depth.size() + kTogether);
  of_block_.resize(depth.size());
  found_.resize(depth.size());
  const BlockFaces faces{depth, surface.radii()};
  const auto columns = static_cast<std::size_t>(depth.columns);
  const auto rows = static_cast<std::size_t>(depth.rows);
  each_row(depth, [&](std::size_t v) { look_at(faces, static_cast<int>(v)); });
  each_row(depth, [&](std::size_t v) {
    for (std::size_t u = 0; u < columns; u += kTogether) write_some(faces, u, v, 1, 0);
  });
  detail::parallel_each((columns + kTogether - 1) / kTogether, 1, [&](std::size_t strip) {
    for (std::size_t v = 0; v < rows; ++v) write_some(faces, strip * kTogether, v, 0, 1);
  });
}

/// Which blocks of a row belong to faces that meet others?
void EdgeFinder::look_at(const BlockFaces& faces, int v) {
  const FilteredDepth& depth = faces.depth;
  const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.columns);
  const auto row = depth.states.begin() + static_cast<std::ptrdiff_t>(first);
  std::fill_n(meets_.begin() + static_cast<std::ptrdiff_t>(first), depth.columns, 0);
  std::fill_n(of_block_.begin() + static_cast<std::ptrdiff_t>(first), depth.columns, kNone);
  if (std::find(row, row + depth.columns, FilteredDepth::State::fitted) == row + depth.columns)
    return;
  // Most of an image is flat: there is nothing to look at.
  const auto flat = [&](std::size_t block, std::size_t by) {
    const Vector3f* const normals = depth.normals.data() + block;
    return block + by + kLanes <= depth.size() &&
           all(dot(load(normals), load(normals + by)) > kTurned);
  };
  const auto look_along = [&](int u, int x, int y, std::uint8_t which) {
    if (flat(first + u, static_cast<std::size_t>(kApart * (y * depth.columns + x)))) return;
    for (int k = u; k < std::min(u + kLanes, depth.columns - kApart * x); ++k) {
      if (v + kApart * y < depth.rows && meets(faces, first + k, x, y)) meets_[first + k] |= which;
    }
  };
  for (int u = 0; u < depth.columns; u += kLanes) {
    look_along(u, 1, 0, kInRow);
    look_along(u, 0, 1, kInColumn);
  }
}

/// Do the planes of a block and one to its right or below it meet between the two, and explain what
/// lies there, and do both faces go on?
bool EdgeFinder::meets(const BlockFaces& faces, std::size_t a, int x, int y) {
  const FilteredDepth& depth = faces.depth;
  const std::size_t b = a + static_cast<std::size_t>(kApart * (y * depth.columns + x));
  if (!faces.fitted(a) || !faces.fitted(b)) return false;
  if (depth.normals[a].dot(depth.normals[b]) > kTurned) return false;
  const float a_over_b = faces.height(a, b);
  const float b_over_a = faces.height(b, a);
  const float both = std::min(std::abs(a_over_b), std::abs(b_over_a));
  if (!(a_over_b * b_over_a > 0) ||
      both <= kCertainly * std::hypot(depth.deviations[a], depth.deviations[b]))
    return false;
  const float share = a_over_b > 0 ? -1.0f : 1.0f;
  for (int k = 1; k < kApart; ++k) {
    const std::size_t between = faces.beside(a, k * x, k * y);
    if (!faces.fitted(between)) return false;
    const float off = std::max(share * faces.height(between, a), share * faces.height(between, b));
    if (std::abs(off) > faces.room(between, a)) return false;
  }
  return goes_on(faces, a, -x, -y) && goes_on(faces, b, x, y);
}

/// Writes to rows (1, 0) or columns (0, 1) what lies beyond the edges at a few blocks of a row. No
/// other lines are written, so that threads may share them.
void EdgeFinder::write_some(const BlockFaces& faces, std::size_t u, std::size_t v, int x, int y) {
  const auto columns = static_cast<std::size_t>(faces.depth.columns);
  const std::size_t apart = kApart * (x != 0 ? columns : 1);
  const std::size_t first = v * columns + u;
  const std::size_t end = std::min(first + kTogether, (v + 1) * columns);
  const std::size_t before = first < apart ? first : first - apart;
  const auto eight = [&](std::size_t at) { return load<std::uint64_t>(&meets_[at]); };
  if ((eight(first) | eight(before)) == 0) return;
  for (std::size_t block = first; block < end; ++block) write(faces, block, apart, x, y);
}

void EdgeFinder::write(const BlockFaces& faces, std::size_t block, std::size_t apart, int x,
                       int y) {
  const std::uint8_t along = x != 0 ? kInRow : kInColumn;
  const std::uint8_t across = kInRow + kInColumn - along;
  if ((meets_[block] & along) != 0) {
    const Meeting meeting = meeting_of(faces, block, x, y);
    spread(faces, meeting, x, y);
    spread(faces, meeting.from_b(), x, y);
  }
  if ((meets_[block] & across) != 0) spread(faces, meeting_of(faces, block, y, x), x, y);
  if (block >= apart && (meets_[block - apart] & across) != 0) {
    spread(faces, meeting_of(faces, block - apart, y, x).from_b(), x, y);
  }
}

EdgeFinder::Meeting EdgeFinder::meeting_of(const BlockFaces& faces, std::size_t a, int x, int y) {
  const FilteredDepth& depth = faces.depth;
  const std::size_t b = a + static_cast<std::size_t>(kApart * (y * depth.columns + x));
  const float a_over_b = faces.height(a, b);
  const float share = a_over_b > 0 ? -1.0f : 1.0f;
  const float t = a_over_b / (a_over_b + faces.height(b, a));
  const Vector3f edge = depth.positions[a] + t * (depth.positions[b] - depth.positions[a]);
  return {a, b, edge, x != 0, share};
}

/// Writes to the blocks of a's face within R of the edge, in its row or column, what lies beyond.
void EdgeFinder::spread(const BlockFaces& faces, const Meeting& meeting, int x, int y) {
  const float reach = faces.radii[meeting.a];
  const float side = static_cast<float>(faces.depth.pitch) * faces.depth.positions[meeting.a].z();
  const int half = static_cast<int>(std::min(float{kMostAway}, std::ceil(reach / side)));
  for (int k = -half; k <= half; ++k) write_one(faces, meeting, k * x, k * y);
}

/// Writes it to the block (x, y) from a, unless that has an edge that is as near: of two in its row
/// and in its column, that in its row counts.
void EdgeFinder::write_one(const BlockFaces& faces, const Meeting& meeting, int x, int y) {
  const FilteredDepth& depth = faces.depth;
  const std::size_t block = faces.beside(meeting.a, x, y);
  if (block == depth.size()) return;
  const float reach = faces.radii[meeting.a];
  const float away = (depth.positions[block] - meeting.edge).squaredNorm();
  const bool nearer = of_block_[block] != kNone && found_[block].away <= away;
  if (nearer || away > reach * reach || !faces.shares_face(block, meeting.a)) return;
  if (meeting.share * faces.height(block, meeting.b) > faces.room(block, meeting.b)) return;
  const std::size_t mirrored =
      faces.beside(meeting.b, meeting.in_row ? -x : x, meeting.in_row ? y : -y);
  const std::size_t other = faces.shares_face(mirrored, meeting.b) ? mirrored : meeting.b;
  of_block_[block] = static_cast<std::uint32_t>(block);
  found_[block] = {{depth.normals[other], faces.height(block, other), meeting.share}, away};
}

}  // namespace palpate
