#pragma once

#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate::app {

/// Draws where a cloud is trusted, by a script for Python with matplotlib that travels inside the
/// program.
class TrustPicture {
 public:
  /// @throws Error when the file cannot be made.
  explicit TrustPicture(const std::string& path) : path_(path), file_(path) {}

  /// Keeps what the picture shows: what is felt inside `box` (m, world), thinned evenly.
  void take(const std::string& name, const Prepared& prepared, const Box& box);

  /// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
  void draw();

 private:
  std::string path_;
  OutputFile file_;
  std::vector<float> rows_;  // place from the box's middle, normal, trust
  std::string facts_;
};

}  // namespace palpate::app
