#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/field/field_options.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

/// Name of a choice on the command line, in set-up files and in reports.
template <class Choice>
struct Named {
  const char* name;
  Choice choice;
};

inline constexpr std::array<Named<Policy>, 4> kPolicies = {{{"replace", Policy::replace},
                                                            {"average", Policy::average},
                                                            {"crossfade", Policy::crossfade},
                                                            {"morph", Policy::morph}}};

inline constexpr std::array<Named<FieldOptions::Kind>, 3> kFields = {
    {{"balanced", FieldOptions::Kind::balanced},
     {"pointset", FieldOptions::Kind::pointset},
     {"metaball", FieldOptions::Kind::metaball}}};

inline constexpr std::array<Named<Kernel>, 2> kKernels = {
    {{"wyvill", Kernel::wyvill}, {"wendland", Kernel::wendland}}};

inline constexpr std::array<Named<FieldOptions::Gradient>, 3> kGradients = {
    {{"exact", FieldOptions::Gradient::exact},
     {"normal", FieldOptions::Gradient::normal},
     {"printed", FieldOptions::Gradient::printed}}};

/// The choice of that name, if there is one.
template <class Choice, std::size_t N>
[[nodiscard]] std::optional<Choice> choice_of(const std::array<Named<Choice>, N>& table,
                                              std::string_view name) {
  for (const Named<Choice>& each : table) {
    if (each.name == name) return each.choice;
  }
  return {};
}

/// The choice's name; every choice has one.
template <class Choice, std::size_t N>
[[nodiscard]] const char* name_in(const std::array<Named<Choice>, N>& table, Choice choice) {
  for (const Named<Choice>& each : table) {
    if (each.choice == choice) return each.name;
  }
  return "";
}

/// All of them, in the table's order.
template <class Choice, std::size_t N>
[[nodiscard]] std::vector<std::string> names_of(const std::array<Named<Choice>, N>& table) {
  std::vector<std::string> names;
  for (const Named<Choice>& each : table) names.emplace_back(each.name);
  return names;
}

}  // namespace palpate::app
