// Turns facts into lines for a person and into data.
#include "apps/palpate/report/report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {

namespace {

// How numbers with that end of a key are shown. The first that fits counts, so "_N_per_m" is before
// "_m".
struct UnitWords {
  std::string_view end;
  std::string (*words)(double value);
};

constexpr std::array kUnitWords = {
    UnitWords{"_N_per_m", [](double x) { return fmt::format("{:.4g} N/m", x); }},
    UnitWords{"_N_per_s", [](double x) { return fmt::format("{:.3g} N/s", x); }},
    UnitWords{"_Nm_per_rad", [](double x) { return fmt::format("{:.3g} N m/rad", x); }},
    UnitWords{"_Nm", [](double x) { return fmt::format("{:.3g} N m", x); }},
    UnitWords{"_N", [](double x) { return fmt::format("{:.3g} N", x); }},
    UnitWords{"_J", energy},
    UnitWords{"_Hz", [](double x) { return fmt::format("{:.4g} Hz", x); }},
    UnitWords{"_hz", [](double x) { return fmt::format("{:.4g} a second", x); }},
    UnitWords{"_px", [](double x) { return fmt::format("{:.4g} px", x); }},
    UnitWords{"_us", [](double x) { return fmt::format("{:.1f} us", x); }},
    UnitWords{"_ms", [](double x) { return duration(1e-3 * x); }},
    UnitWords{"_s", duration},
    UnitWords{"seconds", duration},
    UnitWords{"_m", length},
    UnitWords{"_deg", [](double x) { return fmt::format("{:.3g} degrees", x); }},
    UnitWords{"_share", [](double x) { return fmt::format("{:.3g} %", 100 * x); }},
    UnitWords{"overlap", [](double x) { return fmt::format("{:.3g} %", 100 * x); }},
    UnitWords{"width", [](double x) { return fmt::format("{}", x); }},
    UnitWords{"height", [](double x) { return fmt::format("{}", x); }},
};

// The unit may be that of an object that the value is in: "late_s/p50".
const UnitWords* unit_of(std::string_view key) {
  for (const UnitWords& unit : kUnitWords) {
    if (key.ends_with(unit.end)) return &unit;
  }
  const std::size_t slash = key.rfind('/');
  return slash == std::string_view::npos ? nullptr : unit_of(key.substr(0, slash));
}

std::string in_words(std::string_view key, const Json& value) {
  if (value.is_null()) return "none";
  if (value.is_boolean()) return "";  // decides whether its bracket is shown
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array()) {
    std::string text;
    for (const Json& each : value) text += (text.empty() ? "" : ", ") + in_words(key, each);
    return text;
  }
  if (const UnitWords* const unit = unit_of(key)) return unit->words(value.get<double>());
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return grouped(value.get<std::size_t>());
}

bool is_datum(std::string_view key) {
  return !key.empty() && key != "?" && key.front() != '_';
}

bool is_nothing(const Json& value) {
  return value.is_null() || value == 0 || value == false || value == "";
}

Json::json_pointer pointer_to(std::string_view path) {
  return Json::json_pointer("/" + std::string(path));
}

}  // namespace

Json& Report::list_at(const char* path) {
  Json& list = data[pointer_to(path)];
  if (list.is_null()) list = Json::array();
  return list;
}

void Report::write(Json& object, const Label& label, std::string_view pattern,
                   std::vector<Json> values) {
  constexpr std::size_t kNone = std::string::npos;
  std::string text;
  std::size_t begin = 0;     // of the bracket, in `text`
  std::size_t kept = kNone;  // end of the bracket's text that stands before an alternative
  bool decided = true;       // by the bracket's first value
  bool left_out = false;
  auto value = values.begin();
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    if (c == '{') {
      const std::string_view key = pattern.substr(i + 1, pattern.find('}', i) - i - 1);
      if (value->is_number_float() && !std::isfinite(value->get<double>())) *value = Json();
      if (!std::exchange(decided, true)) left_out = is_nothing(*value);
      if (key != "?") text += in_words(key, *value);
      if (is_datum(key)) object[pointer_to(key)] = *value;
      ++value;
      i += key.size() + 1;
    } else if (c == '[') {
      begin = text.size();
      decided = false;
    } else if (c == '|') {
      if (left_out) text.resize(begin);
      if (!left_out) kept = text.size();
      left_out = false;
    } else if (c == ']') {
      text.resize(kept != kNone ? kept : left_out ? begin : text.size());
      kept = kNone;
      left_out = false;
    } else {
      text += c;
    }
  }
  if (!text.empty()) note(label, std::move(text));
}

void Report::print(std::FILE* out) {
  const Style style(out);
  if (!printed_) {
    fmt::print(out, "{}{}{}\n", style.heading(without_controls(title_)), rest_.empty() ? "" : " ",
               without_controls(rest_));
  }
  for (std::size_t i = printed_.value_or(0); i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    std::string label = fmt::format("{:<10}", line.label.text);
    if (line.label.mark == Mark::warning) label = style.warning(label);
    if (line.label.mark == Mark::error) label = style.error(label);
    fmt::print(out, "  {} {}\n", label, without_controls(line.text));
  }
  printed_ = lines_.size();
  std::fflush(out);
}

}  // namespace palpate::app
