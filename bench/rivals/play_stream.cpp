// Plays methods on the frames of a simulated camera.
#include "rivals/play_stream.hpp"

#include <memory>
#include <optional>

#include "accuracy/path.hpp"
#include "palpate/sensor/stream.hpp"
#include "rivals/view.hpp"

namespace palpate::rivals {
namespace {

constexpr double kLead = 0.002;  // s, from publishing to the start of a surface; as table B has it

// The newest frame, and when it is to be felt.
struct Waiting {
  DepthFrame frame;
  double start = 0;
};

}  // namespace

Played play_stream(const Streamed& streamed, const std::vector<Method>& methods) {
  Played played;
  played.steps.resize(methods.size());
  std::vector<std::unique_ptr<Rival>> rivals;
  for (const Method& method : methods) rivals.push_back(method.make(method.scale));
  SimulatedCamera camera(streamed.scene, streamed.camera);
  std::optional<Waiting> waiting;
  SimulatedStream stream(camera, "camera",
                         [&](DepthFrame frame, const Source::StartTime& start) {
                           if (streamed.fault && !streamed.fault(frame)) return;
                           waiting = {std::move(frame), start()};
                         },
                         {.latency = streamed.latency, .lead = kLead});
  double spacing = 0;
  for (std::size_t i = 0; i < streamed.hip.size(); ++i) {
    const double now = static_cast<double>(i) * accuracy::kTick;
    const Eigen::Vector3d& hip = streamed.hip[i];
    stream.advance(now);
    if (waiting && waiting->start <= now + 1e-9) {
      const View view(std::move(waiting->frame), spacing);
      for (std::size_t k = 0; k < methods.size(); ++k) {
        rivals[k]->show(view.shown(methods[k]));
        if (played.swaps.empty()) rivals[k]->reset(hip);
      }
      spacing = view.spacing;
      waiting.reset();
      played.swaps.push_back(i);
    }
    for (std::size_t k = 0; k < methods.size(); ++k) {
      played.steps[k].push_back(played.swaps.empty() ? spring(hip, hip) : rivals[k]->step(hip));
    }
  }
  return played;
}

}  // namespace palpate::rivals
