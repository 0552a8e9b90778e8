// A viewer with eight clients beside a servo at 1 kHz: what they see, and what they cost it.

#include <fmt/format.h>

#include "palpate/base/error.hpp"
#include "servo_cost/measured.hpp"
#include "servo_cost/paced_servo.hpp"
#include "servo_cost/rises.hpp"
#include "viewer/viewer_run.hpp"

namespace {

using namespace palpate;
using namespace palpate::viewer_bench;
using servo_cost::CostOptions;
using servo_cost::hand_over;
using servo_cost::Rises;

constexpr std::size_t kPoints = 300'000;  // judgement: about a depth frame of 640x480

void print_clients(const RunResult& run) {
  fmt::print("| client | points | all there after | MB/s | states | clouds | surfaces |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  int i = 0;
  for (const ClientReport& client : run.clients) {
    const auto rate = [&](std::uint64_t count) {
      return static_cast<double>(count) / client.seconds;
    };
    fmt::print("| {} | {} | {:.2f} s | {:.2f} | {:.1f} Hz | {:.1f} Hz | {:.1f} Hz |\n", ++i,
               client.points, client.seconds_to_them, 1e-6 * rate(client.bytes),
               rate(client.states), rate(client.clouds), rate(client.surfaces));
  }
  fmt::print("| {} | never reads: {} | | | | | |\n\n", kClients,
             run.counts.closed_silent > 0 ? "closed for its silence" : "still there at the end");
  fmt::print("{}\n\n", in_words(run.servo));
}

class Bench {
 public:
  explicit Bench(const CostOptions& options) : options_(options) { add_cloud(scene_, kPoints); }

  bool run() {
    if (options_.seconds > 0) {
      const Trajectory hand = hand_over(scene_, options_.seconds);
      fmt::print("a cloud that stands still:\n\n");
      print_clients(measure(hand, {.clients = true, .renewed = false}));
      fmt::print("the same cloud, anew ten times a second:\n\n");
      const RunResult renewed = measure(hand, {.clients = true, .renewed = true});
      print_clients(renewed);
      fmt::print("{}\n\n", in_words(renewed.servo.realtime));
    }
    return options_.pairs == 0 || compare();
  }

 private:
  RunResult measure(const Trajectory& hand, Beside beside) {
    return run_servo(scene_, hand, beside, clock_, options_.processor);
  }

  bool compare() {
    const Trajectory hand = hand_over(scene_, options_.pair_seconds);
    Rises still, renewed;
    for (int i = 0; i < options_.pairs; ++i) {
      add_pair(hand, false, still);
      add_pair(hand, true, renewed);
    }
    fmt::print("computing time of a step with eight clients, medians of {} interleaved runs:\n\n",
               still.pairs());
    fmt::print("{}\n{}\n{}\n", servo_cost::rises_head(),
               row_of(still, "nobody, the cloud stands still"),
               row_of(renewed, "nobody, the cloud comes anew ten times a second"));
    const bool met = still.met() && renewed.met();
    fmt::print("\nwaits for a lock: {}; targets (+10 %, +20 %; no wait): {}\n",
               still.lock_waits() + renewed.lock_waits(), met ? "met" : "MISSED");
    return met;
  }

  void add_pair(const Trajectory& hand, bool anew, Rises& rises) {
    const RunResult without = measure(hand, {.clients = false, .renewed = anew});
    const RunResult with = measure(hand, {.clients = true, .renewed = anew});
    rises.add(with.servo, without.servo);
  }

  CostOptions options_;
  SteadyClock clock_;
  Scene scene_;
};

}  // namespace

int main(int argc, char** argv) {
  return servo_cost::run_measured("viewer_bench",
                                  "A viewer with eight clients and the servo at 1 kHz", argc, argv,
                                  [](const CostOptions& options) { return Bench(options).run(); });
}
