#include "apps/palpate/setup_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/palpate/arguments.hpp"
#include "apps/palpate/errors.hpp"
#include "apps/palpate/setup_keys.hpp"
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

using Names = std::set<std::string, std::less<>>;

// The options that the command line has.
Names given_options(const CLI::App& command) {
  Names names;
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

  void apply(CLI::App& command, TouchOptions& options) const;

 private:
  [[nodiscard]] toml::table parse() const;
  [[noreturn]] void fail(const toml::source_region& place, const std::string& what) const;
  void fill_section(CLI::App& command, std::string_view section, const toml::table& table) const;
  [[nodiscard]] std::vector<SourceSetup> sources(const Names& given, const toml::node& node,
                                                 const SourceChoices& common) const;
  [[nodiscard]] SourceSetup source(const Names& given, const toml::table& table,
                                   const SourceChoices& common) const;
  [[nodiscard]] std::string name(const toml::node& node) const;
  [[nodiscard]] Eigen::Isometry3d pose(const toml::node& node) const;
  void give(CLI::App& command, const SetupKey& key, const toml::node& node,
            std::string_view section) const;
  [[nodiscard]] std::string text_of(const SetupKey& key, const toml::node& node) const;
  [[nodiscard]] std::string numbers(std::string_view key, const toml::node& node) const;
  [[nodiscard]] std::string resolved(const std::string& path) const;

  std::string path_;
  fs::path folder_;
};

// CLI11 puts the option's name in front.
std::string without_option(const std::string& message, std::string_view option) {
  const std::string front = fmt::format("{}: ", option);
  return message.starts_with(front) ? message.substr(front.size()) : message;
}

void SetupFile::fail(const toml::source_region& place, const std::string& what) const {
  throw Error(fmt::format("{}, line {}: {}", path_, place.begin.line, what));
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
  constexpr std::string_view kSequence = "sequence:";
  if (path.starts_with(kSequence)) {
    return std::string(kSequence) + (folder_ / path.substr(kSequence.size())).string();
  }
  const bool is_file =
      path != "-" && !path.starts_with("camera:") && !path.starts_with("synthetic:");
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
    case KeyKind::text:
    case KeyKind::path:
      break;
  }
  if (!node.is_string()) wrong("text in quotes");
  const std::string text = *node.value<std::string>();
  return key.kind == KeyKind::path ? resolved(text) : text;
}

void SetupFile::give(CLI::App& command, const SetupKey& key, const toml::node& node,
                     std::string_view section) const {
  CLI::Option* option = command.get_option(option_of(key.key));
  const std::string text = text_of(key, node);
  try {
    option->add_result(text);
    option->run_callback();
  } catch (const CLI::Error& error) {
    fail(node.source(), fmt::format("'{}' of [{}]: {}", key.key, section,
                                    without_option(error.what(), option_of(key.key))));
  }
}

void SetupFile::fill_section(CLI::App& command, std::string_view section,
                             const toml::table& table) const {
  for (const auto& [key, node] : table) {
    const SetupKey* known = find(section, key.str());
    if (known == nullptr) {
      fail(key.source(), fmt::format("'{}' is no key of [{}]; its keys are {}", key.str(), section,
                                     key_names(section)));
    }
    if (command.get_option(option_of(known->key))->count() > 0) continue;
    give(command, *known, node, section);
  }
}

Eigen::Isometry3d SetupFile::pose(const toml::node& node) const {
  try {
    return parse_pose("pose=" + numbers("pose", node)).pose;
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

SourceSetup SetupFile::source(const Names& given, const toml::table& table,
                              const SourceChoices& common) const {
  SourceSetup result{.name = "", .from = "", .pose = {}, .choices = common};
  CLI::App own;
  add_source_options(own, result.choices);
  for (const auto& [key, node] : table) {
    const SetupKey* known = find("source", key.str());
    if (key.str() == "name") {
      result.name = name(node);
    } else if (key.str() == "from") {
      result.from = text_of({"from", KeyKind::path}, node);
    } else if (key.str() == "pose") {
      result.pose = pose(node);
    } else if (known == nullptr) {
      fail(key.source(), fmt::format("'{}' is no key of [[source]]; its keys are {}", key.str(),
                                     key_names("source")));
    } else if (!given.contains(option_of(known->key))) {
      give(own, *known, node, "[source]");
    } else {
      (void)text_of(*known, node);  // the command line wins, but the type has to be right
    }
  }
  if (result.from.empty()) {
    fail(table.source(), "this [[source]] has no 'from', which names a file, camera or sequence");
  }
  return result;
}

std::vector<SourceSetup> SetupFile::sources(const Names& given, const toml::node& node,
                                            const SourceChoices& common) const {
  const toml::array* list = node.as_array();
  if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
    fail(node.source(), "'source' is not written as [[source]], once for each source");
  }
  std::vector<SourceSetup> result;
  std::set<std::string> names;
  for (const toml::node& each : *list) {
    result.push_back(source(given, *each.as_table(), common));
    const std::string& name = result.back().name;
    if (name.empty() || names.insert(name).second) continue;
    fail(each.source(), fmt::format("two sources are named '{}'; give each its own name", name));
  }
  return result;
}

void SetupFile::apply(CLI::App& command, TouchOptions& options) const {
  const toml::table file = parse();
  for (const auto& [key, node] : file) {
    if (key.str() == "source") continue;
    if (keys_of(key.str()).empty()) {
      fail(key.source(), fmt::format("'{}' is no part of a set-up; its parts are {}", key.str(),
                                     section_names()));
    }
    if (!node.is_table()) {
      fail(node.source(), fmt::format("'{0}' is {1}; write [{0}] and its keys in lines below",
                                      key.str(), type_name(node)));
    }
  }
  const Names given = given_options(command);  // before any section counts as given
  for (const auto& [key, node] : file) {
    if (key.str() != "source") fill_section(command, key.str(), *node.as_table());
  }
  if (const toml::node* list = file.get("source")) {
    options.setup_sources = sources(given, *list, options.choices);
  }
}

}  // namespace

void apply_setup(CLI::App& command, TouchOptions& options) {
  if (!options.setup.empty()) SetupFile(options.setup).apply(command, options);
}

}  // namespace palpate::app
