#pragma once

#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// Collects the steps of a run and draws them with the clouds, by a script for Python with
/// matplotlib that travels inside the program.
class Picture {
 public:
  /// @throws Error when the file cannot be made.
  explicit Picture(const std::string& path) : path_(path), file_(path) {}

  void add(const ServoState& step) { steps_.push_back(step); }

  /// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
  void draw(const Scene& scene, const std::string& title, const std::string& subtitle);

 private:
  std::string path_;
  OutputFile file_;
  std::vector<ServoState> steps_;
};

}  // namespace palpate::app
