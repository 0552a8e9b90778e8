#include "apps/palpate/info/trust_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kShownPoints = 100'000;

}  // namespace

void TrustPicture::take(const std::string& name, const Prepared& prepared, const Box& box) {
  const SurfacePoints& points = prepared.points;
  const std::size_t kept = std::min(points.size(), kShownPoints);
  for (std::size_t k = 0; k < kept; ++k) {
    const std::size_t i = k * points.size() / kept;
    const Eigen::Vector3d world = points.origin + points.grid.points()[i].cast<double>();
    if (points.density_weights[i] <= 0 || !box.contains(world)) continue;
    const Eigen::Vector3f p = (world - box.center()).cast<float>();
    const Eigen::Vector3f& n = points.normals[i];
    rows_.insert(rows_.end(), {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), points.confidences[i]});
  }
  const Eigen::Vector3d middle = box.center();
  const double share = 100 * prepared.report.untrusted;
  const std::string thinned =
      kept < points.size() ? fmt::format("; thinned to {} points", grouped(kept)) : "";
  const nlohmann::json facts = {
      {"title", fmt::format("{:.3g} % of {} is not trusted", share, name)},
      {"subtitle", "felt as metaball where trust is below 0.5" + thinned},
      {"middle", {middle.x(), middle.y(), middle.z()}}};
  facts_ = facts.dump();
}

void TrustPicture::draw() {
  const Waiting waiting("drawing the picture");
  draw_by_python(trust_script(), {{"cloud.f32", float_bytes(rows_)}, {"facts.json", facts_}}, path_,
                 file_);
}

}  // namespace palpate::app
