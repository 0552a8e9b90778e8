#include "apps/palpate/doctor/system.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace palpate::app::doctor {

namespace fs = std::filesystem;

std::optional<std::string> text(const System& system, const std::string& path) {
  std::ifstream stream(system.root / path);
  if (!stream) return std::nullopt;
  std::ostringstream content;
  content << stream.rdbuf();
  std::string result = content.str();
  while (result.ends_with('\n')) result.pop_back();
  return result;
}

std::optional<long> whole_number(const System& system, const std::string& path) {
  const std::optional<std::string> told = text(system, path);
  if (!told) return std::nullopt;
  long value = 0;
  std::from_chars(told->data(), told->data() + told->size(), value);
  return value;
}

bool is_there(const System& system, const std::string& path) {
  std::error_code ignored;
  return fs::exists(system.root / path, ignored);
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> result;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    result.push_back(entry->path());
  }
  std::ranges::sort(result);
  return result;
}

std::string variable(const System& system, const std::string& name) {
  const auto found = system.variables.find(name);
  return found == system.variables.end() ? "" : found->second;
}

bool in_container(const System& system) {
  return is_there(system, ".dockerenv") || is_there(system, "run/.containerenv");
}

bool is_ubuntu(const System& system) {
  return text(system, "etc/os-release").value_or("").find("ID=ubuntu") != std::string::npos;
}

}  // namespace palpate::app::doctor
