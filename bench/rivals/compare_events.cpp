// Plays methods on depth streams in which things come, go, are hidden or end.
#include "events/event.hpp"
#include "rivals/method_table.hpp"
#include "rivals/modes.hpp"
#include "rivals/play_stream.hpp"

namespace palpate::rivals {
namespace {

events::Felt felt_of(const std::vector<Step>& steps) {
  events::Felt felt;
  for (const Step& step : steps) {
    felt.force.push_back(step.force);
    felt.proxy.push_back(step.proxy);
    felt.touching.push_back(step.touching);
  }
  return felt;
}

}  // namespace

void print_events(const bench::SeedOptions& options, const std::vector<Method>& methods) {
  std::vector<std::string> names = {"ours"};
  for (const Method& method : methods) names.emplace_back(method.name);
  const auto play = [&](const events::Event& event) {
    std::vector<events::Score> scores = {events::score(event, events::play(event))};
    const Played played = play_stream(
        {.scene = event.scene, .camera = event.camera, .hip = event.hip, .fault = event.fault},
        methods);
    for (const auto& steps : played.steps) scores.push_back(events::score(event, felt_of(steps)));
    return scores;
  };
  bench::print_rows(
      events::all_rows(), options, play,
      [&](const std::string& name, const std::vector<std::vector<events::Score>>& seeds) {
        return method_table(name, names, seeds, events::columns());
      },
      [](const std::vector<events::Score>&) { return ""; });
}

}  // namespace palpate::rivals
