#pragma once

#include <string>
#include <vector>

#include "apps/palpate/run/run.hpp"
#include "session/view_settings.hpp"

namespace palpate::app {

using session::Setting;

/// Settings that another run begins with, on the same page: which scene, and the unit of each file.
class NextRun {
 public:
  /// The run outlives it. Where nothing may follow a run, it has no such settings.
  explicit NextRun(const Run& run);

  [[nodiscard]] const std::vector<Setting>& settings() const { return settings_; }

  /// Has the run prepared that comes next, where the value is another one. False: the key is none
  /// of these. @throws Error while something else is being prepared.
  bool set(const std::string& key, const Setting::Value& value);

 private:
  const Run& run_;
  std::vector<Setting> settings_;
};

}  // namespace palpate::app
