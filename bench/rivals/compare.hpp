#pragma once

#include <string>
#include <vector>

#include "accuracy/bench_run.hpp"
#include "rivals/rival.hpp"

/// All methods on the drawn scenes of table A, under its scores.
namespace palpate::rivals {

struct CompareOptions {
  std::vector<Method> methods;
  accuracy::BenchOptions bench;  ///< layouts, seeds and noise
  int threads = 2;               ///< layouts at a time; results do not depend on it
};

/// Computing times of a method in one frame. They differ from run to run.
struct Times {
  std::string method;
  double show = 0;  ///< ms
  double p50 = 0;   ///< of a step, us
  double p99 = 0;
};

struct Compared {
  accuracy::BenchResults scores;  ///< `contender` is the method's name
  std::vector<Times> times;
};

[[nodiscard]] Compared compare(const CompareOptions& options);

/// The method's forces along a path.
[[nodiscard]] accuracy::Trace felt(Rival& rival, const accuracy::Path& path);

}  // namespace palpate::rivals
