// Every column of surface points is checked: its length, its range, its indices.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>

#include "palpate/base/error.hpp"
#include "palpate/field/surface_points.hpp"
#include "support/all_columns.hpp"
#include "support/contains.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3f;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Spoiled {
  const char* column;  // that the error names
  std::function<void(SurfacePoints&)> spoil;
};

void PrintTo(const Spoiled& spoiled, std::ostream* out) {
  *out << spoiled.column;
}

class Column : public testing::TestWithParam<Spoiled> {};

TEST_P(Column, IsNamedWhereItIsWrong) {
  SurfacePoints points = all_columns();
  ASSERT_NO_THROW(check(points));
  GetParam().spoil(points);
  try {
    check(points);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), GetParam().column)) << error.what();
  }
}

using P = SurfacePoints;

INSTANTIATE_TEST_SUITE_P(
    Lengths, Column,
    testing::Values(Spoiled{"radii", [](P& p) { p.radii.pop_back(); }},
                    Spoiled{"density_weights", [](P& p) { p.density_weights.push_back(1); }},
                    Spoiled{"confidences", [](P& p) { p.confidences.clear(); }},
                    Spoiled{"normals", [](P& p) { p.normals.pop_back(); }},
                    Spoiled{"materials", [](P& p) { p.materials.pop_back(); }},
                    Spoiled{"presences", [](P& p) { p.presences.pop_back(); }},
                    Spoiled{"colors", [](P& p) { p.colors.resize(1); }},
                    Spoiled{"end_positions", [](P& p) { p.end_positions.pop_back(); }},
                    Spoiled{"end_normals", [](P& p) { p.end_normals.pop_back(); }},
                    Spoiled{"end_density_weights", [](P& p) { p.end_density_weights.pop_back(); }},
                    Spoiled{"end_radii", [](P& p) { p.end_radii.pop_back(); }},
                    Spoiled{"end_confidences", [](P& p) { p.end_confidences.pop_back(); }},
                    Spoiled{"end_presences", [](P& p) { p.end_presences.pop_back(); }},
                    Spoiled{"segments.segment", [](P& p) { p.segments.segment.pop_back(); }},
                    Spoiled{"segments.residual", [](P& p) { p.segments.residual.clear(); }},
                    Spoiled{"segments.residual", [](P& p) { p.segments.segment.clear(); }},
                    Spoiled{"segments.component",
                            [](P& p) {
                              p.segments = {};
                              p.segments.component = {0};
                            }},
                    Spoiled{"segments.known",
                            [](P& p) {
                              p.segments = {};
                              p.segments.known = {1};
                            }},
                    Spoiled{"edges.of_point", [](P& p) { p.edges.of_point.pop_back(); }},
                    Spoiled{"edges.end", [](P& p) { p.edges.end.resize(2); }},
                    Spoiled{"eye remembers",
                            [](P& p) { p.eye->remembered.resize(99, Vector3f::UnitZ()); }},
                    Spoiled{"cell_reach", [](P& p) { p.cell_reach.pop_back(); }}));

INSTANTIATE_TEST_SUITE_P(
    Indices, Column,
    testing::Values(Spoiled{"segments.segment[5]", [](P& p) { p.segments.segment[5] = 1u << 30; }},
                    Spoiled{"segments.segment[0]", [](P& p) { p.segments.segment[0] = 1; }},
                    Spoiled{"segments.component[0]", [](P& p) { p.segments.component[0] = 1; }},
                    Spoiled{"segments.component[0]", [](P& p) { p.segments.known.clear(); }},
                    Spoiled{"edges.of_point[2]", [](P& p) { p.edges.of_point[2] = 1; }}));

INSTANTIATE_TEST_SUITE_P(
    Ranges, Column,
    testing::Values(Spoiled{"radii[3]", [](P& p) { p.radii[3] = 0; }},
                    Spoiled{"radii[3]", [](P& p) { p.radii[3] = kNaN; }},
                    Spoiled{"density_weights[1]", [](P& p) { p.density_weights[1] = -1; }},
                    Spoiled{"confidences[0]", [](P& p) { p.confidences[0] = 2; }},
                    Spoiled{"normals[0]", [](P& p) { p.normals[0].x() = kInfinity; }},
                    Spoiled{"normals[0]", [](P& p) { p.normals[0] *= 1.01f; }},
                    Spoiled{"materials[2]", [](P& p) { p.materials[2] = 1.5f; }},
                    Spoiled{"presences[2]", [](P& p) { p.presences[2] = -0.5f; }},
                    Spoiled{"end_positions[4]", [](P& p) { p.end_positions[4].y() = kNaN; }},
                    Spoiled{"end_normals[4]", [](P& p) { p.end_normals[4] *= 0.5f; }},
                    Spoiled{"end_density_weights[0]",
                            [](P& p) { p.end_density_weights[0] = kInfinity; }},
                    Spoiled{"end_radii[0]", [](P& p) { p.end_radii[0] = -1; }},
                    Spoiled{"end_confidences[0]", [](P& p) { p.end_confidences[0] = kNaN; }},
                    Spoiled{"end_presences[0]", [](P& p) { p.end_presences[0] = 7; }},
                    Spoiled{"segments.residual[1]", [](P& p) { p.segments.residual[1] = kNaN; }},
                    Spoiled{"edges.start[0]", [](P& p) { p.edges.start[0].share = 2; }},
                    Spoiled{"edges.start[0]", [](P& p) { p.edges.start[0].normal *= 3; }},
                    Spoiled{"edges.end[0]", [](P& p) { p.edges.end[0].height = kNaN; }},
                    Spoiled{"eye's position", [](P& p) { p.eye->position.x() = NAN; }},
                    Spoiled{"eye.remembered[1]", [](P& p) { p.eye->remembered[1].setZero(); }},
                    Spoiled{"origin", [](P& p) { p.origin.z() = INFINITY; }},
                    Spoiled{"kernel", [](P& p) { p.kernel = static_cast<Kernel>(7); }}));

INSTANTIATE_TEST_SUITE_P(
    OfFinish, Column,
    testing::Values(Spoiled{"cell_reach[0]", [](P& p) { p.cell_reach[0] = kNaN; }},
                    Spoiled{"cell_reach[0]", [](P& p) { p.radii[7] *= 3; }},
                    Spoiled{"cell_reach[0]", [](P& p) { p.end_positions[7].x() += 0.1f; }},
                    Spoiled{"smallest_radius", [](P& p) { p.smallest_radius = 0; }},
                    Spoiled{"radius", [](P& p) { p.radius = NAN; }},
                    Spoiled{"grid[80]", [](P& p) {
                              std::vector<Vector3f> places(81, Vector3f(0, 0, 0));
                              places.back().x() = kNaN;
                              p.grid.rebuild(places, std::vector<std::uint32_t>(81, 0));
                            }}));

}  // namespace
}  // namespace palpate::test
