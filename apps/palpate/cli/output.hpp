#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"

namespace palpate::app {

/// A file that appears when it is complete: until close() it grows without a name in its folder or,
/// where the file system has no such files, beside its target under another name. So a run that
/// fails leaves what was there as it was. "-" is standard output; what is no plain file (/dev/null,
/// a pipe) is written as it is. Whatever goes wrong, a full disk included, is reported as an Error
/// that names the file.
///
/// One that `stays` grows as PATH.part (PATH.part-2, ... where there is one already), and if it is
/// not closed it stays there, in whole lines where the disk is full: for what cannot be had twice.
class OutputFile {
 public:
  enum class Unfinished { goes, stays };

  /// Tries whether the file can be made, and leaves nothing of that. @throws Error when it cannot.
  explicit OutputFile(const std::string& path, Unfinished unfinished = Unfinished::goes);
  /// Unless it was closed it leaves nothing behind, or what `stays`.
  ~OutputFile();
  OutputFile(OutputFile&&) = default;
  OutputFile& operator=(OutputFile&&) = delete;
  /// @throws Error when it cannot be written.
  void write(std::string_view text);
  /// Brings everything to the disk and to its target. @throws Error as the constructor does.
  void close();

  /// Where it grows, for a program that this one starts; what it writes there comes to its target
  /// as well.
  /// @throws Error when it cannot be made.
  [[nodiscard]] std::string growing();

 private:
  struct Closer {
    void operator()(std::FILE* file) const;
  };
  void open();  // unless it is
  bool open_nameless();
  void open_named();
  bool name();
  void keep_lines(std::string_view last);
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  std::string target_;   // where links lead
  std::string growing_;  // its name meanwhile; the same where it is written as it is
  bool stays_;
  bool nameless_ = false;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// The requested file; none where `path` is empty. @throws Error as OutputFile does.
[[nodiscard]] std::optional<OutputFile> output_at(const std::string& path);

/// Writes all of a requested file, if any. @throws Error as OutputFile does.
void write_whole(std::optional<OutputFile>& file, std::string_view text);
/// The same of the file at `path`; none where that is empty.
void write_whole(const std::string& path, std::string_view text);

/// Where a file goes that each hand or cloud has: "forces.csv" of the first (0), then
/// "forces-2.csv", "forces-3.csv"; empty where it is.
[[nodiscard]] std::string numbered_path(const std::string& path, std::size_t hand);

/// A file that a command names, and by what: "--log", "the source 'bunny'".
struct NamedFile {
  std::string name;
  std::string path;  ///< empty: not named; "-" and "synthetic:NAME" are no files
};

/// Files that are read.
[[nodiscard]] std::vector<NamedFile> inputs(const std::vector<CloudArgument>& clouds);

/// @throws UsageError when an output is a file that is read, or that another output goes to as
/// well, links followed. What is no plain file may be written by several.
void check_distinct(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// Reports keep their keys in the order in which they are written.
using Json = nlohmann::ordered_json;

/// Indented, with a line's end. Bytes that are not UTF-8, as names of files may have, become
/// U+FFFD.
[[nodiscard]] inline std::string text_of(const Json& data) {
  return data.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::app
