// Starts other programs, opens a browser, handles Ctrl-C.
#include "apps/palpate/cli/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace palpate::app {

namespace {

// A signal is the process's, so is what its handler can reach.
volatile std::sig_atomic_t end_requested = 0;

void request_end(int) {
  end_requested = 1;
}

bool has_desktop() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

std::filesystem::path private_folder() {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder != nullptr && *folder != '\0') return folder;
  std::error_code none;
  return std::filesystem::temp_directory_path(none);
}

bool write_all(int file, std::string_view text) {
  return ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

// A page that leads to `url`, of mode 0600; its name, or nothing.
std::string write_redirection(const std::string& url) {
  constexpr std::string_view kEnd = ".html";
  std::string name = private_folder() / fmt::format("palpate-XXXXXX{}", kEnd);
  const int file = ::mkostemps(name.data(), static_cast<int>(kEnd.size()), O_CLOEXEC);
  if (file < 0) return {};
  const bool written = write_all(
      file, fmt::format("<!doctype html>\n<meta charset=\"utf-8\">\n<title>palpate</title>\n"
                        "<meta http-equiv=\"refresh\" content=\"0; url={0}\">\n"
                        "<a href=\"{0}\">palpate</a>\n",
                        url));
  ::close(file);
  if (written) return name;
  ::unlink(name.c_str());
  return {};
}

// Between fork and exec: only what a signal's handler may do.
[[noreturn]] void become_opener(const char* file) {
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  ::execlp("xdg-open", "xdg-open", file, nullptr);
  ::_exit(127);
}

// In a session of its own, so that Ctrl-C does not reach it, and as no child of ours, so that
// nobody has to wait for its end.
void open_apart(const std::string& file) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::setsid();
    if (::fork() == 0) become_opener(file.c_str());
    ::_exit(0);
  }
  if (child > 0) ::waitpid(child, nullptr, 0);
}

}  // namespace

int run_program(const std::vector<std::string>& words, const std::string& output) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, output.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 126;
}

Interruption::Interruption() {
  end_requested = 0;
  struct sigaction action = {};
  action.sa_handler = request_end;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], &action, &before_[i]);
    const bool outlives = kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN;
    if (outlives) sigaction(kSignals[i], &before_[i], nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool Interruption::requested() const noexcept {
  return end_requested != 0;
}

Browser::Browser(const std::string& url) {
  if (!has_desktop()) return;
  file_ = write_redirection(url);
  if (!file_.empty()) open_apart(file_);
}

Browser::~Browser() {
  if (!file_.empty()) ::unlink(file_.c_str());
}

}  // namespace palpate::app
