// Continues planes behind what hides them.
#include "stream/hidden_planes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "field/formulas.hpp"
#include "geometry/parallel.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// Share of R, between blocks of one line, beyond which a jump may be. Rows of one surface are R
// / 2.2 apart at most (docs/method.md 6.7), and where a pixel flies a jump of R is two of half of
// it.
constexpr float kMayJump = 0.5f;  // derived

// Blocks from a jump to the one whose plane goes on: the two next to it may mix both sides.
constexpr int kAside = 3;  // derived, as in docs/method.md 6.5

// Blocks in a row that show the plane again: one may do so by chance.
constexpr int kAgain = 2;  // judgement

// Blocks without a measurement that are passed over, as many as fits bridge (docs/method.md 6.3).
constexpr int kMostEmpty = 3;

// Blocks over which a plane goes on at most: 64 pixels, 60 mm at 0.5 m; a hand's width at 0.7 m.
constexpr int kReach = 32;  // judgement

constexpr std::uint8_t kLeft = 1;         // a bit: a jump to the block on the left
constexpr std::uint8_t kAbove = 2;        // a bit
constexpr std::uint8_t kPoint = 4;        // a bit: a plane goes on behind the block
constexpr std::size_t kRowsTogether = 8;  // blocks, of which each has a byte of one word (derived)
constexpr std::uint64_t kEach = 0x0101010101010101;  // a bit of each of these (derived)

/// How far the plane of `of` lies behind the block, along the camera's axis, m.
float beyond(const BlockFaces& faces, std::size_t block, std::size_t of) {
  const Vector3f& p = faces.depth.positions[block];
  const Vector3f& n = faces.depth.normals[of];
  return (n.dot(faces.depth.positions[of]) / n.dot(p) - 1) * p.z();
}

}  // namespace

void HiddenPlanes::find(const BlockFaces& faces, const PaddedBlocks& padded) {
  const FilteredDepth& depth = faces.depth;
  for (const std::uint32_t block : blocks_) points_[block] = {};
  blocks_.clear();
  blocks_.reserve(depth.size());
  notes_.resize(depth.size());
  points_.resize(depth.size());
  const auto columns = static_cast<std::size_t>(depth.columns);
  each_row(depth, [&](std::size_t v) {
    mark(faces, padded, static_cast<int>(v));
    const Line row{faces, v * columns, 1, depth.columns};
    each_noted(v * columns, columns, kLeft,
               [&](std::size_t u) { look_at(row, static_cast<int>(u)); });
  });
  detail::parallel_each((columns + kRowsTogether - 1) / kRowsTogether, 1, [&](std::size_t strip) {
    const std::size_t first = strip * kRowsTogether;
    const std::size_t count = std::min(kRowsTogether, columns - first);
    for (int v = 1; v < depth.rows; ++v) {
      each_noted(v * columns + first, count, kAbove, [&](std::size_t u) {
        look_at({faces, first + u, depth.columns, depth.rows}, v);
      });
    }
  });
  each_noted(0, depth.size(), kPoint,
             [&](std::size_t block) { blocks_.push_back(static_cast<std::uint32_t>(block)); });
}

// Calls visit(k) for the blocks first + k, k < count, of which so much is noted. Of most of an
// image nothing is.
template <class Visit>
void HiddenPlanes::each_noted(std::size_t first, std::size_t count, std::uint8_t what,
                              const Visit& visit) const {
  for (std::size_t from = 0; from < count; from += kRowsTogether) {
    const std::size_t end = std::min(count, from + kRowsTogether);
    std::uint64_t notes = ~std::uint64_t{0};  // what stands behind the last ones may be written to
    if (end == from + kRowsTogether) std::memcpy(&notes, &notes_[first + from], sizeof notes);
    if ((notes & what * kEach) == 0) continue;
    for (std::size_t k = from; k < end; ++k) {
      if ((notes_[first + k] & what) != 0) visit(k);
    }
  }
}

// Where is a block of a row apart from the one to its left or above it, or one of the two empty?
void HiddenPlanes::mark(const BlockFaces& faces, const PaddedBlocks& padded, int v) {
  const std::ptrdiff_t columns = faces.depth.columns;
  const float* const z = &padded.z[padded.index(0, v)];
  const float* const radii = &faces.radii[static_cast<std::size_t>(v * columns)];
  std::uint8_t* const jumps = &notes_[static_cast<std::size_t>(v * columns)];
  const auto jump = [&](std::ptrdiff_t u, float other, float other_radius) {
    const bool both = (radii[u] > 0) & (other_radius > 0);
    const bool apart = std::abs(z[u] - other) > kMayJump * radii[u];
    return (both & apart) | ((radii[u] > 0) != (other_radius > 0));
  };
  const std::ptrdiff_t up = v > 0 ? columns : 0;
  const auto stride = v > 0 ? static_cast<std::ptrdiff_t>(padded.stride) : 0;
  jumps[0] = jump(0, z[-stride], radii[-up]) ? kAbove : 0;
  for (std::ptrdiff_t u = 1; u < columns; ++u) {
    const int left = jump(u, z[u - 1], radii[u - 1]) ? kLeft : 0;
    const int above = jump(u, z[u - stride], radii[u - up]) ? kAbove : 0;
    jumps[u] = static_cast<std::uint8_t>(left | above);
  }
}

/// Looks behind the nearer of two blocks of a line, and behind an empty one.
void HiddenPlanes::look_at(const Line& line, int i) {
  const std::vector<Vector3f>& positions = line.faces.depth.positions;
  const bool back = line.empty(i - 1) ||
                    (!line.empty(i) && positions[line.at(i)].z() > positions[line.at(i - 1)].z());
  const auto gap = back ? gap_at(line, i, -1) : gap_at(line, i - 1, 1);
  if (gap) fill(line, *gap);
}

/// Does the plane beside `far` go on in that direction until it is seen again?
std::optional<HiddenPlanes::Gap> HiddenPlanes::gap_at(const Line& line, int far, int step) {
  const BlockFaces& faces = line.faces;
  const int seen = far - kAside * step;
  if (!line.holds(seen) || !faces.fitted(line.at(seen))) return {};
  const std::size_t plane = line.at(seen);
  if (!faces.shares_face(line.at(far - step), plane)) return {};
  Gap gap{seen, far, far};
  int again = 0;
  int empty = 0;
  for (int i = far + step; line.holds(i) && std::abs(i - far) <= kReach; i += step) {
    const std::size_t block = line.at(i);
    if (line.empty(i)) {
      again = 0;
      if (++empty > kMostEmpty) return {};
      continue;
    }
    empty = 0;
    gap.again = i;
    again = faces.shares_face(block, plane) ? again + 1 : 0;
    const bool hides = gap.rim != far;
    if (again == kAgain) return hides ? std::optional(gap) : std::nullopt;
    if (again > 0) continue;
    const float behind = beyond(faces, block, plane);
    if (behind < -faces.radii[plane]) return {};
    if (!hides && behind > faces.radii[plane]) gap.rim = i;
  }
  return {};
}

void HiddenPlanes::fill(const Line& line, const Gap& gap) {
  const int step = gap.again > gap.seen ? 1 : -1;
  const int far = gap.seen + kAside * step;
  const int other = gap.again - step;
  for (int i = far + step; i != gap.again; i += step) {
    const Point point = between(line, gap, i);
    if (!is_hidden(line, gap, i, point)) continue;
    if (std::abs(i - far) <= 1 + kMostEmpty) join(line, far, -step, point);
    if (std::abs(i - other) <= 1 + kMostEmpty) join(line, other, step, point);
    if (!(point.length < points_[line.at(i)].length)) continue;
    points_[line.at(i)] = point;
    notes_[line.at(i)] |= kPoint;
  }
}

/// Notes the blocks from i on that lie within R of a point of their surface.
void HiddenPlanes::join(const Line& line, int i, int step, const Point& point) {
  const float within = point.radius * point.radius;
  for (; line.holds(i) && !line.empty(i); i += step) {
    const std::size_t block = line.at(i);
    if ((line.faces.depth.positions[block] - point.position).squaredNorm() > within) return;
    notes_[block] |= kJoins;
  }
}

// The planes at both ends count as they are near, so that neither end has a step.
HiddenPlanes::Point HiddenPlanes::between(const Line& line, const Gap& gap, int i) const {
  const FilteredDepth& depth = line.faces.depth;
  const std::size_t a = line.at(gap.seen);
  const std::size_t b = line.at(gap.again);
  const Vector3f& from = depth.positions[a];
  const Vector3f& to = depth.positions[b];
  const float t = static_cast<float>(i - gap.seen) / static_cast<float>(gap.again - gap.seen);
  const auto mix = [t](const auto& x, const auto& y) { return x + t * (y - x); };
  const Vector3f ray = mix(Vector3f(from / from.z()), Vector3f(to / to.z()));
  const float inverse = mix(depth.normals[a].dot(ray) / depth.normals[a].dot(from),
                            depth.normals[b].dot(ray) / depth.normals[b].dot(to));
  Point point;
  point.position = ray / inverse;
  point.normal = mix(depth.normals[a], depth.normals[b]).normalized();
  point.radius = mix(line.faces.radii[a], line.faces.radii[b]);
  const float side = static_cast<float>(depth.pitch) * point.position.z();
  const float rows = std::max(side, mix(depth.spacings[a], depth.spacings[b]));
  point.area = side * rows / static_cast<float>(plane_integral(kernel_));
  point.confidence = std::min(depth.confidences[a], depth.confidences[b]);
  point.length = (to - from).norm();
  return point;
}

/// Is the point behind what the block shows by more than R, and not within R of what that is the
/// surface of? A thing may stand on the plane: what is nearer than its rim, along the plane, is
/// then within it.
bool HiddenPlanes::is_hidden(const Line& line, const Gap& gap, int i, const Point& point) {
  const FilteredDepth& depth = line.faces.depth;
  if (!(point.position.z() > 0)) return false;
  const std::size_t block = line.at(i);
  const Vector3f away = depth.positions[line.at(gap.seen)] - depth.positions[line.at(gap.again)];
  const bool beside = (point.position - depth.positions[line.at(gap.rim)]).dot(away) >= 0;
  if (line.empty(i)) return beside;
  const Vector3f offset = point.position - depth.positions[block];
  if (!(offset.z() > point.radius)) return false;
  return beside || depth.normals[block].dot(offset) < -point.radius;
}

}  // namespace palpate
