#pragma once

#include <string>
#include <vector>

#include "accuracy/path.hpp"
#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {

/// A row of table A: its paths are scored together.
struct Row {
  std::string name;
  std::vector<Path> paths;
};

/// The paths of table A, in this order: plane slide, light slide, sphere slide, box edge,
/// fast tap, thin push, static press, crease 10 mm, and three at the edge of the cloud (off it,
/// from behind, around).
[[nodiscard]] std::vector<Row> make_rows(const TruthScene& scene);

}  // namespace palpate::accuracy
