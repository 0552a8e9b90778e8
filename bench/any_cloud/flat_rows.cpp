#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

void draw_noise(Draft& draft, double sigma, bool seen) {
  draft.noise = sigma;
  draft.clear += sigma;
  draft.sheet({-60, -60, 0}, 120 * Vector3d::UnitX(), 120 * Vector3d::UnitY());
  draft.truth = half_space(Vector3d::Zero(), Vector3d::UnitZ());
  if (seen) draft.viewpoint = Vector3d(0, 0, 1000);
  zig_zag(draft, 3, 30);
}

}  // namespace

void add_flat_rows(std::vector<Row>& rows) {
  for (const double sigma : {0.0, 0.5, 1.0, 1.5, 2.0}) {
    for (const bool seen : {false, true}) {
      rows.push_back({"noise", fmt::format("noise {:g}{}", sigma, seen ? " view" : ""),
                      [=](Draft& draft) { draw_noise(draft, sigma, seen); }});
    }
  }
}

}  // namespace palpate::any_cloud
