#pragma once

#include <ctime>

namespace palpate::app {

/// Computing time that the whole process has used, s: of all its threads, so that work which is
/// shared among them counts once and time in which others had the processor does not count.
[[nodiscard]] inline double computing_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace palpate::app
