// Makes and removes a temporary folder.
#include "apps/palpate/cli/temporary_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "apps/palpate/cli/output.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

std::filesystem::path place() {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (!error) return folder;
  throw Error("no folder for temporary files (TMPDIR, TMP); set TMPDIR to one with room");
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (place() / "palpate-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw Error(fmt::format(
        "{} cannot be created for temporary files; set TMPDIR to a folder with room", pattern));
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, std::string_view bytes) const {
  std::string path = file(name);
  OutputFile out(path);
  out.write(bytes);
  out.close();
  return path;
}

}  // namespace palpate::app
