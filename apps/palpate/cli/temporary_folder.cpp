// Makes and removes a temporary folder.
#include "apps/palpate/cli/temporary_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

std::filesystem::path root_folder() {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (!error) return folder;
  throw Error("no folder for temporary files (TMPDIR, TMP); set TMPDIR to one with room");
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (root_folder() / "palpate-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw Error(fmt::format(
        "{} cannot be created for temporary files; set TMPDIR to a folder with room", pattern));
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  if (lent_ >= 0) ::close(lent_);
}

std::string TemporaryFolder::write(const std::string& name, std::string_view bytes) const {
  std::string path = file(name);
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out.good()) return path;
  throw Error(
      fmt::format("{} cannot be written, a temporary file: {}; set TMPDIR to a folder with room",
                  path, std::strerror(errno)));
}

std::string TemporaryFolder::lend(const std::string& name, std::string_view bytes) {
  std::string path = write(name, bytes);
  lent_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const std::string open_file = fmt::format("/proc/self/fd/{}", lent_);
  std::error_code failed;
  if (lent_ < 0 || !std::filesystem::exists(open_file, failed)) return path;  // it keeps its name
  const std::string link = file("link");
  std::filesystem::create_symlink(open_file, link, failed);
  if (!failed) std::filesystem::rename(link, path, failed);
  return path;
}

}  // namespace palpate::app
