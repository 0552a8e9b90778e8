// The real system behind the doctor's checks.
#include "apps/palpate/doctor/system.hpp"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <langinfo.h>
#include <link.h>
#include <locale.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>

#include "apps/palpate/cli/process.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
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
  SteadyClock clock;
  Durations lateness;
  const double start = clock.now();
  ServoThread::Deadlines deadlines(start, kJitterPeriod);
  while (deadlines.next() < start + seconds) {
    clock.wait_until(deadlines.next());
    lateness.add(deadlines.begin(clock.now()));
  }
  trial.lateness = lateness;
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

constexpr unsigned kPatience = 10;  // s
constexpr char kLoaded = 'l';       // the first character of what the other process reports
constexpr char kNotLoaded = 'n';

// "3.4.0" where the loaded file is "libHD.so.3.4.0".
std::string version_in_name(void* library) {
  link_map* map = nullptr;
  if (::dlinfo(library, RTLD_DI_LINKMAP, static_cast<void*>(&map)) != 0) return "";
  std::error_code none;
  const std::string name = std::filesystem::canonical(map->l_name, none).filename().string();
  const std::size_t end = name.find(".so.");
  return end == std::string::npos ? "" : name.substr(end + 4);
}

std::string version_of(void* library) {
  using Version = void(int*, int*, int*, int*);
  auto* const version = reinterpret_cast<Version*>(::dlsym(library, "dhdGetSDKVersion"));
  if (version == nullptr) return version_in_name(library);
  int major = 0;
  int minor = 0;
  int release = 0;
  int revision = 0;
  version(&major, &minor, &release, &revision);
  return fmt::format("{}.{}.{}.{}", major, minor, release, revision);
}

std::string loaded(const std::string& name) {
  void* library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library != nullptr) return kLoaded + version_of(library);
  const char* error = ::dlerror();
  return kNotLoaded + std::string(error == nullptr ? "no reason given" : error);
}

// Drops what libraries print.
void be_silent() {
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
}

[[noreturn]] void load_and_report(const std::string& name, int pipe) {
  be_silent();
  ::alarm(kPatience);
  const std::string reply = loaded(name);
  const ssize_t written = ::write(pipe, reply.data(), reply.size());
  _exit(written < 0 ? 1 : 0);
}

std::string read_all(int pipe) {
  std::string reply;
  std::array<char, 512> part;
  for (;;) {
    const ssize_t count = ::read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return reply;
    reply.append(part.data(), static_cast<std::size_t>(count));
  }
}

// Why a process died that reported nothing.
std::string death(int status) {
  if (!WIFSIGNALED(status))
    return fmt::format("it exits the program (exit code {})", WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGALRM) return fmt::format("it hangs (for {} s)", kPatience);
  return fmt::format("it crashes (signal {})", WTERMSIG(status));
}

}  // namespace

LibraryTrial try_library(const std::string& name) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error("doctor: cannot create a pipe; close other programs");
  const pid_t child = fork();
  if (child == 0) load_and_report(name, ends[1]);
  ::close(ends[1]);
  const std::string reply = child > 0 ? read_all(ends[0]) : "";
  ::close(ends[0]);
  if (child < 0) throw Error("doctor: cannot start a process; close other programs");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (reply.empty()) return {LibraryTrial::Outcome::broken, death(status)};
  const std::string words = reply.substr(1);
  if (reply.front() == kLoaded) return {LibraryTrial::Outcome::loaded, words};
  const bool absent = words.starts_with(name + ": cannot open shared object file");
  return {absent ? LibraryTrial::Outcome::absent : LibraryTrial::Outcome::broken, words};
}

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

std::optional<std::string> text(const System& system, const std::string& path) {
  std::ifstream stream(system.root / path);
  if (!stream) return std::nullopt;
  std::ostringstream content;
  content << stream.rdbuf();
  std::string result = content.str();
  while (result.ends_with('\n')) result.pop_back();
  return result;
}

std::optional<long> whole_number(const System& system, const std::string& path) {
  const std::optional<std::string> digits = text(system, path);
  if (!digits) return std::nullopt;
  long value = 0;
  std::from_chars(digits->data(), digits->data() + digits->size(), value);
  return value;
}

bool is_there(const System& system, const std::string& path) {
  std::error_code ignored;
  return fs::exists(system.root / path, ignored);
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> result;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    result.push_back(entry->path());
  }
  std::ranges::sort(result);
  return result;
}

std::string variable(const System& system, const std::string& name) {
  const auto found = system.variables.find(name);
  return found == system.variables.end() ? "" : found->second;
}

bool in_container(const System& system) {
  return is_there(system, ".dockerenv") || is_there(system, "run/.containerenv");
}

bool is_ubuntu(const System& system) {
  return text(system, "etc/os-release").value_or("").find("ID=ubuntu") != std::string::npos;
}

}  // namespace palpate::app::doctor
