#include "apps/palpate/doctor/library_trial.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>

#include "palpate/base/error.hpp"

namespace palpate::app::doctor {

namespace {

constexpr unsigned kPatience = 10;  // s
constexpr char kLoaded = 'l';       // the first character of what the other process tells
constexpr char kNotLoaded = 'n';

// Of "libHD.so.3.4.0", the file that was loaded: 3.4.0.
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

// What libraries print is not the doctor's.
void be_silent() {
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
}

[[noreturn]] void load_and_tell(const std::string& name, int pipe) {
  be_silent();
  ::alarm(kPatience);
  const std::string told = loaded(name);
  const ssize_t written = ::write(pipe, told.data(), told.size());
  _exit(written < 0 ? 1 : 0);
}

std::string read_all(int pipe) {
  std::string told;
  std::array<char, 512> part;
  for (;;) {
    const ssize_t count = ::read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return told;
    told.append(part.data(), static_cast<std::size_t>(count));
  }
}

// What a process that told nothing died of.
std::string death(int status) {
  if (!WIFSIGNALED(status))
    return fmt::format("it ends the program (exit code {})", WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGALRM) return fmt::format("it hangs ({} s)", kPatience);
  return fmt::format("it crashes (signal {})", WTERMSIG(status));
}

}  // namespace

LibraryTrial try_library(const std::string& name) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error("doctor: no pipe; end other programs");
  const pid_t child = fork();
  if (child == 0) load_and_tell(name, ends[1]);
  ::close(ends[1]);
  const std::string told = child > 0 ? read_all(ends[0]) : "";
  ::close(ends[0]);
  if (child < 0) throw Error("doctor: the system gives no process; end other programs");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (told.empty()) return {LibraryTrial::Outcome::broken, death(status)};
  const std::string words = told.substr(1);
  if (told.front() == kLoaded) return {LibraryTrial::Outcome::loaded, words};
  const bool absent = words.starts_with(name + ": cannot open shared object file");
  return {absent ? LibraryTrial::Outcome::absent : LibraryTrial::Outcome::broken, words};
}

}  // namespace palpate::app::doctor
