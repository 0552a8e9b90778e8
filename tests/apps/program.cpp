#include "apps/program.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

namespace palpate::app {

namespace {

constexpr int kSide = 31;

double coordinate(int i) {
  return 2e-3 * (i - kSide / 2);
}

int code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Running::~Running() {
  if (process_ != 0) interrupt();
}

int Running::interrupt(int signal) {
  int status = 0;
  kill(process_, signal);
  waitpid(std::exchange(process_, 0), &status, 0);
  return code_of(status);
}

std::string Shell::command(const std::string& arguments, const std::string& before) const {
  return fmt::format("cd '{}' && exec env {} '{}' {} < stdin > stdout 2> stderr",
                     folder_.path().string(), before, PALPATE_PROGRAM, arguments);
}

std::unique_ptr<Running> Shell::start(const std::string& arguments) {
  write("stdin", "");
  write("stderr", "");
  const std::string words = command(arguments, "");
  const pid_t process = fork();
  if (process == 0) {
    execl("/bin/sh", "sh", "-c", words.c_str(), nullptr);
    _exit(127);
  }
  return std::make_unique<Running>(process);
}

Outcome Shell::run(const std::string& arguments, const std::string& standard_input,
                   const std::string& before) {
  write("stdin", standard_input);
  const int status = std::system(command(arguments, before).c_str());
  Outcome outcome;
  outcome.code = code_of(status);
  outcome.out = read("stdout");
  outcome.err = read("stderr");
  return outcome;
}

void Shell::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

std::string Shell::read(const std::string& name) const {
  std::ostringstream text;
  text << std::ifstream(path(name), std::ios::binary).rdbuf();
  return text.str();
}

Outcome record_camera(Shell& shell, double seconds) {
  return shell.run(
      fmt::format("touch camera:simulated --simulated-time --duration {} --no-view --record "
                  "run.mcap",
                  seconds));
}

std::map<std::string, std::vector<std::string>> columns(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  std::map<std::string, std::vector<std::string>> result;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::size_t place = 0;
    for (std::string cell; std::getline(cells, cell, ',');)
      result[names.at(place++)].push_back(cell);
  }
  return result;
}

double number(const std::string& cell) {
  return std::strtod(cell.c_str(), nullptr);
}

std::string without_times(const Shell& shell, const std::string& name) {
  std::string text;
  for (const auto& [column, cells] : columns(shell.read(name))) {
    if (column == "us") continue;
    text += column;
    for (const std::string& cell : cells) text += "," + cell;
    text += "\n";
  }
  return text;
}

std::string plane_xyz() {
  std::string text;
  for (int i = 0; i < kSide * kSide; ++i) {
    text += fmt::format("{} {} 0\n", coordinate(i % kSide), coordinate(i / kSide));
  }
  return text;
}

std::string plane_ply_with_intensity() {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nproperty float intensity\nend_header\n",
      kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) {
    text += fmt::format("{} {} 0 {}\n", coordinate(i % kSide), coordinate(i / kSide), i % kSide);
  }
  return text;
}

std::string press_and_slide() {
  std::string text = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 400; ++i) {
    const double z = i < 100 ? 0.01 - 1.3e-4 * i : i < 300 ? -3e-3 : -3e-3 + 1.3e-4 * (i - 300);
    const double x = 1e-4 * std::clamp(i - 200, -100, 100);
    text += fmt::format("{},{},0.0003,{}\n", 1e-3 * i, x, z);
  }
  return text;
}

}  // namespace palpate::app
