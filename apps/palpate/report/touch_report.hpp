#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "apps/palpate/report/hand_report.hpp"
#include "apps/palpate/sources/touched.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {

/// Everything that a run's report tells.
struct TouchReport {
  const Touched& touched;
  const Scene& felt;   ///< as the run left it
  bool paper = false;  ///< the preset paper
  FieldOptions field;
  ProxyOptions proxy;
  std::vector<HandReport> hands;
};

/// For a person.
void print_report(const TouchReport& report, std::FILE* stream);

/// The same as data: SI units, named in the keys. What is of a hand is in `hands`, where there are
/// several.
[[nodiscard]] nlohmann::ordered_json json_report(const TouchReport& report);

}  // namespace palpate::app
