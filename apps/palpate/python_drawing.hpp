#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/output.hpp"

namespace palpate::app {

/// A file that a drawing script reads.
struct DrawingData {
  std::string name;
  std::string bytes;
};

/// The Python that draws: Debian's own first, since that is the one python3-matplotlib belongs to.
[[nodiscard]] std::string drawing_python();

/// The bytes of numbers in single precision, as numpy.fromfile reads them.
[[nodiscard]] std::string float_bytes(const std::vector<float>& values);

/// Draws `picture` (`path` in messages) by a script for Python with matplotlib, which is given the
/// folder with `data` and the picture's place; closes `picture`.
/// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
void draw_by_python(std::string_view script, const std::vector<DrawingData>& data,
                    const std::string& path, OutputFile& picture);

}  // namespace palpate::app
