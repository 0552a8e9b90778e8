// Where a viewer listens, and what of it others get to see.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <set>

#include "palpate/base/error.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate {
namespace {

using test::RawClient;
using test::ViewerRig;

/// Of this process, those that a program which it starts would have, too.
std::set<int> inherited() {
  std::set<int> found;
  for (int file = 0; file < 1024; ++file) {
    const int flags = ::fcntl(file, F_GETFD);
    if (flags >= 0 && (flags & FD_CLOEXEC) == 0) found.insert(file);
  }
  return found;
}

TEST(Serving, NoProgramThatIsStartedInheritsItsSockets) {
  const std::set<int> before = inherited();
  ViewerRig rig;
  const auto client = rig.enter();
  RawClient idle(rig.viewer->port());
  rig.wait([](const ViewerCounts& counts) { return counts.connections == 2; });
  EXPECT_EQ(inherited(), before);
}

}  // namespace
}  // namespace palpate
