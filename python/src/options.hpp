#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/servo/guard.hpp"

namespace palpate::python {

namespace py = pybind11;

/// A choice of an option, by its name.
template <class Choice>
struct Named {
  const char* name;
  Choice choice;
};

/// Keyword arguments on their way into the library's option structs.
class Keywords {
 public:
  /// `function`: for messages.
  Keywords(const py::kwargs& given, std::string function)
      : given_(given), function_(std::move(function)) {}

  /// Puts the argument of that name, where it is given, into `into`. False: it is not given.
  /// @throws py::type_error when it is of another type.
  template <class Value>
  bool take(const char* name, Value& into) {
    if (!offer(name)) return false;
    try {
      into = given_[name].cast<Value>();
    } catch (const py::cast_error&) {
      refuse(name);
    }
    return true;
  }

  /// The same of a choice. @throws Error that lists them.
  template <class Choice>
  bool take(const char* name, Choice& into, std::initializer_list<Named<Choice>> choices) {
    std::string wanted;
    if (!take(name, wanted)) return false;
    const auto* const found = std::ranges::find(choices, wanted, &Named<Choice>::name);
    if (found != choices.end()) {
      into = found->choice;
      return true;
    }
    std::vector<std::string> names;
    for (const Named<Choice>& each : choices) names.emplace_back(each.name);
    refuse_choice(name, wanted, names);
  }

  /// @throws py::type_error for arguments that nobody took; lists those that could be.
  void finish() const;

 private:
  [[nodiscard]] bool offer(const char* name);
  [[noreturn]] void refuse(const char* name) const;
  [[noreturn]] static void refuse_choice(const char* name, const std::string& given,
                                         const std::vector<std::string>& choices);

  const py::kwargs& given_;
  std::string function_;
  std::vector<std::string> offered_;
};

/// Each takes the keywords that stand for the members of its struct.
void take(Keywords& keywords, PrepareOptions& options);
void take(Keywords& keywords, PolicyOptions& options);
void take(Keywords& keywords, DepthFilterOptions& options);
void take(Keywords& keywords, FieldOptions& options);
void take(Keywords& keywords, ProxyOptions& options);
void take(Keywords& keywords, GuardOptions& options);

}  // namespace palpate::python
