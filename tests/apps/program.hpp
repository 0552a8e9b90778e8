#pragma once

#include <csignal>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/folder.hpp"

namespace palpate::app {

/// What a run of the built program left behind.
struct Outcome {
  int code = -1;  ///< exit code; 128 and more: ended by a signal
  std::string out;
  std::string err;
};

/// The built program while it runs.
class Running {
 public:
  explicit Running(int process) : process_(process) {}
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Ctrl-C, or another signal; returns the exit code, once it has ended.
  int interrupt(int signal = SIGINT);

 private:
  int process_;  // 0: it has ended
};

/// A folder of its own in which the built program is run as a user does, removed at the end.
class Shell {
 public:
  /// Runs `BEFORE palpate ARGUMENTS` by the system's shell; `before`: what env(1) takes, such as
  /// NAME=VALUE or a program that starts it.
  [[nodiscard]] Outcome run(const std::string& arguments, const std::string& standard_input = "",
                            const std::string& before = "");

  /// The same, and does not wait for it; its output goes to the files `stdout` and `stderr`.
  [[nodiscard]] std::unique_ptr<Running> start(const std::string& arguments);

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const;
  [[nodiscard]] std::string read(const std::string& name) const;

 private:
  [[nodiscard]] std::string command(const std::string& arguments, const std::string& before) const;

  test::Folder folder_;
};

/// Records for so many s what a hand feels of a simulated camera: run.mcap.
[[nodiscard]] Outcome record_camera(Shell& shell, double seconds);

/// A CSV file's columns by name, as text.
[[nodiscard]] std::map<std::string, std::vector<std::string>> columns(const std::string& csv);

/// A cell of them; 0: it is no number.
[[nodiscard]] double number(const std::string& cell);

/// The log `name` in `shell` but for its column of computing times, which differ from run to run.
[[nodiscard]] std::string without_times(const Shell& shell, const std::string& name);

/// A 6 x 6 cm plane of points at z = 0, 2 mm apart, as XYZ text; with an intensity that grows along
/// x if wanted.
[[nodiscard]] std::string plane_xyz();
[[nodiscard]] std::string plane_ply_with_intensity();

/// A trajectory that comes down onto that plane, slides 3 mm deep and leaves.
[[nodiscard]] std::string press_and_slide();

}  // namespace palpate::app
