#pragma once

#include <string>
#include <vector>

namespace palpate::app::doctor {

/// How much a finding stands in the way, from nothing on.
enum class Severity {
  good,
  note,     ///< something is absent that not everybody needs
  warning,  ///< it works, but perhaps late or not for every program
  problem,  ///< something that is there does not work
};

/// What one check found.
struct Finding {
  std::string area;       ///< "kernel"
  std::string looked_at;  ///< "clock source"
  Severity severity = Severity::good;
  std::string words = {};               ///< what was found and what that means
  std::string remedy = {};              ///< the command that mends it; empty where all is good
  std::vector<std::string> lines = {};  ///< more to look at, such as a histogram
};

using Findings = std::vector<Finding>;

/// The worst of them; good when there are none.
[[nodiscard]] Severity worst(const Findings& findings);

}  // namespace palpate::app::doctor
