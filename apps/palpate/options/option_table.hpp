// Registers options. CLI11 takes a compiler seconds: headers that name OptionTable alone declare
// it.
#pragma once

#include <CLI/CLI.hpp>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/options/run_facts.hpp"
#include "base/description.hpp"

namespace palpate::app {

/// What a key of a set-up file holds.
enum class KeyKind {
  text,
  texts,
  path,
  mesh_or_text,
  number,
  integer,
  flag,
  numbers,
  numbers_or_text
};

/// One option, and the key of a set-up file that means the same.
struct Registration {
  std::string name;          ///< "--tool-radius"; its key is tool_radius
  std::string section;       ///< of a set-up file; empty: it is on command lines alone
  bool each_source = false;  ///< it may stand in every [[source]], too
  KeyKind kind = KeyKind::text;
  CLI::Option* option = nullptr;  ///< takes and checks its text
  std::vector<Scope> scopes = {};

  /// Refuses it where `scope` does not apply.
  Registration& only_for(const Scope& scope) {
    scopes.push_back(scope);
    return *this;
  }
  /// The key in a set-up file: "tool_radius".
  [[nodiscard]] std::string key() const;
};

/// What an optional holds, and anything else itself.
template <class Value>
struct HeldBy {
  using type = Value;
};
template <class Value>
struct HeldBy<std::optional<Value>> {
  using type = Value;
};

/// "--soft-start" of the key soft_start.
[[nodiscard]] std::string option_name(std::string key);

/// What stands for the value of a described option in help: "SECONDS".
[[nodiscard]] std::string type_of(const About& about);

/// The check of a number of that range.
[[nodiscard]] CLI::Validator check_of(const Range& range, bool whole);

/// The options of a command line and the keys of a set-up file, each registered once: name, where
/// it stands, type, check, help, scope, and the variable that it sets. Variables outlive the
/// table. docs/architecture.md and CONTRIBUTING.md explain how to add one.
class OptionTable {
 public:
  /// Command line options are added to `command`, which outlives the table.
  explicit OptionTable(CLI::App& command) : command_(command) {}

  /// What is added next stands under `heading` in the help, and in [section] of set-up files; with
  /// `each_source` in every [[source]] as well.
  void under(std::string heading, std::string section = {}, bool each_source = false);

  /// Arguments of the command line that are no options.
  void add_positional(const std::string& name, std::vector<std::string>& values,
                      const std::string& type, const std::string& help) {
    command_.add_option(name, values, wrapped(help))->type_name(type);
  }

  /// An option with a value: a number, or text that stays text, such as a path.
  template <class Value>
  Registration& add(const std::string& name, Value& value, const std::string& type,
                    const CLI::Validator& check, const std::string& help) {
    CLI::Option* const option = command_.add_option(name, value, wrapped(help));
    return shown(name, kind_of<Value>(), option->check(check), type);
  }
  template <class Value>
  Registration& add(const std::string& name, Value& value, const std::string& type,
                    const std::string& help) {
    return add(name, value, type, CLI::Validator(), help);
  }

  /// One of described options: its description sets name, type, check and help, and whether
  /// set-up files alone have it. `check` holds instead of its range.
  template <class Value>
  Registration& add(const KeyedAbout& option, Value& value, const CLI::Validator& check) {
    const About& about = option.about;
    const std::string name = option_name(option.key);
    if (about.offered == Offered::files) return add_key(name, value, check);
    return add(name, value, type_of(about), check, about.help);
  }
  template <class Value>
  Registration& add(const KeyedAbout& option, Value& value) {
    const About& about = option.about;
    const std::string name = option_name(option.key);
    using Held = typename HeldBy<Value>::type;
    if constexpr (std::is_same_v<Held, bool>) {
      return about.offered == Offered::files ? add_key(name, value)
                                             : add_flag(name, value, about.help);
    } else if constexpr (std::is_enum_v<Held>) {
      return add_choice(name, value, choices(Held()), about.help);
    } else {
      return add(option, value, check_of(about.range, std::is_integral_v<Held>));
    }
  }
  template <class Options, class Member>
  Registration& add(const Options& options, Member& member) requires Described<const Options> {
    return add(described(options, member), member);
  }

  /// One without a value.
  Registration& add_flag(const std::string& name, bool& value, const std::string& help);

  /// One of the names of `table`.
  template <class Value, class Table>
  Registration& add_choice(const std::string& name, Value& value, const Table& table,
                           const std::string& help) {
    const auto take = [&value, &table](const std::string& text) {
      value = *choice_of(table, text);
    };
    CLI::Option* const option =
        command_.add_option_function<std::string>(name, take, wrapped(help));
    return shown(name, KeyKind::text, option->check(one_of(names_of(table))), "NAME");
  }

  /// Text that `take` makes something of. It throws UsageError where it cannot.
  Registration& add_text(const std::string& name, KeyKind kind, const std::string& type,
                         std::function<void(const std::string&)> take, const std::string& help);

  /// One that may be repeated: `take` is called with each.
  Registration& add_texts(const std::string& name, KeyKind kind, const std::string& type,
                          std::function<void(const std::string&)> take, const std::string& help);

  /// A key that set-up files alone have.
  template <class Value>
  Registration& add_key(const std::string& name, Value& value, const CLI::Validator& check) {
    return registered(name, kind_of<Value>(), keys_.add_option(name, value)->check(check));
  }
  Registration& add_key(const std::string& name, const std::function<void(const double&)>& take,
                        const CLI::Validator& check) {
    return registered(name, KeyKind::number,
                      keys_.add_option_function<double>(name, take)->check(check));
  }
  Registration& add_key(const std::string& name, bool& value) {
    return registered(name, KeyKind::flag, keys_.add_flag(name, value));
  }

  /// The key of that part of a set-up file, "source" for a [[source]]; null: there is none.
  [[nodiscard]] const Registration* find(std::string_view section, std::string_view key) const;

  [[nodiscard]] const std::deque<Registration>& all() const { return all_; }

 private:
  template <class Value>
  static constexpr KeyKind kind_of() {
    if constexpr (requires { typename Value::value_type; } && !std::is_same_v<Value, std::string>) {
      return kind_of<typename Value::value_type>();  // of an optional
    } else if constexpr (std::is_floating_point_v<Value>) {
      return KeyKind::number;
    } else {
      return std::is_integral_v<Value> ? KeyKind::integer : KeyKind::path;
    }
  }
  Registration& registered(const std::string& name, KeyKind kind, CLI::Option* option);
  Registration& shown(const std::string& name, KeyKind kind, CLI::Option* option,
                      const std::string& type);

  CLI::App& command_;
  CLI::App keys_;  // of set-up files alone
  std::string heading_;
  std::string section_;
  bool each_source_ = false;
  std::deque<Registration> all_;
};

[[nodiscard]] bool has_section(const OptionTable& table, std::string_view section);

/// What is wrong with a part that no set-up has, and which it has.
[[nodiscard]] std::string unknown_section(const OptionTable& table, std::string_view section);

/// What is wrong with a key that `section` does not have: where it belongs or what may be meant,
/// and which keys there are.
[[nodiscard]] std::string unknown_key(const OptionTable& table, std::string_view section,
                                      std::string_view key);

/// @throws UsageError when an option of the command line applies to nothing of the run.
void check_scopes(const OptionTable& table, const GivenOptions& given, const RunFacts& run);

/// The same of keys that describe sources. Others may be there for other runs.
/// @throws Error that names where the key stands.
void check_scopes(const OptionTable& table, const DescribedOptions& described,
                  const RunFacts& sources);

/// The options that a command line has, which was parsed by `command`.
[[nodiscard]] GivenOptions given_options(const CLI::App& command);

/// "[surface]" or "[[source]]", as it is written.
[[nodiscard]] std::string in_brackets(std::string_view section);

}  // namespace palpate::app
