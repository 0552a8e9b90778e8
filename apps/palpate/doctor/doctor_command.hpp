#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate doctor`.
struct DoctorOptions {
  double jitter = 2;  ///< s to measure for; 0: not at all
  std::string json;
};

void add_doctor_options(CLI::App& command, DoctorOptions& options);

/// `palpate doctor`. Returns the exit code: 0, 1 or 3. @throws Error.
[[nodiscard]] int examine(const DoctorOptions& options);

}  // namespace palpate::app
