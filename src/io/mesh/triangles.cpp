// Divides the faces of a mesh into triangles.
#include "io/mesh/triangles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/mesh/face_sampler.hpp"

namespace palpate::io {
namespace {

using Eigen::Vector3d;
using Face = std::span<const std::uint32_t>;

// Triangles that a face is tried with before it is given up: all corners of one of 100 are tried,
// and the first of a convex one serves however many it has (judgement)
constexpr std::size_t kTrianglesTried = 10'000;
constexpr std::uint32_t kUnused = 0xFFFFFFFF;  // a vertex of no face so far

// The corners of the triangle between a face's corner `from` and the edge `i` edges behind it.
std::array<std::uint32_t, 3> triangle(Face face, std::size_t from, std::size_t i) {
  return {face[from], face[(from + i) % face.size()], face[(from + i + 1) % face.size()]};
}

// Triangles from a corner cover a face where none is turned over: then their areas add up to its
// own, and they do not overlap.
bool covers(const Mesh& mesh, Face face, std::size_t from, const Vector3d& normal) {
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const std::array<std::uint32_t, 3> corners = triangle(face, from, i);
    if (face_normal(mesh, corners).dot(normal) < 0) return false;
  }
  return true;
}

std::optional<std::size_t> covering_corner(const Mesh& mesh, Face face) {
  const Vector3d normal = face_normal(mesh, face);
  const std::size_t most = std::clamp<std::size_t>(kTrianglesTried / face.size(), 1, face.size());
  for (std::size_t from = 0; from < most; ++from) {
    if (covers(mesh, face, from, normal)) return from;
  }
  return {};
}

}  // namespace

TriangleMesh triangles_of(const Input& input, const Mesh& mesh, std::string format) {
  if (mesh.ends.empty()) {
    fail(input, "there are no faces in it", "Give a mesh: PLY, OBJ, STL, glTF or GLB");
  }
  TriangleMesh result{.format = std::move(format)};
  std::vector<std::uint32_t> numbers(mesh.vertices.size(), kUnused);
  const auto number_of = [&](std::uint32_t vertex) {
    std::uint32_t& number = numbers[vertex];
    if (number == kUnused) {
      number = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.emplace_back(input.scale().cwiseProduct(mesh.vertices[vertex].head<3>()));
    }
    return number;
  };
  for (std::size_t k = 0; k < mesh.ends.size(); ++k) {
    const Face face = mesh.face(k);
    const std::optional<std::size_t> from = covering_corner(mesh, face);
    if (!from) {
      fail(input, fmt::format("a face of {} corners is no star around one of them", face.size()),
           "Export the mesh with triangles alone");
    }
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      std::array<std::uint32_t, 3> corners = triangle(face, *from, i);
      std::ranges::transform(corners, corners.begin(), number_of);
      result.triangles.push_back(corners);
    }
  }
  return result;
}

}  // namespace palpate::io
