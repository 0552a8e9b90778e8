#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate::app {

/// A folder of the program's own that vanishes with its contents.
class TemporaryFolder {
 public:
  /// @throws Error when it cannot be made.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// The path of what is called `name` in it.
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

  /// Writes such a file; its path. @throws Error when it cannot be written.
  std::string write(const std::string& name, std::string_view bytes) const;

  /// Writes it so that its bytes vanish with this process, even one that is killed: the path leads
  /// to the open file, which has no other name, where /proc and links are there. One for each
  /// folder.
  std::string lend(const std::string& name, std::string_view bytes);

 private:
  std::filesystem::path path_;
  int lent_ = -1;  // descriptor
};

}  // namespace palpate::app
