// Draws pictures by Python scripts that travel inside the program.
#include "apps/palpate/plot/python_drawing.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/cli/temporary_folder.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

std::string read_text(const std::string& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The last line with text: Python's own error.
std::string last_line(const std::string& text) {
  std::istringstream stream(text);
  std::string line;
  std::string last;
  while (std::getline(stream, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

std::string drawing_python() {
  const char* debian = "/usr/bin/python3";
  return access(debian, X_OK) == 0 ? debian : "python3";
}

std::vector<std::string> drawing_trial() {
  return {drawing_python(), "-c",
          "import importlib.util, sys; sys.exit(importlib.util.find_spec('matplotlib') is None)"};
}

void check_picture(const std::string& path) {
  if (path.empty()) return;
  if (path == "-") {
    throw UsageError("--picture cannot go to standard output; name a file, e.g. a.png");
  }
  const std::filesystem::path file(path);
  const std::string ending = file.extension().string();
  if (!ending.empty() && ending != ".png" && ending != ".PNG") {
    throw UsageError(fmt::format("--picture {}: pictures are PNG; name it {}", path,
                                 std::filesystem::path(file).replace_extension(".png").string()));
  }
  const TemporaryFolder possible;
  if (run_program(drawing_trial(), "/dev/null") == 0) return;
  throw Error(
      fmt::format("{} cannot be drawn: Python 3 with matplotlib is missing; install it with 'apt "
                  "install python3-matplotlib', or remove --picture",
                  path));
}

std::string float_bytes(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

void draw_by_python(std::string_view script, const std::vector<DrawingData>& data,
                    const std::string& path, OutputFile& picture) {
  const TemporaryFolder folder;
  for (const DrawingData& each : data) folder.write(each.name, each.bytes);
  folder.write("drawing.py", drawing_script());
  const std::string program = folder.write("draw.py", script);
  const std::string complaints = folder.file("complaints.txt");
  const int code = run_program(
      {drawing_python(), "-B", program, folder.file(""), picture.growing()}, complaints);
  if (code == 0) return picture.close();
  if (code == 127 || code == 3) {
    throw Error(
        fmt::format("{} was not drawn: Python 3 with matplotlib is missing; install it with "
                    "'apt install python3-matplotlib' (everything else was written)",
                    path));
  }
  throw Error(fmt::format("{} was not drawn: {} (everything else was written)", path,
                          last_line(read_text(complaints))));
}

FigureFiles::FigureFiles(const std::string& csv, const std::string& json,
                         const std::string& picture)
    : picture_path_(picture) {
  check_distinct({}, {{"--csv", csv}, {"--json", json}, {"--picture", picture}});
  check_picture(picture);
  if (!csv.empty()) csv_.emplace(csv);
  if (!json.empty()) json_.emplace(json);
  if (!picture.empty()) picture_.emplace(picture);
}

void FigureFiles::write(const std::string& table, const Json& facts) {
  write_whole(csv_, table);
  write_whole(json_, text_of(facts));
  if (!picture_) return;
  const Waiting waiting("drawing the picture");
  draw_by_python(figures_script(), {{"facts.json", text_of(facts)}, {"table.csv", table}},
                 picture_path_, *picture_);
}

}  // namespace palpate::app
