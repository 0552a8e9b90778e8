// Tells whether what Python pushes has stamps of the proxies' clock.
#include "pushed.hpp"

#include <fmt/format.h>

namespace palpate::python {
namespace {

// A surface that starts later than this is a mistake of clocks: fields take it for one, too, s.
constexpr double kMostAhead = 1;

}  // namespace

void Pushed::starts(double start, double end, double time) {
  start_ = start;
  end_ = end;
  gone_ = time > end;
}

std::string Pushed::problem_at(double time) const {
  if (!problem.empty()) return problem;
  const bool ahead = start_ - time > kMostAhead;
  if (!ahead && !gone_) return {};
  return fmt::format(
      "the newest surface is felt {} {:.6g} s, but proxies are at {:.6g} s: stamps are seconds on "
      "the clock of proxy.time. Give 1e-3 * stamp of milliseconds, stamp - first of time.time(), "
      "and a stamp wherever no servo runs",
      ahead ? "from" : "until", ahead ? start_ : end_, time);
}

}  // namespace palpate::python
