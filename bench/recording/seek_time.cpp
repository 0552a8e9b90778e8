// Measures how long it takes to show a moment of a recording, as palpate replay --view does: its
// steps, the forces before it, and the frames that cameras had then. In one thread, at moments of
// chance.
//
//   seek_time FILE.mcap [SEEKS]
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "session/played_run.hpp"

namespace palpate::app {
namespace {

void tell(const char* what, std::vector<double> seconds) {
  if (seconds.empty()) return;
  std::ranges::sort(seconds);
  fmt::print("{:8} p50 {:6.1f} ms, longest {:6.1f} ms\n", what, 1e3 * seconds[seconds.size() / 2],
             1e3 * seconds.back());
}

double megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void measure(const std::string& path, int seeks) {
  const SteadyClock clock;
  double begin = clock.now();
  const auto passed = [&] { return clock.now() - std::exchange(begin, clock.now()); };
  session::ShownRun run{bag::RandomFile(path)};
  fmt::print("{:.0f} s, {} hands, {} sources; opened in {:.0f} ms; {:.0f} MB at most\n",
             run.length(), run.hands.size(), run.sources.size(), 1e3 * passed(), megabytes());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moments(run.stretch.begin, run.stretch.end);
  std::vector<double> steps;
  std::vector<double> pasts;
  std::vector<double> frames;
  for (int i = 0; i < seeks; ++i) {
    const double moment = moments(random);
    passed();
    for (session::ShownHand& hand : run.hands) hand.seek(moment);
    steps.push_back(passed());
    for (session::ShownHand& hand : run.hands)
      (void)hand.past(session::PlayedRun::kPast, [] { return false; });
    pasts.push_back(passed());
    for (session::ShownSource& source : run.sources) {
      if (source.lives()) source.show(moment);
    }
    if (run.sources.front().lives()) frames.push_back(passed());
  }
  tell("steps", steps);
  tell("past", pasts);
  tell("frames", frames);
  fmt::print("{:.0f} MB at most\n", megabytes());
}

}  // namespace
}  // namespace palpate::app

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "seek_time FILE.mcap [SEEKS]\n");
    return 2;
  }
  try {
    palpate::app::measure(argv[1], argc > 2 ? std::atoi(argv[2]) : 50);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
