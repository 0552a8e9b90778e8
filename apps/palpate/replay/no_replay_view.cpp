// Replaces replay_view.cpp where there is no viewer.
#include "apps/palpate/replay/replay_view.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

void view_recording(const std::string& /*path*/, const PagePlan& /*page*/) {
  throw Error("this build has no page; install libboost-dev and rebuild, or remove --view");
}

}  // namespace palpate::app
