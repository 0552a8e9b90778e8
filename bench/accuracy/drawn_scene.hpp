#pragma once

#include <cstdint>

#include "accuracy/rows.hpp"
#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {

/// A scene by the definitions of SimulatedTable in which all else is drawn, so that nothing can be
/// tuned to it: the number is the seed. The camera is 0.6 to 0.8 m from the table, looks down 20 to
/// 40 degrees and rolls by up to 5; the wall is 0.45 to 0.7 m behind the middle of the table; the
/// sphere has a radius of 40 to 80 mm, the other sizes are within 25 % of those of the fixed
/// layouts; the box is turned by up to 45 degrees. All objects lie in the image, clear of one
/// another and of one another's shadows, and 0.12 m round slide_center are as clear of them.
/// @throws palpate::Error when none of very many draws is so.
[[nodiscard]] TruthScene draw_truth_scene(std::uint64_t number);

/// Are the table between two places and 25 mm about it seen, and clear of all objects?
[[nodiscard]] bool is_free_table(const TruthScene& scene, const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& to);

/// The rows of make_rows() and "crease 3 mm" with paths that are drawn, too; all that they score is
/// seen by the camera. Slides, taps and the press are anywhere on free table in the middle of the
/// scene; arcs on the sphere have their middle 20 to 70 degrees above the horizontal and are seen
/// at 75 degrees from the normal at most; edges of the box, the upper one in front and the upright
/// one between two faces that are seen at up to 75 degrees, are crossed up to 30 degrees off the
/// perpendicular.
/// @throws palpate::Error when none of very many draws of a path is so.
[[nodiscard]] std::vector<Row> draw_rows(const TruthScene& scene, std::uint64_t number);

}  // namespace palpate::accuracy
