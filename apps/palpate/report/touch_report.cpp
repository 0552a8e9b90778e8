#include "apps/palpate/report/touch_report.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/report/source_report.hpp"

namespace palpate::app {

void print_report(const TouchReport& report, std::FILE* out) {
  for (const TouchedSource& source : report.touched.sources) print_source(source, out);
  const bool alone = report.hands.size() == 1;
  for (const HandReport& each : report.hands) {
    print_hand(each, alone ? "touched" : each.hand.name, out);
  }
}

// What is of a hand stands beside what is of the run where there is one hand, else under "hands".
Json json_report(const TouchReport& report) {
  Json sources = Json::array();
  for (const TouchedSource& source : report.touched.sources) {
    sources.push_back(json_source(source));
  }
  Json json = {{"palpate", std::string(version())},
               {"sources", sources},
               {"preset", report.options.preset},
               {"field", name_in(kFields, report.field.kind)},
               {"stiffness_N_per_m", report.proxy.stiffness}};
  if (report.hands.size() == 1) {
    json.update(json_hand(report.hands.front()));
    return json;
  }
  for (const HandReport& each : report.hands) json["hands"].push_back(json_hand(each));
  return json;
}

}  // namespace palpate::app
