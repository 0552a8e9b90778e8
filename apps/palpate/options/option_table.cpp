// Registers options once, for the command line and for set-up files.
#include "apps/palpate/options/option_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "apps/palpate/cli/errors.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

constexpr const char* kSource = "source";

bool stands_in(const Registration& each, std::string_view section) {
  return section == kSource ? each.each_source : !section.empty() && each.section == section;
}

// "did you mean 'radius'? "; empty: nothing is near.
std::string question(std::string_view word, const std::vector<std::string>& names) {
  const std::string near = meant(word, names);
  return near.empty() ? "" : fmt::format("did you mean '{}'? ", near);
}

// Words of the first scope of `option` that does not apply; null: all do.
const char* refusal(const Registration& option, const RunFacts& run) {
  for (const Scope& scope : option.scopes) {
    if (!(run.*scope.applies)) return scope.words;
  }
  return nullptr;
}

std::vector<std::string> sections(const OptionTable& table) {
  std::vector<std::string> names = {kSource};
  for (const Registration& each : table.all()) {
    if (!each.section.empty() && std::ranges::find(names, each.section) == names.end()) {
      names.push_back(each.section);
    }
  }
  return names;
}

std::vector<std::string> keys(const OptionTable& table, std::string_view section) {
  std::vector<std::string> names;
  if (section == kSource) names = {"name", "from", "pose"};
  for (const Registration& each : table.all()) {
    if (stands_in(each, section)) names.push_back(each.key());
  }
  return names;
}

// `take`, whose UsageError is one of the command line.
std::function<void(const std::string&)> checked(const std::string& name,
                                                std::function<void(const std::string&)> take) {
  return [name, take = std::move(take)](const std::string& text) {
    try {
      take(text);
    } catch (const UsageError& error) {
      throw CLI::ValidationError(name, without_option(error.what()));
    }
  };
}

}  // namespace

std::string option_name(std::string key) {
  std::ranges::replace(key, '_', '-');
  return "--" + key;
}

std::string type_of(const About& about) {
  std::string unit = about.unit;
  if (unit.empty()) return about.value;
  if (unit == "m") return "METRES";
  if (unit == "s") return "SECONDS";
  std::ranges::transform(unit, unit.begin(), [](unsigned char c) { return std::toupper(c); });
  return unit;
}

CLI::Validator check_of(const Range& range, bool whole) {
  if (!whole) return number(range.text(), [range](double x) { return range.contains(x); });
  return whole_number(static_cast<std::int64_t>(range.least),
                      static_cast<std::int64_t>(range.most));
}

std::string Registration::key() const {
  std::string key = name.substr(2);
  std::ranges::replace(key, '-', '_');
  return key;
}

void OptionTable::under(std::string heading, std::string section, bool each_source) {
  heading_ = std::move(heading);
  section_ = std::move(section);
  each_source_ = each_source;
}

Registration& OptionTable::registered(const std::string& name, KeyKind kind, CLI::Option* option) {
  return all_.emplace_back(Registration{name, section_, each_source_, kind, option});
}

Registration& OptionTable::shown(const std::string& name, KeyKind kind, CLI::Option* option,
                                 const std::string& type) {
  return registered(name, kind, option->type_name(type)->group(heading_));
}

Registration& OptionTable::add_flag(const std::string& name, bool& value, const std::string& help) {
  return registered(name, KeyKind::flag,
                    command_.add_flag(name, value, wrapped(help))->group(heading_));
}

Registration& OptionTable::add_text(const std::string& name, KeyKind kind, const std::string& type,
                                    std::function<void(const std::string&)> take,
                                    const std::string& help) {
  return shown(name, kind,
               command_.add_option_function<std::string>(name, checked(name, std::move(take)),
                                                         wrapped(help)),
               type);
}

Registration& OptionTable::add_texts(const std::string& name, KeyKind kind, const std::string& type,
                                     std::function<void(const std::string&)> take,
                                     const std::string& help) {
  using Texts = std::vector<std::string>;
  const auto take_all = [take_one = checked(name, std::move(take))](const Texts& texts) {
    for (const std::string& text : texts) take_one(text);
  };
  CLI::Option* const option = command_.add_option_function<Texts>(name, take_all, wrapped(help));
  return shown(name, kind, option->allow_extra_args(false), type);
}

const Registration* OptionTable::find(std::string_view section, std::string_view key) const {
  const auto found = std::ranges::find_if(all_, [&](const Registration& each) {
    return stands_in(each, section) && each.key() == key;
  });
  return found == all_.end() ? nullptr : &*found;
}

bool has_section(const OptionTable& table, std::string_view section) {
  const std::vector<std::string> all = sections(table);
  return std::ranges::find(all, section) != all.end();
}

std::string unknown_section(const OptionTable& table, std::string_view section) {
  return fmt::format("'{}' is not a section of a set-up file; {}the sections are {}", section,
                     question(section, sections(table)), fmt::join(sections(table), ", "));
}

std::string unknown_key(const OptionTable& table, std::string_view section, std::string_view key) {
  std::vector<std::string> found;
  for (const std::string& each : sections(table)) {
    const std::vector<std::string> there = keys(table, each);
    if (std::ranges::find(there, key) != there.end()) found.push_back(in_brackets(each));
  }
  return fmt::format("'{}' is not a key of {}; {}its keys are {}", key, in_brackets(section),
                     found.empty() ? question(key, keys(table, section))
                                   : fmt::format("it belongs to {}; ", fmt::join(found, ", ")),
                     fmt::join(keys(table, section), ", "));
}

void check_scopes(const OptionTable& table, const GivenOptions& given, const RunFacts& run) {
  for (const Registration& each : table.all()) {
    const char* const words = given.contains(each.name) ? refusal(each, run) : nullptr;
    if (words != nullptr) throw UsageError(fmt::format("{} {}", each.name, words));
  }
}

void check_scopes(const OptionTable& table, const DescribedOptions& described,
                  const RunFacts& sources) {
  for (const Registration& each : table.all()) {
    const auto found = described.find(each.name);
    if (found == described.end() || !each.each_source) continue;
    const char* const words = refusal(each, sources);
    if (words != nullptr) throw Error(fmt::format("{} {}", found->second, words));
  }
}

GivenOptions given_options(const CLI::App& command) {
  GivenOptions names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) names.insert(option->get_name());
  }
  return names;
}

std::string in_brackets(std::string_view section) {
  return section == kSource ? "[[source]]" : fmt::format("[{}]", section);
}

}  // namespace palpate::app
