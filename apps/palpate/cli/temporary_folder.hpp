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

 private:
  std::filesystem::path path_;
};

}  // namespace palpate::app
