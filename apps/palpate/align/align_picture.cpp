#include <nlohmann/json.hpp>

#include "apps/palpate/align/align_command.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"

namespace palpate::app {

void draw_alignment(const LoadedScene& loaded, const std::vector<AlignedSource>& aligned,
                    const std::string& path, OutputFile& picture) {
  constexpr std::size_t kShown = 60'000;  // points of a source
  const Waiting waiting("drawing the picture");
  nlohmann::json facts = {{"sources", nlohmann::json::array()}};
  std::vector<float> rows;  // place before, place after, normal after, source
  for (std::size_t s = 0; s < aligned.size(); ++s) {
    const SurfacePoints& points = *loaded.scene.source(s).points();
    const Eigen::Isometry3f moved = aligned[s].T_aligned_rough.cast<float>();
    const std::size_t stride = 1 + points.size() / kShown;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const Eigen::Vector3f p = points.origin.cast<float>() + points.grid.points()[i];
      const Eigen::Vector3f q = moved * p;
      const Eigen::Vector3f n = moved.linear() * points.normals[i];
      rows.insert(rows.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), n.x(), n.y(), n.z(),
                               static_cast<float>(s)});
    }
    facts["sources"].push_back({{"name", loaded.sources[s].plan.argument.name},
                                {"before_m", aligned[s].before.residual},
                                {"after_m", aligned[s].after.residual},
                                {"radius_m", points.radius}});
  }
  draw_by_python(align_script(), {{"cloud.f32", float_bytes(rows)}, {"facts.json", facts.dump()}},
                 path, picture);
}

}  // namespace palpate::app
