#pragma once

#include <string>
#include <thread>

namespace palpate::app {

/// Says on standard error that something is under way whose progress nobody knows, once it has
/// taken a while: half a second on a terminal, where the line vanishes at the end, else two.
class Waiting {
 public:
  explicit Waiting(std::string what);

 private:
  std::jthread thread_;  // joins at the end of the work
};

}  // namespace palpate::app
