#include "viewer/surface_net.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palpate::viewer {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

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

/// Sums over the crossings of a cell's edges.
struct Crossings {
  Vector3f place = Vector3f::Zero();
  float support = 0;
  int count = 0;

  void add(const Lattice& lattice, const Vector3i& a, const Vector3i& b) {
    const float f = lattice.value(a);
    const float g = lattice.value(b);
    if ((f > 0) == (g > 0)) return;
    const float t = f / (f - g);
    place += ((1 - t) * lattice.place(a) + t * lattice.place(b)).cast<float>();
    support += (1 - t) * lattice.support(a) + t * lattice.support(b);
    ++count;
  }
};

std::optional<Vector3f> vertex_of(const Lattice& lattice, const Vector3i& cell,
                                  double least_support) {
  for (int corner = 0; corner < 8; ++corner) {
    if (!lattice.known(corner_of(cell, corner))) return std::nullopt;
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
  return crossings.place / count;
}

template <class Visit>
void for_each(int first, const Visit& visit) {
  for (int z = first; z < kCells; ++z) {
    for (int y = first; y < kCells; ++y) {
      for (int x = first; x < kCells; ++x) visit(Vector3i(x, y, z));
    }
  }
}

class Net {
 public:
  Net(const Lattice& lattice, double least_support) : lattice_(lattice), at_(kCellCount, kNone) {
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

  /// Around the edge from a corner along an axis, of the four cells that share it.
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

}  // namespace

Mesh surface_net(const Lattice& lattice, double least_support) {
  return Net(lattice, least_support).take();
}

}  // namespace palpate::viewer
