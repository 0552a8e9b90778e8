#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "palpate/base/driver_info.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app::doctor {

/// Timing of a loop at 1 kHz on a thread with the same requests as a servo's.
struct RealtimeTrial {
  RealtimeReport report;
  Durations lateness;
  std::size_t left_out = 0;  ///< steps that the one before them made impossible
};

/// Result of loading a library.
struct LibraryTrial {
  enum class Outcome { loaded, absent, broken };
  Outcome outcome = Outcome::absent;
  std::string words = {};  ///< its version, if it reports one; the loader's words, if it is broken
};

/// A file such as a device's, as this user sees it.
struct Node {
  bool there = false;
  bool may_open = false;  ///< for reading and writing
  bool group_may = false;
  std::string group = {};
};

/// A machine as the checks see it: files under a root, and functions for what files do not show.
/// They use nothing else, so that tests can make up any machine.
struct System {
  std::filesystem::path root = "/";              ///< of /dev, /etc, /proc, /sys, /usr
  std::filesystem::path share;                   ///< where palpate's rules for udev and limits lie
  std::map<std::string, std::string> variables;  ///< of the environment
  std::set<std::string> groups;                  ///< of this process

  std::function<RealtimeTrial(double seconds)> try_realtime;
  std::function<std::vector<DriverInfo>()> cameras;
  std::function<Node(const std::filesystem::path&)> node;  ///< given with the root
  std::function<LibraryTrial(const std::string& name)> try_library;
  std::function<bool(int port)> listens;  ///< does somebody on 127.0.0.1?
  /// A locale's decimal point; nothing where there is no such locale.
  std::function<std::optional<std::string>(const std::string& locale)> decimal_point;
  std::function<bool(const std::vector<std::string>& command)> succeeds;
};

/// The machine that the program runs on.
[[nodiscard]] System this_system();

/// Loads a library in a process of its own, which may crash or hang (10 s) without harm, and reads
/// its version where it is Force Dimension's. @throws Error when there can be no other process.
[[nodiscard]] LibraryTrial try_library(const std::string& name);

/// A file's text without the last line's end; nothing where it cannot be read.
[[nodiscard]] std::optional<std::string> text(const System& system, const std::string& path);
/// The whole number that a file of /proc or /sys begins with, 0 where there is none; nothing where
/// it cannot be read.
[[nodiscard]] std::optional<long> whole_number(const System& system, const std::string& path);
[[nodiscard]] bool is_there(const System& system, const std::string& path);
/// The entries of a folder, sorted; empty if it does not exist.
[[nodiscard]] std::vector<std::filesystem::path> entries(const std::filesystem::path& folder);
/// An environment variable; empty if it is not set.
[[nodiscard]] std::string variable(const System& system, const std::string& name);

/// The limits where logins read them; a package puts them there, or a command of the doctor's.
inline constexpr const char* kLimits = "etc/security/limits.d/palpate-limits.conf";

/// The command that mounts /sys.
inline constexpr const char* kMountSys = "sudo mount -t sysfs sysfs /sys";

/// Is this a container, whose limits and devices are set where it is started?
[[nodiscard]] bool in_container(const System& system);
/// Ubuntu rather than Debian: a few packages are named otherwise.
[[nodiscard]] bool is_ubuntu(const System& system);

}  // namespace palpate::app::doctor
