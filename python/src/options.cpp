// Reads keyword arguments into option structs.
#include "options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/eigen.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "gil.hpp"
#include "palpate/base/error.hpp"

namespace palpate::python {

bool Keywords::offer(const char* name) {
  if (std::ranges::find(offered_, name) == offered_.end()) offered_.emplace_back(name);
  return given_.contains(name);
}

void Keywords::refuse(const char* name) const {
  const auto given = py::repr(given_[name]).cast<std::string>();
  throw py::type_error(fmt::format("{}(): {} cannot be {}", function_, name, given));
}

void Keywords::refuse_choice(const char* name, const std::string& given,
                             const std::vector<std::string>& choices) {
  throw Error(
      fmt::format("{} cannot be '{}'; give one of: {}", name, given, fmt::join(choices, ", ")));
}

void Keywords::finish() const {
  for (const auto& [key, value] : given_) {
    const auto name = key.cast<std::string>();
    if (std::ranges::find(offered_, name) != offered_.end()) continue;
    throw py::type_error(fmt::format("{}() has no argument '{}'; these can be given: {}", function_,
                                     name, fmt::join(offered_, ", ")));
  }
}

bool Keywords::take(const char* name, std::optional<Box>& into) {
  std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> corners;
  const bool taken = take(name, corners);
  if (corners) into = Box{corners->first, corners->second};
  return taken;
}

bool Keywords::take(const char* name, std::optional<NoiseModel>& into) {
  std::variant<std::monostate, std::string, std::array<double, 3>> noise;
  const bool taken = take(name, noise);
  if (const auto* const sensor = std::get_if<std::string>(&noise)) into = sensor_noise(*sensor);
  if (const auto* const sigma = std::get_if<std::array<double, 3>>(&noise)) {
    into = NoiseModel{.coefficients = *sigma};
  }
  return taken;
}

void take(Keywords& keywords, PrepareOptions& options) {
  take<PrepareOptions>(keywords, options);
  options.progress = hearing();
}

void take(Keywords& keywords, FieldOptions& options) {
  keywords.take("kind", options.kind);
  bool paper = false;
  keywords.take("paper", paper);
  if (paper) options = paper_field(options.kind);
  take<FieldOptions>(keywords, options);
}

TypeWords choice_words(const std::vector<std::string>& names) {
  return {fmt::format("Literal['{}']", fmt::join(names, "', '")),
          fmt::format("({})", fmt::join(names, ", "))};
}

std::string listed(const std::vector<Keyword>& keywords) {
  std::string text;
  for (const Keyword& each : keywords) {
    text += text.empty() ? each.name : ", " + each.name;
    if (!each.unit.empty() && each.type.words.empty()) text += fmt::format(" ({})", each.unit);
    if (!each.type.words.empty()) text += " " + each.type.words;
  }
  return text;
}

namespace {

template <Described Options>
void put(py::dict& all, const char* name) {
  py::dict types;
  for (const Keyword& each : keywords_of<Options>()) types[each.name.c_str()] = each.type.stub;
  all[name] = types;
}

py::dict all_keywords() {
  py::dict all;
  put<PrepareOptions>(all, "PrepareOptions");
  put<PolicyOptions>(all, "PolicyOptions");
  put<DepthFilterOptions>(all, "DepthFilterOptions");
  put<FieldOptions>(all, "FieldOptions");
  put<ProxyOptions>(all, "ProxyOptions");
  put<GuardOptions>(all, "GuardOptions");
  return all;
}

}  // namespace

void define_keywords(py::module_& module) {
  module.def("_keywords", &all_keywords, "Keywords of each struct of options, with their types");
}

}  // namespace palpate::python
