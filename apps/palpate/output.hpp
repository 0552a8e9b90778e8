#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace palpate::app {

/// A text file that is being written; "-" is standard output. Whatever goes wrong, a full disk
/// included, is told as an Error that names the file.
class OutputFile {
 public:
  /// @throws Error when the file cannot be made.
  explicit OutputFile(const std::string& path);
  /// @throws Error when it cannot be written.
  void write(std::string_view text);
  /// Brings everything to the disk. @throws Error likewise.
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const;
  };
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace palpate::app
