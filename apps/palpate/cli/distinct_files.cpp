#include "apps/palpate/cli/distinct_files.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "apps/palpate/cli/errors.hpp"

namespace palpate::app {

namespace {

namespace fs = std::filesystem;

bool is_plain(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || path == "-") return false;
  return !fs::exists(path, ignored) || fs::is_regular_file(path, ignored);
}

bool same_place(const std::string& a, const std::string& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed) && !failed) return true;  // two names of one file
  const fs::path place = fs::weakly_canonical(fs::absolute(a), failed);
  if (failed) return a == b;
  return place == fs::weakly_canonical(fs::absolute(b), failed) && !failed;
}

}  // namespace

std::vector<NamedFile> inputs(const std::vector<CloudArgument>& clouds) {
  std::vector<NamedFile> result;
  for (const CloudArgument& cloud : clouds) {
    result.push_back({fmt::format("the cloud '{}'", cloud.name), cloud.path});
  }
  return result;
}

void check_distinct(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
  std::vector<NamedFile> others = inputs;
  for (const NamedFile& output : outputs) {
    if (!is_plain(output.path)) continue;
    for (const NamedFile& other : others) {
      if (!is_plain(other.path) || !same_place(output.path, other.path)) continue;
      throw UsageError(fmt::format("{} {} is the same file as {}; choose another place",
                                   output.name, output.path, other.name));
    }
    others.push_back(output);
  }
}

}  // namespace palpate::app
