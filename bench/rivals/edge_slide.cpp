// Writes what is felt along one slide over the edge of a box.
#include "rivals/edge_slide.hpp"

#include <fmt/format.h>

#include "accuracy/drawn_scene.hpp"
#include "palpate/base/error.hpp"
#include "rivals/view.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

void add(std::string& text, const char* name, const accuracy::Path& path,
         const accuracy::Trace& trace) {
  for (std::size_t i = path.begin; i < path.end; ++i) {
    const Vector3d& force = trace.force[i];
    text += fmt::format("{},{:.3f},{:.5f},{:.5f}\n", name,
                        static_cast<double>(i - path.begin) * accuracy::kTick, force.z(),
                        force.head<2>().norm());
  }
}

}  // namespace

std::string edge_slide_csv(CompareOptions options) {
  options.bench.noise = NoiseKind::independent;
  const std::uint64_t layout = options.bench.first_layout;
  const accuracy::TruthScene truth = accuracy::draw_truth_scene(layout);
  for (const accuracy::Row& row : accuracy::draw_rows(truth, layout)) {
    if (row.name != "box edge") continue;
    const accuracy::Path& path = row.paths.front();  // from the top's front edge off it
    std::string text = "method,t_s,normal_N,tangential_N\n";
    add(text, "truth", path, accuracy::ideal_trace(truth, path));
    const View view(truth, accuracy::exact_frame(truth),
                    noise_of(options.bench, layout, options.bench.first_seed));
    for (const Method& method : options.methods) {
      const std::unique_ptr<Rival> rival = method.make(method.scale);
      rival->show(view.shown(method));
      add(text, method.name, path, felt(*rival, path));
    }
    return text;
  }
  throw Error("the drawn scene has no box edge; take another --first-layout");
}

}  // namespace palpate::rivals
