#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// Name of a choice on the command line, in set-up files, in Python and in reports. The table of an
/// enumeration that an option has is choices(Enumeration).
template <class Choice>
struct Named {
  const char* name;
  Choice choice;
};

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

}  // namespace palpate
