#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/cli/output.hpp"

namespace palpate::app {

/// A file that a drawing script reads.
struct DrawingData {
  std::string name;
  std::string bytes;
};

/// The Python that draws: Debian's own first, since that is the one python3-matplotlib belongs to.
[[nodiscard]] std::string drawing_python();

/// A command that succeeds where there is Python with matplotlib; imports nothing, so that it takes
/// no time.
[[nodiscard]] std::vector<std::string> drawing_trial();

/// Checks --picture before any work; empty: no picture is wanted.
/// @throws UsageError when its path is standard output or has another kind's ending than .png;
/// Error when Python or matplotlib is missing, naming the package.
void check_picture(const std::string& path);

/// The bytes of numbers in single precision, as numpy.fromfile reads them.
[[nodiscard]] std::string float_bytes(const std::vector<float>& values);

/// Draws `picture` (`path` in messages) by a script for Python with matplotlib, which is given the
/// folder with `data` and the picture's path; closes `picture`.
/// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
void draw_by_python(std::string_view script, const std::vector<DrawingData>& data,
                    const std::string& path, OutputFile& picture);

/// The files that a figure goes to. All are made before the work: a path that does not exist is
/// reported at once.
class FigureFiles {
 public:
  /// Their paths; empty: not requested.
  /// @throws UsageError, Error as check_distinct(), check_picture() and OutputFile do.
  FigureFiles(const std::string& csv, const std::string& json, const std::string& picture);

  /// The table, the facts, and the picture that figures.py draws of both.
  /// @throws Error as OutputFile and draw_by_python() do.
  void write(const std::string& table, const Json& facts);

 private:
  std::string picture_path_;
  std::optional<OutputFile> csv_;
  std::optional<OutputFile> json_;
  std::optional<OutputFile> picture_;
};

// The scripts, as CMake found them. All import drawing.py.
[[nodiscard]] std::string_view drawing_script();
[[nodiscard]] std::string_view picture_script();
[[nodiscard]] std::string_view figures_script();
[[nodiscard]] std::string_view trust_script();
[[nodiscard]] std::string_view align_script();

}  // namespace palpate::app
