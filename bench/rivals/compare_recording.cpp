// Plays methods on single frames of a real recording.
#include "rivals/compare.hpp"
#include "rivals/modes.hpp"
#include "rivals/view.hpp"

namespace palpate::rivals {

std::string markdown_recording(const accuracy::RecordedOptions& options,
                               const std::vector<Method>& methods) {
  std::vector<accuracy::Feeler> feelers;
  for (const Method& method : methods) {
    feelers.push_back({method.name, [&](DepthFrame frame) {
                         frame.T_world_sensor = Eigen::Isometry3d::Identity();
                         const View view(std::move(frame));
                         const std::shared_ptr<Rival> rival = method.make(method.scale);
                         rival->show(view.shown(method));
                         return [rival](const accuracy::Path& path) { return felt(*rival, path); };
                       }});
  }
  return accuracy::recorded_report(options, feelers);
}

}  // namespace palpate::rivals
