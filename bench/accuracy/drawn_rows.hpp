#pragma once

#include <cstdint>

#include "accuracy/rows.hpp"

namespace palpate::accuracy {

/// The rows of make_rows() and "crease 3 mm" with paths that are drawn, too; all that they score is
/// seen by the camera. Slides, taps and the press are anywhere on free table in the middle of the
/// scene; arcs on the sphere have their middle 20 to 70 degrees above the horizontal and are seen
/// at 75 degrees from the normal at most; edges of the box, the upper one in front and the upright
/// one between two faces that are seen at up to 75 degrees, are crossed up to 30 degrees off the
/// perpendicular.
/// @throws palpate::Error when none of very many draws of a path is so.
[[nodiscard]] std::vector<Row> draw_rows(const TruthScene& scene, std::uint64_t number);

}  // namespace palpate::accuracy
