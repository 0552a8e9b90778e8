// The samples of a mesh: its corners, then its creases and rims, then what lies between on faces.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/numbers.hpp"
#include "base/requirement.hpp"
#include "palpate/tool/tool.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr Requirement kRequireMesh{"tool"};     // the name that errors begin with
const double kCrease = std::cos(20 * kDegree);  // what is bent by more is sharp (judgement)
constexpr std::size_t kMostFaces = 50'000;      // for pictures: 1.8 MB a page (judgement)
constexpr double kApart = 0.5;  // of the spacing: nearer to a sample another adds nothing

struct Edge {
  Vector3d normal;  // of its first face
  int faces = 0;
  bool bent = false;

  [[nodiscard]] bool sharp() const { return bent || faces != 2; }
};

struct Corner {
  Vector3d normal = Vector3d::Zero();  // of its first face
  Vector3d along = Vector3d::Zero();   // its first sharp edge, unit
  int sharp = 0;                       // edges
  bool pointed = false;                // by its faces' normals
  bool straight = true;                // as far as sharp edges go

  // Is it a tip, or where creases and rims bend, meet or end?
  [[nodiscard]] bool counts() const { return sharp == 0 ? pointed : sharp != 2 || !straight; }
};

// A mesh whose vertices in one position are one, without faces that have no area.
class Mesh {
 public:
  Mesh(std::span<const Vector3d> vertices, std::span<const Tool::Triangle> triangles) {
    for (const Vector3d& vertex : vertices) weld(vertex);
    for (const Tool::Triangle& triangle : triangles) add(triangle);
    if (faces_.empty()) throw Error("tool: no triangle of the mesh has an area; give one that has");
    corners_.resize(positions_.size());
    for (const Tool::Triangle& face : faces_) look_at(face);
    for (const auto& [ends, edge] : edges_) {
      if (!edge.sharp()) continue;
      look_along(ends.first, ends.second);
      look_along(ends.second, ends.first);
    }
  }

  [[nodiscard]] const auto& positions() const { return positions_; }
  [[nodiscard]] const auto& faces() const { return faces_; }
  [[nodiscard]] const auto& edges() const { return edges_; }
  [[nodiscard]] const auto& corners() const { return corners_; }

 private:
  void weld(const Vector3d& vertex) {
    if (!vertex.allFinite()) throw Error("tool: a vertex is not finite; give metres");
    kRequireMesh(vertex.cwiseAbs().maxCoeff() <= Tool::kLongest, "a vertex's coordinate",
                 vertex.cwiseAbs().maxCoeff(), "give metres, 10 at most");
    const auto next = static_cast<std::uint32_t>(positions_.size());
    const auto [known, is_new] = known_.try_emplace({vertex.x(), vertex.y(), vertex.z()}, next);
    if (is_new) positions_.push_back(vertex);
    welded_.push_back(known->second);
  }

  void add(const Tool::Triangle& triangle) {
    Tool::Triangle face{};
    for (std::size_t i = 0; i < 3; ++i) {
      kRequireMesh(triangle[i] < welded_.size(), "a triangle's index", triangle[i],
                   "give one below the number of vertices");
      face[i] = welded_[triangle[i]];
    }
    const Vector3d normal = normal_of(face);
    if (normal.isZero(0)) return;
    faces_.push_back(face);
    for (std::size_t i = 0; i < 3; ++i) {
      Edge& edge = edges_[std::minmax(face[i], face[(i + 1) % 3])];
      if (edge.faces++ == 0) edge.normal = normal;
      edge.bent = edge.bent || edge.normal.dot(normal) < kCrease;
    }
  }

  // Zero of a face without an area.
  [[nodiscard]] Vector3d normal_of(const Tool::Triangle& face) const {
    const Vector3d& from = positions_[face[0]];
    return (positions_[face[1]] - from).cross(positions_[face[2]] - from).normalized();
  }

  void look_at(const Tool::Triangle& face) {
    const Vector3d normal = normal_of(face);
    for (const std::uint32_t index : face) {
      Corner& corner = corners_[index];
      if (corner.normal.isZero(0)) corner.normal = normal;
      corner.pointed = corner.pointed || corner.normal.dot(normal) < kCrease;
    }
  }

  void look_along(std::uint32_t from, std::uint32_t to) {
    Corner& corner = corners_[from];
    const Vector3d along = (positions_[to] - positions_[from]).normalized();
    if (corner.sharp++ == 0) corner.along = along;
    corner.straight = corner.straight && (corner.sharp == 1 || -corner.along.dot(along) > kCrease);
  }

  std::map<std::array<double, 3>, std::uint32_t> known_;
  std::vector<std::uint32_t> welded_;  // which position a vertex has
  std::vector<Vector3d> positions_;
  std::vector<Tool::Triangle> faces_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges_;
  std::vector<Corner> corners_;
};

// Samples that keep apart from each other, found by the cells of a grid.
class Thinned {
 public:
  explicit Thinned(double spacing) : spacing_(spacing), apart_(kApart * spacing) {}

  void keep(const Vector3d& x) {
    if (samples_.size() >= Tool::kMostSamples) {
      throw Error(fmt::format(
          "tool: the mesh has more than {} corners and samples {:.3g} m apart; give a larger "
          "spacing or, where it is rough and corners stay, a smoothed mesh",
          Tool::kMostSamples, spacing_));
    }
    samples_.push_back({x, 0, 0});
    cells_[cell_of(x)].push_back(x);
  }

  // Keeps points on a line, no farther apart than the spacing, that have nothing near them yet.
  void fill(const Vector3d& from, const Vector3d& to) {
    const double count = std::max(1.0, std::ceil((to - from).norm() / spacing_));
    for (double i = 0; i <= count; ++i) {
      const Vector3d x = from + i / count * (to - from);
      if (!near(x)) keep(x);
    }
  }

  [[nodiscard]] std::vector<Tool::Point>& samples() { return samples_; }

 private:
  using Cell = std::array<double, 3>;  // whole numbers

  [[nodiscard]] Cell cell_of(const Vector3d& x) const {
    return {std::floor(x.x() / apart_), std::floor(x.y() / apart_), std::floor(x.z() / apart_)};
  }

  [[nodiscard]] bool near(const Vector3d& x) const {
    const Cell middle = cell_of(x);
    for (int i = 0; i < 27; ++i) {
      const auto found =
          cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (found == cells_.end()) continue;
      for (const Vector3d& kept : found->second) {
        if ((kept - x).norm() < apart_) return true;
      }
    }
    return false;
  }

  double spacing_;
  double apart_;  // m
  std::map<Cell, std::vector<Vector3d>> cells_;
  std::vector<Tool::Point> samples_;
};

// Lines across a face, as far apart as their points, from its longest edge to the corner beyond.
void fill_face(Thinned& samples, const Vector3d& a, const Vector3d& b, const Vector3d& c,
               double spacing) {
  const double ab = (b - a).norm();
  const double bc = (c - b).norm();
  const double ca = (a - c).norm();
  if (bc > ab && bc >= ca) return fill_face(samples, b, c, a, spacing);
  if (ca > ab) return fill_face(samples, c, a, b, spacing);
  const double height = (b - a).cross(c - a).norm() / ab;
  const double rows = std::max(1.0, std::ceil(height / spacing));
  kRequireMesh(rows * ab / spacing < Tool::kMostSamples, "spacing", spacing,
               "give a larger one, in metres");
  for (double row = 0; row <= rows; ++row) {
    samples.fill(a + row / rows * (c - a), b + row / rows * (c - b));
  }
}

}  // namespace

Tool Tool::mesh(std::span<const Vector3d> vertices, std::span<const Triangle> triangles,
                double spacing) {
  kRequireMesh.positive("spacing", spacing, "give a length above 0, in metres");
  const Mesh mesh(vertices, triangles);
  Thinned samples(spacing);
  for (std::size_t i = 0; i < mesh.corners().size(); ++i) {
    if (mesh.corners()[i].counts()) samples.keep(mesh.positions()[i]);
  }
  for (const auto& [ends, edge] : mesh.edges()) {
    if (!edge.sharp()) continue;
    samples.fill(mesh.positions()[ends.first], mesh.positions()[ends.second]);
  }
  for (const Triangle& face : mesh.faces()) {
    fill_face(samples, mesh.positions()[face[0]], mesh.positions()[face[1]],
              mesh.positions()[face[2]], spacing);
  }
  Tool tool(std::move(samples.samples()));
  if (mesh.faces().size() > kMostFaces) return tool;
  for (const Triangle& face : mesh.faces()) {
    const auto corner = [&](std::size_t i) { return mesh.positions()[face[i]].cast<float>(); };
    tool.faces_.push_back({corner(0), corner(1), corner(2)});
  }
  return tool;
}

}  // namespace palpate
