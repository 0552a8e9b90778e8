#include "apps/palpate/options/setup_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/options/setup_keys.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

namespace fs = std::filesystem;

const char* type_name(const toml::node& node) {
  if (node.is_string()) return "text";
  if (node.is_integer()) return "a whole number";
  if (node.is_floating_point()) return "a number";
  if (node.is_boolean()) return "true or false";
  if (node.is_array()) return "a list";
  return node.is_table() ? "a table" : "a date or time";
}

// The options that the command line has.
GivenOptions given_options(const CLI::App& command) {
  GivenOptions names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) names.insert(option->get_name());
  }
  return names;
}

const SetupKey* find(std::string_view section, std::string_view key) {
  const std::span<const SetupKey> keys = keys_of(section);
  const auto place = std::ranges::find(keys, key, &SetupKey::key);
  return place == keys.end() ? nullptr : &*place;
}

// One file on its way into options.
class SetupFile {
 public:
  explicit SetupFile(std::string path) : path_(std::move(path)), folder_(fs::path(path_)) {
    folder_ = folder_.parent_path();
  }

  void apply(TouchOptions& options) const;

 private:
  [[nodiscard]] toml::table parse() const;
  [[nodiscard]] std::string in_words(const toml::source_region& place,
                                     const std::string& what) const;
  [[noreturn]] void fail(const toml::source_region& place, const std::string& what) const;
  void check_sections(const toml::table& file) const;
  [[nodiscard]] std::vector<SourceSetup> sources(const TouchOptions& options,
                                                 const toml::node& node) const;
  [[nodiscard]] SourceSetup source(const TouchOptions& options, const toml::table& table) const;
  [[nodiscard]] std::string name(const toml::node& node) const;
  [[nodiscard]] std::string from(const toml::node& node) const;
  [[nodiscard]] Eigen::Isometry3d pose(const toml::node& node) const;
  void take(CLI::App& taker, const TouchOptions& options, std::string_view section,
            const toml::key& key, const toml::node& node, DescribedOptions& described) const;
  [[nodiscard]] std::string text_of(const SetupKey& key, const toml::node& node) const;
  [[nodiscard]] std::vector<std::string> texts_of(const SetupKey& key,
                                                  const toml::node& node) const;
  [[nodiscard]] std::string numbers(std::string_view key, const toml::node& node) const;
  [[nodiscard]] std::string resolved(const std::string& path) const;

  std::string path_;
  fs::path folder_;
};

std::string SetupFile::in_words(const toml::source_region& place, const std::string& what) const {
  return fmt::format("{}, line {}: {}", path_, place.begin.line, what);
}

void SetupFile::fail(const toml::source_region& place, const std::string& what) const {
  throw Error(in_words(place, what));
}

toml::table SetupFile::parse() const {
  std::error_code ignored;
  if (!fs::is_regular_file(path_, ignored)) {
    throw Error(fmt::format("{}: there is no such file; --setup takes a TOML file", path_));
  }
  try {
    return toml::parse_file(path_);
  } catch (const toml::parse_error& error) {
    fail(error.source(), fmt::format("{}; a set-up file is TOML", error.description()));
  }
}

std::string SetupFile::resolved(const std::string& path) const {
  if (path.starts_with(kSequence)) {
    return std::string(kSequence) + (folder_ / path.substr(kSequence.size())).string();
  }
  const bool is_file = path != "-" && !path.starts_with(kCamera) && !path.starts_with(kSynthetic);
  return is_file ? (folder_ / path).string() : path;
}

std::string SetupFile::numbers(std::string_view key, const toml::node& node) const {
  std::string joined;
  const toml::array* list = node.as_array();
  if (list == nullptr) {
    fail(node.source(),
         fmt::format("'{}' is {}; give a list of numbers in [ ]", key, type_name(node)));
  }
  for (const toml::node& each : *list) {
    if (!each.is_number()) {
      fail(each.source(), fmt::format("'{}' holds {}; give numbers alone", key, type_name(each)));
    }
    joined += fmt::format("{}{}", joined.empty() ? "" : ",", *each.value<double>());
  }
  return joined;
}

std::string SetupFile::text_of(const SetupKey& key, const toml::node& node) const {
  const auto wrong = [&](const char* wanted) {
    fail(node.source(), fmt::format("'{}' is {}; give {}", key.key, type_name(node), wanted));
  };
  switch (key.kind) {
    case KeyKind::numbers:
      return numbers(key.key, node);
    case KeyKind::numbers_or_text:
      if (node.is_array()) return numbers(key.key, node);
      break;
    case KeyKind::number:
      if (!node.is_number()) wrong("a number");
      return fmt::format("{}", *node.value<double>());
    case KeyKind::integer:
      if (!node.is_integer()) wrong("a whole number");
      return fmt::format("{}", *node.value<std::int64_t>());
    case KeyKind::flag:
      if (!node.is_boolean()) wrong("true or false");
      return *node.value<bool>() ? "true" : "false";
    case KeyKind::texts:
      if (!node.is_string()) wrong("text in quotes, or a list of it");
      break;
    case KeyKind::text:
    case KeyKind::path:
      break;
  }
  if (!node.is_string()) wrong("text in quotes");
  const std::string text = *node.value<std::string>();
  if (text.empty()) fail(node.source(), fmt::format("'{}' is empty; leave it out", key.key));
  return key.kind == KeyKind::path ? resolved(text) : text;
}

// What the option of that key would be given, one after the other.
std::vector<std::string> SetupFile::texts_of(const SetupKey& key, const toml::node& node) const {
  const toml::array* list = node.as_array();
  if (key.kind != KeyKind::texts || list == nullptr) return {text_of(key, node)};
  if (list->empty()) fail(node.source(), fmt::format("'{}' is empty; leave it out", key.key));
  std::vector<std::string> texts;
  for (const toml::node& each : *list) texts.push_back(text_of({key.key, KeyKind::text}, each));
  return texts;
}

// Gives a key's value to the option of its name, unless the command line has that; its type has to
// be right all the same.
void SetupFile::take(CLI::App& taker, const TouchOptions& options, std::string_view section,
                     const toml::key& key, const toml::node& node,
                     DescribedOptions& described) const {
  const SetupKey* known = find(section, key.str());
  if (known == nullptr) fail(key.source(), unknown_key(section, key.str()));
  const std::vector<std::string> texts = texts_of(*known, node);
  described[option_of(known->key)] = in_words(key.source(), fmt::format("'{}'", known->key));
  if (options.given.contains(option_of(known->key))) return;
  CLI::Option* option = taker.get_option(option_of(known->key));
  try {
    for (const std::string& text : texts) option->add_result(text);
    option->run_callback();
  } catch (const CLI::Error& error) {
    fail(node.source(), fmt::format("'{}' of {}: {}", known->key, in_brackets(section),
                                    without_option(error.what())));
  }
}

Eigen::Isometry3d SetupFile::pose(const toml::node& node) const {
  constexpr const char* kWhat = "'pose' of [[source]]";
  try {
    const std::vector<double> values =
        parse_numbers(numbers("pose", node), 7, kWhat,
                      "[x, y, z, qx, qy, qz, qw] in metres and as a unit quaternion");
    return pose_of(values, kWhat);
  } catch (const UsageError& error) {
    fail(node.source(), error.what());
  }
}

std::string SetupFile::name(const toml::node& node) const {
  std::string name = text_of({"name", KeyKind::text}, node);
  if (!is_name(name)) {
    fail(node.source(),
         fmt::format("'name' is '{}'; give letters, digits, '-', '_' and '.' alone", name));
  }
  return name;
}

std::string SetupFile::from(const toml::node& node) const {
  const std::string from = text_of({"from", KeyKind::text}, node);
  if (!names_something(from)) {
    fail(node.source(), fmt::format("'from' is '{}', which names nothing; write more behind the "
                                    "colon",
                                    from));
  }
  return resolved(from);
}

SourceSetup SetupFile::source(const TouchOptions& options, const toml::table& table) const {
  SourceSetup result{
      .name = "", .from = "", .pose = {}, .choices = options.choices, .described = {}};
  CLI::App taker;
  add_source_options(taker, result.choices);
  add_source_setup_options(taker, result.choices);
  for (const auto& [key, node] : table) {
    if (key.str() == "name") {
      result.name = name(node);
    } else if (key.str() == "from") {
      result.from = from(node);
    } else if (key.str() == "pose") {
      result.pose = pose(node);
    } else {
      take(taker, options, "source", key, node, result.described);
    }
  }
  if (result.from.empty()) {
    fail(table.source(), "this [[source]] has no 'from', which names a file, camera or sequence");
  }
  return result;
}

std::vector<SourceSetup> SetupFile::sources(const TouchOptions& options,
                                            const toml::node& node) const {
  const toml::array* list = node.as_array();
  if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
    fail(node.source(), "'source' is not written as [[source]], once for each source");
  }
  std::vector<SourceSetup> result;
  std::set<std::string> names;
  for (const toml::node& each : *list) {
    result.push_back(source(options, *each.as_table()));
    const std::string& name = result.back().name;
    if (name.empty() || names.insert(name).second) continue;
    fail(each.source(), fmt::format("two sources are named '{}'; give each its own name", name));
  }
  return result;
}

void SetupFile::check_sections(const toml::table& file) const {
  for (const auto& [key, node] : file) {
    if (keys_of(key.str()).empty()) fail(key.source(), unknown_section(key.str()));
    if (key.str() != "source" && !node.is_table()) {
      fail(node.source(), fmt::format("'{0}' is {1}; write [{0}] and its keys in lines below",
                                      key.str(), type_name(node)));
    }
  }
}

void SetupFile::apply(TouchOptions& options) const {
  const toml::table file = parse();
  check_sections(file);
  CLI::App taker;
  add_touch_options(taker, options);
  add_setup_options(taker, options);
  for (const auto& [section, node] : file) {
    if (section.str() == "source") continue;
    for (const auto& [key, value] : *node.as_table()) {
      take(taker, options, section.str(), key, value, options.described);
    }
  }
  if (const toml::node* list = file.get("source")) options.setup_sources = sources(options, *list);
}

}  // namespace

void apply_setup(const CLI::App& command, TouchOptions& options) {
  options.given = given_options(command);
  if (!options.setup.empty()) SetupFile(options.setup).apply(options);
}

}  // namespace palpate::app
