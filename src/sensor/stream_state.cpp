#include "palpate/sensor/stream_state.hpp"

namespace palpate {

std::string_view name_of(StreamPhase phase) noexcept {
  switch (phase) {
    case StreamPhase::starting:
      return "starting";
    case StreamPhase::running:
      return "running";
    case StreamPhase::stalled:
      return "stalled";
    case StreamPhase::failed:
      return "failed";
    case StreamPhase::ended:
      break;
  }
  return "ended";
}

}  // namespace palpate
