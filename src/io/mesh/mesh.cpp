// Decides how a mesh is felt, and samples its faces into points.
#include "io/mesh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/numbers.hpp"
#include "io/mesh/face_sampler.hpp"
#include "io/units/file_unit.hpp"

namespace palpate::io {
namespace {

using Eigen::Vector3d;

// Spacings along the diagonal of a mesh's box. R is 2.5 spacings: what is a hundredth as large as
// the mesh is 1.6 R thick, and its rims hold (measured: tests/contact/mesh_test.cpp)
constexpr double kAlongDiagonal = 400;
// Samples that even simple meshes get: prepared as a whole, in some 2 s (docs/preparation.md)
constexpr double kFewestSamples = 400'000;
constexpr double kMostSamples = 1'000'000;  // prepared block by block in some seconds (judgement)
constexpr double kMostAsked = 20'000'000;  // samples where the caller gives the spacing (judgement)
constexpr double kFinestAsked = 1e5;       // spacings along the diagonal, then (judgement)
// Spacings along the diagonal that thin rods may have; bounds the rows of a face (judgement)
constexpr double kFinest = 2000;
// Samples that faces may get, over those that their areas require, or over kMostSamples. Areas
// foretell them unless faces cross themselves or many narrow ones lie on one line (judgement)
constexpr double kSurplus = 4;
// Comparisons to find and sort the crossings of lines and edges: so many, and some for each corner.
// A polygon that zigzags a million times would take minutes (judgement: 3 s)
constexpr double kMostWork = 5e8;
constexpr double kWorkPerCorner = 64;

// The vertices alone describe the surface where they lie as densely as a scan's: in spacings of
// vertices the diagonal is at least this long (judgement) ...
constexpr double kScanned = 64;
// ... and no edge is longer than this, in those spacings or in those of samples: R grows with the
// spacing around a point, and bridges such edges (measured on the dragon, whose longest are 8)
constexpr double kLongEdge = 10;

// Twice the area of a face, over the square of its longest edge, below which rounding decides where
// its normal points (derived: the square root of a double's digits)
constexpr double kFlat = 1e-8;

// Faces that are used, and what is measured of them.
struct FaceSurvey {
  std::vector<std::size_t> used;  // ascending
  MeshFacts facts;
  Box box;
  double area = 0;
  double samples = 0;  // areas as seen along the axis that each face is sampled along
  FileUnit unit;
};

double longest_edge(const Mesh& mesh, std::span<const std::uint32_t> face) {
  double longest = 0;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const std::uint32_t next = face[(i + 1) % face.size()];
    const Vector3d edge = (mesh.vertices[next] - mesh.vertices[face[i]]).head<3>();
    longest = std::max(longest, edge.squaredNorm());
  }
  return std::sqrt(longest);
}

bool has_area(const Input& input, const Mesh& mesh, std::span<const std::uint32_t> face) {
  for (const std::uint32_t corner : face) {
    if (!is_usable(input.scale().cwiseProduct(mesh.vertices[corner].head<3>()))) return false;
  }
  const double twice_area = face_normal(mesh, face).norm();
  const double edge = longest_edge(mesh, face);
  return std::isfinite(twice_area) && twice_area > kFlat * edge * edge;
}

std::uint64_t mixed(std::uint64_t x) {
  return Random(x).bits();
}

// A number that faces with the same corners share, in any order and either orientation.
std::uint64_t key_of(const Mesh& mesh, std::span<const std::uint32_t> face) {
  std::uint64_t sum = face.size();
  for (const std::uint32_t corner : face) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = mesh.vertices[corner][axis] + 0.0;  // -0 becomes 0
      hash = mixed(hash ^ std::bit_cast<std::uint64_t>(x));
    }
    sum += hash;
  }
  return sum;
}

// Leaves out faces without an area, and those that were there before.
void keep_faces(const Input& input, const Mesh& mesh, FaceSurvey& survey) {
  std::vector<std::pair<std::uint64_t, std::size_t>> keyed;
  for (std::size_t i = 0; i < mesh.ends.size(); ++i) {
    const auto face = mesh.face(i);
    if (has_area(input, mesh, face)) keyed.emplace_back(key_of(mesh, face), i);
  }
  survey.facts.dropped = mesh.ends.size() - keyed.size();
  std::ranges::sort(keyed);
  std::vector<std::uint8_t> used(mesh.ends.size());
  for (std::size_t k = 0; k < keyed.size(); ++k) {
    const bool repeated = k > 0 && keyed[k].first == keyed[k - 1].first;
    if (repeated) ++survey.facts.duplicates;
    used[keyed[k].second] = repeated ? 0 : 1;
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0) survey.used.push_back(i);
  }
}

FaceSurvey survey_faces(const Input& input, const Mesh& mesh) {
  FaceSurvey survey;
  keep_faces(input, mesh, survey);
  for (const std::size_t i : survey.used) {
    const auto face = mesh.face(i);
    survey.facts.triangles += face.size() - 2;
    const Vector3d twice = face_normal(mesh, face);
    survey.area += twice.norm() / 2;
    survey.samples += twice.cwiseAbs().maxCoeff() / 2;
    for (const std::uint32_t corner : face) survey.box.extend(mesh.vertices[corner].head<3>());
  }
  const bool open = input.unit.source == FileUnit::Source::assumed && !input.options.length;
  const bool guessed = open && !mesh.has_unit && !survey.used.empty();
  survey.unit = guessed ? likely_unit(survey.box) : input.unit;
  return survey;
}

// In the file's unit.
double fitting_spacing(const FaceSurvey& survey) {
  const double diagonal = survey.box.size().norm();
  const double wanted =
      std::clamp(diagonal / kAlongDiagonal, std::sqrt(survey.samples / kMostSamples),
                 std::sqrt(survey.samples / kFewestSamples));
  return std::max(wanted, diagonal / kFinest);
}

bool vertices_suffice(const Mesh& mesh, const FaceSurvey& survey) {
  const double spacing = std::sqrt(survey.area / static_cast<double>(mesh.vertices.size()));
  if (!(kScanned * spacing < survey.box.size().norm())) return false;
  const double longest = kLongEdge * std::max(spacing, fitting_spacing(survey));
  return std::ranges::all_of(survey.used, [&](std::size_t face) {
    return longest_edge(mesh, mesh.face(face)) <= longest;
  });
}

// The requested spacing, or a fitting one. In the file's unit.
double choose_spacing(const Input& input, const FaceSurvey& survey) {
  const double requested = input.options.mesh_spacing / survey.unit.plan;
  if (!(requested > 0)) return fitting_spacing(survey);
  const double least =
      std::max(std::sqrt(survey.samples / kMostAsked), survey.box.size().norm() / kFinestAsked);
  if (requested >= least) return requested;
  fail(input,
       fmt::format("faces sampled every {:.3g} m would be more than {} million points",
                   input.options.mesh_spacing, kMostAsked / 1e6),
       fmt::format("Give a spacing of {:.2g} m or more", 1.1 * survey.unit.plan * least));
}

void check_bounds(const Input& input, const FaceSampler& sampler, double most, double requested) {
  constexpr const char* kSimplify =
      "Simplify the mesh, or export the part that is to be felt alone";
  if (sampler.points_spent()) {
    fail(input,
         fmt::format("its faces cross themselves or lie on one another: more than {:.0f} million "
                     "points where their areas ask for {:.2g}",
                     most / 1e6, requested),
         kSimplify);
  }
  if (sampler.work_spent()) fail(input, "its faces have too many corners in a row", kSimplify);
}

// The file in the unit that its faces probably have.
CloudFile in_unit(const FaceSurvey& survey, CloudFile file) {
  const double factor = survey.unit.plan / file.unit.plan;
  if (factor != 1) rescale(file, factor);
  file.unit = survey.unit;
  return file;
}

CloudFile sample(const Input& input, const Mesh& mesh, FaceSurvey& survey, std::string format) {
  const double spacing = choose_spacing(input, survey);
  survey.facts.spacing = input.unit.plan * spacing;
  Columns columns = mesh.columns;
  columns.normals = true;
  const Lattice lattice(survey.box, spacing);
  CloudBuilder builder(input, columns, mesh.color_scale, lattice.room(survey.samples));
  const double requested = survey.samples / (spacing * spacing);
  const double most = kSurplus * std::max(requested, kMostSamples);
  FaceSampler sampler(
      mesh, lattice, builder,
      {most, kMostWork + kWorkPerCorner * static_cast<double>(mesh.corners.size())});
  Progress progress(input.options, survey.used.size());
  for (std::size_t i = 0; i < survey.used.size(); ++i) {
    sampler.add(mesh.face(survey.used[i]));
    check_bounds(input, sampler, most, requested);
    progress.at(i);
  }
  if (builder.size() == 0) {
    fail(input, "its faces are too thin or too scattered to be sampled",
         "Export the part that is to be felt alone");
  }
  CloudFile file = builder.finish(std::move(format));
  file.declared = mesh.vertices.size();
  file.mesh = survey.facts;
  return in_unit(survey, std::move(file));
}

void require_faces(const Input& input, const Mesh& mesh, const FaceSurvey& survey) {
  if (!survey.used.empty()) return;
  fail(input, fmt::format("none of the {} faces is finite and has an area", mesh.ends.size()),
       "Check how the file was generated, and its units and scale");
}

// The faces of use to who wants them instead of points.
CloudFile hand_over(const Input& input, const Mesh& mesh, const FaceSurvey& survey,
                    std::string format) {
  require_faces(input, mesh, survey);
  Mesh& wanted = *input.faces;
  wanted.vertices = mesh.vertices;
  for (const std::size_t i : survey.used) {
    for (const std::uint32_t corner : mesh.face(i)) wanted.add_corner(corner);
    wanted.close_face();
  }
  CloudFile file;
  file.format = std::move(format);
  file.mesh = survey.facts;
  file.unit = survey.unit;
  return file;
}

}  // namespace

MeshVertex mesh_vertex(const Row& row) {
  MeshVertex vertex;
  std::copy_n(row.begin(), 3, vertex.data());
  std::copy_n(row.begin() + index_of(Role::red), 4, vertex.data() + 3);
  return vertex;
}

void Mesh::add_triangle(std::size_t a, std::size_t b, std::size_t c) {
  for (const std::size_t vertex : {a, b, c}) add_corner(vertex);
  close_face();
}

std::span<const std::uint32_t> Mesh::face(std::size_t i) const {
  const std::size_t begin = i == 0 ? 0 : ends[i - 1];
  return std::span(corners).subspan(begin, ends[i] - begin);
}

CloudFile sample_faces(const Input& input, const Mesh& mesh, std::string format) {
  FaceSurvey survey = survey_faces(input, mesh);
  require_faces(input, mesh, survey);
  if (input.faces != nullptr) return hand_over(input, mesh, survey, std::move(format));
  return sample(input, mesh, survey, std::move(format));
}

CloudFile choose_cloud(const Input& input, const Mesh& mesh, CloudFile vertices) {
  if (mesh.ends.empty()) return vertices;
  FaceSurvey survey = survey_faces(input, mesh);
  if (input.faces != nullptr) return hand_over(input, mesh, survey, std::move(vertices.format));
  const bool requested = input.options.mesh_spacing > 0;
  if (!survey.used.empty() && (requested || !vertices_suffice(mesh, survey))) {
    return sample(input, mesh, survey, std::move(vertices.format));
  }
  vertices.mesh = survey.facts;
  return in_unit(survey, std::move(vertices));
}

}  // namespace palpate::io
