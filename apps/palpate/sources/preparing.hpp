#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "apps/palpate/cli/terminal.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate::app {

/// Reports that a cloud is prepared, and how far that is where it is known.
class Preparing {
 public:
  Preparing(const std::string& name, const PointCloud& cloud, bool on_demand,
            PrepareOptions& options) {
    const std::string what = fmt::format("preparing {} ({} points)", name, grouped(cloud.size()));
    if (on_demand || cloud.height > 1) {
      waiting_.emplace(what);  // neither blocks on demand nor images say how far they are
    } else {
      options.progress = progress_.emplace(what).updater();
    }
  }

 private:
  std::optional<Progress> progress_;
  std::optional<Waiting> waiting_;
};

}  // namespace palpate::app
