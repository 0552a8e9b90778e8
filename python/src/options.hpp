#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "contact/description.hpp"
#include "depth/description.hpp"
#include "field/description.hpp"
#include "prepare/description.hpp"
#include "scene/description.hpp"
#include "servo/description.hpp"

namespace palpate::python {

namespace py = pybind11;

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

  /// The same of a choice, by its name. @throws Error that lists them.
  template <class Choice>
  requires std::is_enum_v<Choice>
  bool take(const char* name, Choice& into) {
    std::string wanted;
    if (!take(name, wanted)) return false;
    const auto& table = choices(Choice());
    const std::optional<Choice> found = choice_of(table, wanted);
    if (!found) refuse_choice(name, wanted, names_of(table));
    into = *found;
    return true;
  }
  template <class Choice>
  requires std::is_enum_v<Choice>
  bool take(const char* name, std::optional<Choice>& into) {
    Choice choice{};
    const bool taken = take(name, choice);
    if (taken) into = choice;
    return taken;
  }
  /// (lower, upper), each (3,).
  bool take(const char* name, std::optional<Box>& into);
  /// The name of a sensor, or (s0, s1, s2).
  bool take(const char* name, std::optional<NoiseModel>& into);

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

/// Takes the keywords that stand for the members of a described struct.
template <Described Options>
void take(Keywords& keywords, Options& options) {
  each_option(options, [&](const std::string& name, const About& about, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (!std::is_same_v<Member, std::optional<CloudFacts>>) {
      if (about.offered != Offered::recordings) keywords.take(name.c_str(), member);
    }
  });
}
/// The same; what is prepared hears signals.
void take(Keywords& keywords, PrepareOptions& options);
/// The same, and `paper`: paper_field().
void take(Keywords& keywords, FieldOptions& options);

/// What Python says of a member's type: in stubs, and in docstrings where it has no unit.
struct TypeWords {
  std::string stub;
  std::string words = {};
};
[[nodiscard]] TypeWords choice_words(const std::vector<std::string>& names);
template <class Member>
[[nodiscard]] TypeWords type_words() {
  if constexpr (std::is_same_v<Member, std::optional<double>>) return {"float | None"};
  if constexpr (std::is_same_v<Member, double>) return {"float"};
  if constexpr (std::is_same_v<Member, bool>) return {"bool"};
  if constexpr (std::is_same_v<Member, int>) return {"int"};
  if constexpr (std::is_same_v<Member, std::optional<Eigen::Vector3d>>)
    return {"_Three | None", "(3,)"};
  if constexpr (std::is_same_v<Member, std::optional<Box>>)
    return {"tuple[_Three, _Three] | None", "(lower, upper)"};
  if constexpr (std::is_same_v<Member, std::optional<NoiseModel>>)
    return {"str | Sequence[float] | None", "(name of a sensor or (s0, s1, s2))"};
  if constexpr (std::is_enum_v<Member>) return choice_words(names_of(choices(Member())));
  if constexpr (std::is_same_v<Member, std::optional<Policy>>) return type_words<Policy>();
}

/// The keywords of a described struct: name and what is said of it, in its order.
struct Keyword {
  std::string name;
  std::string unit;
  TypeWords type;
};
template <Described Options>
[[nodiscard]] std::vector<Keyword> keywords_of() {
  std::vector<Keyword> keywords;
  Options options;
  each_option(options, [&](const std::string& name, const About& about, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    if (about.offered == Offered::recordings) return;
    if constexpr (!std::is_same_v<Member, std::optional<CloudFacts>>) {
      keywords.push_back({name, about.unit, type_words<Member>()});
    }
  });
  return keywords;
}

/// "policy (replace, average, crossfade, morph), history, silence (s)", for docstrings.
[[nodiscard]] std::string listed(const std::vector<Keyword>& keywords);

/// `_keywords()`, by which a test compares the stubs.
void define_keywords(py::module_& module);

}  // namespace palpate::python
