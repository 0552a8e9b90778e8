#pragma once

#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/named.hpp"

/// Options are described once: `describe(options, take)`, beside each struct, hands `take` the
/// description of each member, and the member. Checks, recordings, set-up files, the command line
/// and its help, and Python's keywords are made of that.
namespace palpate {

/// The numbers that an option may be.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;            ///< `least` and `most` themselves are refused
  const char* words = nullptr;  ///< as in "give a number above 0"; null: "1 to 7", by the bounds
  /// Infinity stands for this, as in "infinity for no limit"; null: it is refused.
  const char* infinity = nullptr;

  [[nodiscard]] bool contains(double value) const noexcept;
  [[nodiscard]] std::string text() const;  ///< the words
};

inline constexpr Range kPositive{.least = 0, .open = true, .words = "a number above 0"};
inline constexpr Range kNotNegative{.least = 0, .words = "a number of 0 or more"};
/// Above 0, or infinite: that stands for `infinity`.
[[nodiscard]] constexpr Range positive_or(const char* infinity) {
  Range range = kPositive;
  range.infinity = infinity;
  return range;
}

/// Who can set an option. Each entry adds to those before it.
enum class Offered {
  recordings,  ///< the library alone; recordings keep it
  python,      ///< Python, too
  files,       ///< set-up files, too
  everywhere,  ///< the command line, too
};

/// The description of one option, in this order.
struct About {
  const char* name;       ///< the member's, in recordings, Python and set-up files
  const char* unit = "";  ///< "m"
  Range range = {};       ///< of a number
  const char* help = "";  ///< of the command line, or of docs/setup.md for keys of files alone
  Offered offered = Offered::everywhere;
  const char* value = "";  ///< stands for a value without a unit in help: "N"
};

/// `Options`, const or not.
template <class Options, class Struct>
concept EitherConst = std::same_as<std::remove_const_t<Options>, Struct>;

struct TakesNothing {
  void operator()(const About& /*about*/, auto& /*member*/) const {}
};
/// A struct of options with a describe().
template <class Options>
concept Described = requires(Options& options) {
  describe(options, TakesNothing());
};

/// Calls take(key, about, member) for each option, also those of parts: "friction_static".
template <class Options, class Take>
void each_option(Options& options, const Take& take, const std::string& part = {}) {
  describe(options, [&](const About& about, auto& member) {
    if constexpr (Described<std::remove_cvref_t<decltype(member)>>) {
      each_option(member, take, part + about.name + "_");
    } else {
      take(part + about.name, about, member);
    }
  });
}

/// The description of one option, and its key.
struct KeyedAbout {
  std::string key;
  About about;
};

/// The description of a member of `options`, or of a part of it.
template <class Options, class Member>
[[nodiscard]] KeyedAbout described(const Options& options, const Member& member) {
  std::optional<KeyedAbout> found;
  each_option(options, [&](const std::string& key, const About& about, const auto& each) {
    if constexpr (std::is_same_v<decltype(each), const Member&>) {
      if (&each == &member) found = {key, about};
    }
  });
  return found.value();
}

/// @throws Error, such as "guard: slew (N/s) is -1; give a number above 0", unless the range
/// contains `value`.
void check_number(std::string_view what, const std::string& name, const About& about, double value);

/// @throws Error that lists the names of what can be chosen.
[[noreturn]] void refuse_choice(std::string_view what, const std::string& name,
                                const std::vector<std::string>& names);

template <class Value>
struct IsOptional : std::false_type {};
template <class Value>
struct IsOptional<std::optional<Value>> : std::true_type {};

/// Checks one option; what is neither a number nor a choice passes.
template <class Value>
void check_option(std::string_view what, const std::string& name, const About& about,
                  const Value& value) {
  if constexpr (IsOptional<Value>::value) {
    if (value) check_option(what, name, about, *value);
  } else if constexpr (std::is_enum_v<Value>) {
    const auto& table = choices(Value());
    if (*name_in(table, value) == '\0') refuse_choice(what, name, names_of(table));
  } else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
    check_number(what, name, about, value);
  }
}

/// Checks all numbers and choices of `options`, those of parts as "passivity.mass"; `what` begins
/// the message. What options have to do with each other is not checked.
/// @throws Error that names the wrong one and what to give.
template <class Options>
void check_described(std::string_view what, const Options& options, const std::string& part = {}) {
  describe(options, [&](const About& about, const auto& member) {
    if constexpr (Described<const std::remove_cvref_t<decltype(member)>>) {
      check_described(what, member, part + about.name + ".");
    } else {
      check_option(what, part + about.name, about, member);
    }
  });
}

}  // namespace palpate
