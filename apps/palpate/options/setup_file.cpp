// Reads set-up files (TOML) into the registered options.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/tool_options.hpp"
#include "apps/palpate/options/touch_options.hpp"
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

// Reads one file into options.
class SetupFile {
 public:
  SetupFile(std::string path, const OptionTable& table, const GivenOptions& given)
      : path_(std::move(path)),
        folder_(fs::path(path_).parent_path()),
        table_(table),
        given_(given) {}

  void read(TouchChoices& choices, DescribedOptions& described) const;

 private:
  [[nodiscard]] toml::table parse() const;
  [[nodiscard]] std::string in_words(const toml::source_region& region,
                                     const std::string& what) const;
  [[noreturn]] void fail(const toml::source_region& region, const std::string& what) const;
  void check_sections(const toml::table& file) const;
  [[nodiscard]] std::vector<DescribedSource> sources(const SourcePlan& base,
                                                     const toml::node& node) const;
  [[nodiscard]] DescribedSource source(const SourcePlan& base, const toml::table& table) const;
  [[nodiscard]] std::string name(const toml::node& node) const;
  [[nodiscard]] std::string from(const toml::node& node) const;
  [[nodiscard]] Eigen::Isometry3d pose(const toml::node& node) const;
  void take(const OptionTable& table, std::string_view section, const toml::key& key,
            const toml::node& node, DescribedOptions& described) const;
  [[nodiscard]] std::string text_of(std::string_view key, KeyKind kind,
                                    const toml::node& node) const;
  [[nodiscard]] std::vector<std::string> texts_of(std::string_view key, KeyKind kind,
                                                  const toml::node& node) const;
  [[nodiscard]] std::string numbers(std::string_view key, const toml::node& node) const;
  [[nodiscard]] std::string resolved(const std::string& path) const;

  std::string path_;
  fs::path folder_;
  const OptionTable& table_;
  const GivenOptions& given_;
};

std::string SetupFile::in_words(const toml::source_region& region, const std::string& what) const {
  return fmt::format("{}, line {}: {}", path_, region.begin.line, what);
}

void SetupFile::fail(const toml::source_region& region, const std::string& what) const {
  throw Error(in_words(region, what));
}

toml::table SetupFile::parse() const {
  std::error_code failed;
  const fs::file_status status = fs::status(path_, failed);
  if (!fs::is_regular_file(status)) {
    const std::string why = fs::exists(status)         ? "is no file"
                            : fs::status_known(status) ? "no such file"
                                                       : "cannot be read: " + failed.message();
    throw Error(fmt::format("{}: {}; --setup takes a TOML file", path_, why));
  }
  try {
    return toml::parse_file(path_);
  } catch (const toml::parse_error& error) {
    fail(error.source(), fmt::format("{}; a set-up file must be valid TOML", error.description()));
  }
}

std::string SetupFile::resolved(const std::string& path) const {
  for (const std::string_view recorded : {kSequence, kBag, kMeshTool}) {
    if (!path.starts_with(recorded)) continue;
    return std::string(recorded) + (folder_ / path.substr(recorded.size())).string();
  }
  const bool is_file = path != "-" && !path.starts_with(kCamera) && !path.starts_with(kRos) &&
                       !path.starts_with(kSynthetic);
  return is_file ? (folder_ / path).string() : path;
}

std::string SetupFile::numbers(std::string_view key, const toml::node& node) const {
  std::string joined;
  const toml::array* list = node.as_array();
  if (node.is_number()) return fmt::format("{}", *node.value<double>());  // one is a list, too
  if (list == nullptr) {
    fail(node.source(),
         fmt::format("'{}' is {}; give a list of numbers in [ ]", key, type_name(node)));
  }
  for (const toml::node& each : *list) {
    if (!each.is_number()) {
      fail(each.source(), fmt::format("'{}' contains {}; give only numbers", key, type_name(each)));
    }
    joined += fmt::format("{}{}", joined.empty() ? "" : ",", *each.value<double>());
  }
  return joined;
}

std::string SetupFile::text_of(std::string_view key, KeyKind kind, const toml::node& node) const {
  const auto wrong = [&](const char* wanted) {
    fail(node.source(), fmt::format("'{}' is {}; give {}", key, type_name(node), wanted));
  };
  switch (kind) {
    case KeyKind::numbers:
      return numbers(key, node);
    case KeyKind::numbers_or_text:
      if (node.is_array()) return numbers(key, node);
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
    case KeyKind::mesh_or_text:
      break;
  }
  if (!node.is_string()) wrong("text in quotes");
  const std::string text = *node.value<std::string>();
  if (text.empty())
    fail(node.source(), fmt::format("'{}' is empty; give a value or remove it", key));
  const bool is_path =
      kind == KeyKind::path || (kind == KeyKind::mesh_or_text && text.starts_with(kMeshTool));
  return is_path ? resolved(text) : text;
}

// The values of a key as the option would get them on the command line.
std::vector<std::string> SetupFile::texts_of(std::string_view key, KeyKind kind,
                                             const toml::node& node) const {
  const toml::array* list = node.as_array();
  if (kind != KeyKind::texts || list == nullptr) return {text_of(key, kind, node)};
  if (list->empty())
    fail(node.source(), fmt::format("'{}' is empty; give a value or remove it", key));
  std::vector<std::string> texts;
  for (const toml::node& each : *list) texts.push_back(text_of(key, KeyKind::text, each));
  return texts;
}

// Gives a key's value to the option of its name, unless the command line has that; its type has to
// be right all the same.
void SetupFile::take(const OptionTable& table, std::string_view section, const toml::key& key,
                     const toml::node& node, DescribedOptions& described) const {
  const Registration* const registration = table.find(section, key.str());
  if (registration == nullptr) fail(key.source(), unknown_key(table_, section, key.str()));
  const std::vector<std::string> texts = texts_of(key.str(), registration->kind, node);
  described[registration->name] = in_words(key.source(), fmt::format("'{}'", key.str()));
  if (given_.contains(registration->name)) return;
  try {
    for (const std::string& text : texts) registration->option->add_result(text);
    registration->option->run_callback();
  } catch (const CLI::Error& error) {
    fail(node.source(), fmt::format("'{}' of {}: {}", key.str(), in_brackets(section),
                                    without_option(error.what())));
  }
}

Eigen::Isometry3d SetupFile::pose(const toml::node& node) const {
  constexpr const char* kWhat = "'pose' of [[source]]";
  try {
    return pose_of(parse_numbers(numbers("pose", node), 0, kWhat, kPoseForm), kWhat);
  } catch (const UsageError& error) {
    fail(node.source(), error.what());
  }
}

std::string SetupFile::name(const toml::node& node) const {
  std::string name = text_of("name", KeyKind::text, node);
  if (!is_name(name)) {
    fail(node.source(),
         fmt::format("'name' is '{}'; use only letters, digits, '-', '_' and '.'", name));
  }
  return name;
}

std::string SetupFile::from(const toml::node& node) const {
  const std::string from = text_of("from", KeyKind::text, node);
  if (!names_something(from)) {
    fail(node.source(),
         fmt::format("'from' is '{}', which names no source; add a name after the colon", from));
  }
  return resolved(from);
}

DescribedSource SetupFile::source(const SourcePlan& base, const toml::table& part) const {
  DescribedSource result{.plan = base};
  SourcePlan& plan = result.plan;
  CLI::App app;
  OptionTable table(app);
  add_source_options(table, plan);
  add_cache_option(table, plan);
  for (const auto& [key, node] : part) {
    if (key.str() == "name") {
      plan.argument.name = name(node);
    } else if (key.str() == "from") {
      plan.argument.path = from(node);
    } else if (key.str() == "pose") {
      plan.options.T_world_sensor = pose(node);
    } else {
      take(table, "source", key, node, result.described);
    }
  }
  if (plan.argument.path.empty()) {
    fail(part.source(),
         "this [[source]] has no 'from'; add one that names a file, camera or sequence");
  }
  return result;
}

std::vector<DescribedSource> SetupFile::sources(const SourcePlan& base,
                                                const toml::node& node) const {
  const toml::array* list = node.as_array();
  if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
    fail(node.source(), "'source' must be written as [[source]], once for each source");
  }
  std::vector<DescribedSource> result;
  std::set<std::string> names;
  for (const toml::node& each : *list) {
    result.push_back(source(base, *each.as_table()));
    const std::string& name = result.back().plan.argument.name;
    if (name.empty() || names.insert(name).second) continue;
    fail(each.source(), fmt::format("two sources are named '{}'; give each its own name", name));
  }
  return result;
}

void SetupFile::check_sections(const toml::table& file) const {
  for (const auto& [key, node] : file) {
    if (!has_section(table_, key.str())) fail(key.source(), unknown_section(table_, key.str()));
    if (key.str() != "source" && !node.is_table()) {
      fail(node.source(),
           fmt::format("'{0}' is {1}; write a section [{0}] with its keys on the lines below",
                       key.str(), type_name(node)));
    }
  }
}

void SetupFile::read(TouchChoices& choices, DescribedOptions& described) const {
  const toml::table file = parse();
  check_sections(file);
  for (const auto& [section, node] : file) {
    if (section.str() == "source") continue;
    for (const auto& [key, value] : *node.as_table()) {
      take(table_, section.str(), key, value, described);
    }
  }
  if (const toml::node* list = file.get("source")) {
    choices.described_sources = sources(choices.every_source, *list);
  }
}

}  // namespace

void read_setup(const std::string& path, const OptionTable& table, const GivenOptions& given,
                TouchChoices& choices, DescribedOptions& described) {
  SetupFile(path, table, given).read(choices, described);
}

}  // namespace palpate::app
