// Meshes a field around a centre: surface nets over cubic cells.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

// Values at the corners of kCells^3 cubic cells around a centre, or none where nobody put one.
class Lattice {
 public:
  static constexpr int kCells = 32;
  static constexpr int kCorners = kCells + 1;

  // `half`: half of the cube's edge, m.
  explicit Lattice(double half)
      : half_(half), cell_(2 * half / kCells), values_(kCount, kUnknown), supports_(kCount, 0) {}

  [[nodiscard]] double cell() const { return cell_; }
  // Position of a corner relative to the centre, m.
  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3i& corner) const {
    return cell_ * corner.cast<double>() - Eigen::Vector3d::Constant(half_);
  }
  [[nodiscard]] bool has_value(const Eigen::Vector3i& corner) const {
    return !std::isnan(value(corner));
  }
  [[nodiscard]] float value(const Eigen::Vector3i& corner) const { return values_[index(corner)]; }
  [[nodiscard]] float support(const Eigen::Vector3i& corner) const {
    return supports_[index(corner)];
  }
  void put(const Eigen::Vector3i& corner, double value, double support) {
    values_[index(corner)] = static_cast<float>(value);
    supports_[index(corner)] = static_cast<float>(support);
  }

 private:
  static constexpr std::size_t kCount = static_cast<std::size_t>(kCorners) * kCorners * kCorners;
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  [[nodiscard]] static std::size_t index(const Eigen::Vector3i& corner) {
    return static_cast<std::size_t>((corner.z() * kCorners + corner.y()) * kCorners + corner.x());
  }

  double half_;
  double cell_;
  std::vector<float> values_;
  std::vector<float> supports_;
};

constexpr int kCells = Lattice::kCells;
constexpr std::uint16_t kNone = 65535;
constexpr std::size_t kCellCount = static_cast<std::size_t>(kCells) * kCells * kCells;
static_assert(kCellCount < kNone);

Vector3i corner_of(const Vector3i& cell, int corner) {
  return cell + Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
}

std::size_t index_of(const Vector3i& cell) {
  return static_cast<std::size_t>((cell.z() * kCells + cell.y()) * kCells + cell.x());
}

// Sums over the crossings of a cell's edges.
struct Crossings {
  Vector3f position = Vector3f::Zero();
  float support = 0;
  int count = 0;

  void add(const Lattice& lattice, const Vector3i& a, const Vector3i& b) {
    const float f = lattice.value(a);
    const float g = lattice.value(b);
    if ((f > 0) == (g > 0)) return;
    const float t = f / (f - g);
    position += ((1 - t) * lattice.position(a) + t * lattice.position(b)).cast<float>();
    support += (1 - t) * lattice.support(a) + t * lattice.support(b);
    ++count;
  }
};

std::optional<Vector3f> vertex_of(const Lattice& lattice, const Vector3i& cell,
                                  double least_support) {
  for (int corner = 0; corner < 8; ++corner) {
    if (!lattice.has_value(corner_of(cell, corner))) return std::nullopt;
  }
  Crossings crossings;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 1; axis < 8; axis *= 2) {
      if ((corner & axis) != 0) continue;
      crossings.add(lattice, corner_of(cell, corner), corner_of(cell, corner | axis));
    }
  }
  if (crossings.count == 0) return std::nullopt;
  const auto count = static_cast<float>(crossings.count);
  if (crossings.support < static_cast<float>(least_support) * count) return std::nullopt;
  return crossings.position / count;
}

template <class Visit>
void for_each(int first, const Visit& visit) {
  for (int z = first; z < kCells; ++z) {
    for (int y = first; y < kCells; ++y) {
      for (int x = first; x < kCells; ++x) visit(Vector3i(x, y, z));
    }
  }
}

// The surface between positive and other values of a lattice: a vertex in each cell whose corners
// all have values, which differ, in the mean of its edges' crossings; a quadrangle around each edge
// that the surface crosses. Vertices with less than `least_support` are left out.
class SurfaceNet {
 public:
  SurfaceNet(const Lattice& lattice, double least_support)
      : lattice_(lattice), at_(kCellCount, kNone) {
    for_each(0, [&](const Vector3i& cell) { add_vertex(cell, least_support); });
    for_each(0, [&](const Vector3i& corner) {
      for (int axis = 0; axis < 3; ++axis) add_quadrangle(corner, axis);
    });
  }

  [[nodiscard]] Mesh take() { return std::move(mesh_); }

 private:
  void add_vertex(const Vector3i& cell, double least_support) {
    const std::optional<Vector3f> vertex = vertex_of(lattice_, cell, least_support);
    if (!vertex) return;
    at_[index_of(cell)] = static_cast<std::uint16_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(*vertex);
  }

  // Around the edge from a corner along an axis, of the four cells that share it.
  void add_quadrangle(const Vector3i& corner, int axis) {
    const Vector3i u = Vector3i::Unit((axis + 1) % 3);
    const Vector3i v = Vector3i::Unit((axis + 2) % 3);
    if (corner.dot(u) == 0 || corner.dot(v) == 0) return;
    const float begin = lattice_.value(corner);
    const float end = lattice_.value(corner + Vector3i::Unit(axis));
    if (std::isnan(begin) || std::isnan(end) || (begin > 0) == (end > 0)) return;
    const std::array<std::uint16_t, 4> around{at_[index_of(corner - u - v)],
                                              at_[index_of(corner - v)], at_[index_of(corner)],
                                              at_[index_of(corner - u)]};
    for (const std::uint16_t vertex : around) {
      if (vertex == kNone) return;
    }
    if (end > 0) {
      add_triangles(around[0], around[1], around[2], around[3]);
    } else {
      add_triangles(around[3], around[2], around[1], around[0]);
    }
  }

  void add_triangles(std::uint16_t a, std::uint16_t b, std::uint16_t c, std::uint16_t d) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.triangles.push_back({a, c, d});
  }

  const Lattice& lattice_;
  std::vector<std::uint16_t> at_;  // each cell's vertex
  Mesh mesh_;
};

// A block is the smallest cube that is looked at as one: a field gathers points for it once.
constexpr int kBlock = 2;  // cells

// A value further from 0 than this shows that no surface is in reach, whatever the field's slope.
constexpr double kSteepest = 1.3;

// Fills a lattice where the surface may be.
class Sampler {
 public:
  Sampler(const Field& field, const LocalRegion& region, Lattice& lattice)
      : field_(field), region_(region), lattice_(lattice) {}

  // A cube of `edge` cells, from the corner `first` on.
  void look(const Vector3i& first, int edge) {
    const double half = 0.5 * edge * lattice_.cell();
    const Vector3d center = region_.center + lattice_.position(first) + Vector3d::Constant(half);
    if (field_.is_free({center, std::sqrt(3.0) * half})) return;
    if (edge == kBlock) {
      look_at_block(first, center, std::sqrt(3.0) * half);
      return;
    }
    for (int part = 0; part < 8; ++part) {
      look(first + edge / 2 * Vector3i(part & 1, part >> 1 & 1, part >> 2 & 1), edge / 2);
    }
  }

 private:
  void look_at_block(const Vector3i& first, const Vector3d& center, double reach) {
    const Sample middle = field_.sample(center);
    if (!(std::abs(middle.value) <= kSteepest * reach)) return;
    for (int z = 0; z <= kBlock; ++z) {
      for (int y = 0; y <= kBlock; ++y) {
        for (int x = 0; x <= kBlock; ++x) sample(first + Vector3i(x, y, z));
      }
    }
  }

  void sample(const Vector3i& corner) {
    if (lattice_.has_value(corner)) return;
    const Sample sample = field_.sample(region_.center + lattice_.position(corner));
    lattice_.put(corner, sample.value, sample.support);
  }

  const Field& field_;
  const LocalRegion& region_;
  Lattice& lattice_;
};

}  // namespace

Mesh local_surface(const Field& field, const LocalRegion& region) {
  if (!(region.radius > 0) || !region.center.allFinite()) return {};
  Lattice lattice(kReach * region.radius);
  Sampler(field, region, lattice).look(Vector3i::Zero(), Lattice::kCells);
  return SurfaceNet(lattice, region.least_support).take();
}

}  // namespace palpate::viewer
