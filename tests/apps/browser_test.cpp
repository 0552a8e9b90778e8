#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>

#include "apps/palpate/cli/process.hpp"
#include "support/folder.hpp"

namespace palpate::app {
namespace {

constexpr const char* kUrl = "http://127.0.0.1:8420/#secret";

/// A variable of the environment for a while.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// A desktop whose xdg-open writes down how it was called.
class BrowserTest : public testing::Test {
 protected:
  BrowserTest() {
    folder_.write("bin/xdg-open", fmt::format("#!/bin/sh\n"
                                              "cd '{}'\n"
                                              "echo \"$*\" > arguments\n"
                                              "stat -c %a \"$1\" > mode\n"
                                              "cat \"$1\" > page\n"
                                              "readlink /proc/$$/fd/0 > input\n"
                                              "cut -d' ' -f6 /proc/$$/stat > session\n"
                                              "touch done\n",
                                              folder_.path().string()));
    std::filesystem::permissions(folder_ / "bin/xdg-open", std::filesystem::perms::owner_all);
    std::filesystem::create_directory(folder_ / "runtime");
  }

  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void wait_for_opener() const {
    while (!std::filesystem::exists(folder_ / "done")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  test::Folder folder_;
  Variable display_{"DISPLAY", ":0"};
  Variable runtime_{"XDG_RUNTIME_DIR", folder_ / "runtime"};
  Variable path_{"PATH", folder_ / "bin" + ":" + std::getenv("PATH")};
};

TEST_F(BrowserTest, IsLedThereByAFileThatThePersonAloneMayRead) {
  {
    const Browser browser(kUrl);
    wait_for_opener();
  }
  EXPECT_EQ(read("arguments").find("secret"), std::string::npos) << read("arguments");
  EXPECT_TRUE(read("arguments").starts_with(folder_ / "runtime")) << read("arguments");
  EXPECT_EQ(read("mode"), "600\n");
  EXPECT_NE(read("page").find(fmt::format("url={}\"", kUrl)), std::string::npos) << read("page");
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "runtime")) << "removed at the end";
}

TEST_F(BrowserTest, IsOutOfReachOfTheTerminalAndNobodysChild) {
  const Browser browser(kUrl);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  wait_for_opener();
  EXPECT_EQ(read("input"), "/dev/null\n");
  EXPECT_NE(read("session"), fmt::format("{}\n", ::getsid(0)));
}

TEST_F(BrowserTest, NothingHappensWithoutADesktopOrAPlaceForTheFile) {
  {
    const Variable absent("XDG_RUNTIME_DIR", folder_ / "absent");
    const Browser browser(kUrl);
  }
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  const Browser browser(kUrl);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "runtime"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "done"));
}

}  // namespace
}  // namespace palpate::app
