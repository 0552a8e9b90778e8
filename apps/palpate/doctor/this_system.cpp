#include "apps/palpate/doctor/this_system.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <grp.h>
#include <langinfo.h>
#include <locale.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <thread>

#include "apps/palpate/cli/child_program.hpp"
#include "apps/palpate/doctor/library_trial.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/sensor/open_camera.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app::doctor {

namespace fs = std::filesystem;

namespace {

constexpr double kJitterPeriod = 1e-3;  // s
constexpr int kServicePatience = 300;   // ms, until a service has taken a connection

std::map<std::string, std::string> environment() {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view words(*entry);
    const std::size_t equals = words.find('=');
    if (equals == std::string_view::npos) continue;
    variables.emplace(words.substr(0, equals), words.substr(equals + 1));
  }
  return variables;
}

std::string group_name(gid_t id) {
  const group* found = getgrgid(id);
  return found == nullptr ? std::to_string(id) : found->gr_name;
}

std::set<std::string> own_groups() {
  std::vector<gid_t> ids(static_cast<std::size_t>(std::max(getgroups(0, nullptr), 0)));
  const int count = getgroups(static_cast<int>(ids.size()), ids.data());
  ids.resize(static_cast<std::size_t>(std::max(count, 0)));
  std::set<std::string> names{group_name(getegid())};
  for (const gid_t id : ids) names.insert(group_name(id));
  return names;
}

// Beside the program, built or installed: bin/../share/palpate.
fs::path share() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return (program.parent_path() / "../share/palpate").lexically_normal();
}

void keep_time(double seconds, RealtimeTrial& trial) {
  SteadyWaitingClock clock;
  Histogram lateness;
  const double start = clock.now();
  Deadlines deadlines(start, kJitterPeriod);
  while (deadlines.next() < start + seconds) {
    clock.wait_until(deadlines.next());
    lateness.add(deadlines.begin(clock.now()));
  }
  trial.lateness = lateness.look();
  trial.left_out = deadlines.skipped();
}

// On a thread of its own, which takes its priority with it; memory is given free again.
RealtimeTrial try_realtime(double seconds) {
  RealtimeTrial trial;
  std::jthread([&] {
    trial.report = make_realtime({});
    if (seconds > 0) keep_time(seconds, trial);
  }).join();
  munlockall();
  return trial;
}

Node node(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  constexpr mode_t kGroup = S_IRGRP | S_IWGRP;
  return {.there = true,
          .may_open = faccessat(AT_FDCWD, path.c_str(), R_OK | W_OK, AT_EACCESS) == 0,
          .group_may = (status.st_mode & kGroup) == kGroup,
          .group = group_name(status.st_gid)};
}

bool listens(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) return false;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool begun =
      connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
      errno == EINPROGRESS;
  pollfd waiting{.fd = socket, .events = POLLOUT, .revents = 0};
  int error = 1;
  socklen_t size = sizeof error;
  if (begun && poll(&waiting, 1, kServicePatience) == 1) {
    getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  close(socket);
  return error == 0;
}

std::optional<std::string> decimal_point(const std::string& name) {
  const locale_t locale = newlocale(LC_ALL_MASK, name.c_str(), nullptr);
  if (locale == nullptr) return std::nullopt;
  std::string point = nl_langinfo_l(RADIXCHAR, locale);
  freelocale(locale);
  return point;
}

}  // namespace

System this_system() {
  return {.root = "/",
          .share = share(),
          .variables = environment(),
          .groups = own_groups(),
          .try_realtime = try_realtime,
          .cameras = list_cameras,
          .node = node,
          .try_library = try_library,
          .listens = listens,
          .decimal_point = decimal_point,
          .succeeds = [](const std::vector<std::string>& command) {
            return run_program(command, "/dev/null") == 0;
          }};
}

}  // namespace palpate::app::doctor
