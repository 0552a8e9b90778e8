#pragma once

#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/sources/touched.hpp"
#include "palpate/align/align.hpp"

namespace palpate::app {

/// Draws sources before and after they were aligned, by a script for Python with matplotlib that
/// travels inside the program.
class AlignPicture {
 public:
  /// @throws Error when the file cannot be made.
  explicit AlignPicture(const std::string& path) : path_(path), file_(path) {}

  /// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
  void draw(const Touched& touched, const std::vector<AlignedSource>& aligned);

 private:
  std::string path_;
  OutputFile file_;
};

}  // namespace palpate::app
