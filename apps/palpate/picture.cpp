#include "apps/palpate/picture.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/palpate/picture_script.hpp"
#include "apps/palpate/waiting.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/box.hpp"

namespace palpate::app {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kCloudPoints = 60'000;
constexpr std::size_t kSteps = 20'000;
constexpr double kWhole = 2.5;  // times the way: show a cloud up to this size whole
constexpr std::size_t kCloudColumns = 7;

// A folder of our own that vanishes with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "palpate-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw Error(
          fmt::format("{} cannot be made for the picture's data; set TMPDIR to a folder with "
                      "room",
                      pattern));
    }
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

void write_file(const std::string& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.close();
}

void write_floats(const std::string& path, const std::vector<float>& values) {
  write_file(path, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

// What the picture shows: the way of hand and proxy, and some of what is around it or, unless that
// is much larger, the whole cloud.
Box view(const std::vector<TouchStep>& steps, const Scene& scene) {
  Box box;
  for (const TouchStep& step : steps) {
    box.extend(step.hip);
    box.extend(step.contact.proxy);
  }
  Box all;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(i).points();
    if (!source || source->size() == 0) continue;
    all.extend(source->origin + source->grid.cells().front().lower.cast<double>());
    all.extend(source->origin + source->grid.cells().front().upper.cast<double>());
  }
  if (!all.empty() && all.size().maxCoeff() < kWhole * box.size().maxCoeff()) {
    box.extend(all.lower);
    box.extend(all.upper);
  }
  const double margin = 0.35 * box.size().maxCoeff() + 1e-3;
  box.extend(box.lower - Vector3d::Constant(margin));
  box.extend(box.upper + Vector3d::Constant(margin));
  return box;
}

// Every k-th row of a cloud's values, so that few enough are left.
std::vector<float> thinned(const std::vector<float>& values) {
  const std::size_t count = values.size() / kCloudColumns;
  const std::size_t stride = count / kCloudPoints + 1;
  if (stride == 1) return values;
  std::vector<float> result;
  for (std::size_t i = 0; i < count; i += stride) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(kCloudColumns * i);
    result.insert(result.end(), row, row + kCloudColumns);
  }
  return result;
}

// x, y, z, normal and source of points inside the view, thinned evenly.
std::vector<float> visible_points(const Scene& scene, const Box& box) {
  std::vector<float> values;
  for (std::size_t s = 0; s < scene.size(); ++s) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(s).points();
    if (!source) continue;
    for (std::size_t i = 0; i < source->size(); ++i) {
      const Vector3d world = source->origin + source->grid.points()[i].cast<double>();
      if (!box.contains(world)) continue;
      const Eigen::Vector3f p = (world - box.center()).cast<float>();
      const Eigen::Vector3f n =
          source->normals.empty() ? Eigen::Vector3f::Zero() : source->normals[i];
      values.insert(values.end(),
                    {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), static_cast<float>(s)});
    }
  }
  return thinned(values);
}

std::vector<float> step_rows(const std::vector<TouchStep>& steps, const Box& box) {
  const std::size_t stride = steps.size() / kSteps + 1;
  std::vector<float> values;
  for (std::size_t i = 0; i < steps.size(); i += stride) {
    const TouchStep& s = steps[i];
    const Vector3d h = s.hip - box.center();
    const Vector3d p = s.contact.proxy - box.center();
    const Vector3d& f = s.contact.force;
    for (const double v : {s.time - steps.front().time, h.x(), h.y(), h.z(), p.x(), p.y(), p.z(),
                           f.x(), f.y(), f.z(), s.contact.touching ? 1.0 : 0.0, s.microseconds}) {
      values.push_back(static_cast<float>(v));
    }
  }
  return values;
}

std::string read_text(const std::string& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Debian's own Python first: that is the one python3-matplotlib belongs to.
std::string python() {
  const char* debian = "/usr/bin/python3";
  return access(debian, X_OK) == 0 ? debian : "python3";
}

// Runs a program, with its complaints in a file, and returns its exit code; 127: it is not there.
int run(const std::vector<std::string>& words, const std::string& complaints) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, complaints.c_str(),
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

// The last line that says something: Python's own error.
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

void Picture::draw(const Scene& scene, const std::string& title, const std::string& subtitle) {
  if (steps_.empty()) throw Error("there is no picture of a run without steps");
  const Waiting waiting("drawing the picture");
  const TemporaryFolder folder;
  const Box box = view(steps_, scene);
  write_floats(folder.file("cloud.f32"), visible_points(scene, box));
  write_floats(folder.file("steps.f32"), step_rows(steps_, box));
  write_file(folder.file("draw.py"), picture_script());
  const nlohmann::json facts = {{"title", title}, {"subtitle", subtitle}};
  write_file(folder.file("facts.json"), facts.dump());
  const std::string complaints = folder.file("complaints.txt");
  const int code =
      run({python(), "-B", folder.file("draw.py"), folder.file(""), file_.growing()}, complaints);
  if (code == 0) return file_.close();
  if (code == 127 || code == 3) {
    throw Error(
        fmt::format("{} was not drawn: Python 3 with matplotlib is missing; install it with "
                    "'apt install python3-matplotlib' (everything else was written)",
                    path_));
  }
  throw Error(fmt::format("{} was not drawn: {} (everything else was written)", path_,
                          last_line(read_text(complaints))));
}

}  // namespace palpate::app
