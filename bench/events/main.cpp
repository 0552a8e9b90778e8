// Measures what a hand feels while things come, go, are hidden, move fast, are thin or end.
#include "events/event.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  CLI::App app("Streams in which things happen, in simulated time: medians, and worst in brackets",
               "events_bench");
  bench::SeedOptions options;
  bench::add_options(app, options);
  return bench::run_main(app, argc, argv, [&] {
    fmt::print("{}", bench::table_head("event | runs", events::columns()));
    bench::print_rows(
        events::all_rows(), options,
        [](const events::Event& event) { return events::score(event, events::play(event)); },
        [](const std::string& name, const std::vector<events::Score>& scores) {
          return bench::table_line(fmt::format("{} | {}", name, scores.size()), scores,
                                   events::columns());
        },
        [](const events::Score&) { return ""; });
    return 0;
  });
}
