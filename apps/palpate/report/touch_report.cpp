#include "apps/palpate/report/touch_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/cli/version.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/report/report.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::app {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kCloudPoints = 60'000;
constexpr std::size_t kSteps = 20'000;
constexpr double kWhole = 2.5;  // times the way: show a cloud up to this size whole
constexpr std::size_t kCloudColumns = 7;

// What the picture shows: the way of hand and proxy, and some of what is around it or, unless that
// is much larger, the whole cloud.
Box view(const std::vector<ServoState>& steps, const Scene& scene) {
  Box box;
  for (const ServoState& step : steps) {
    box.extend(step.hip);
    box.extend(step.contact.proxy);
  }
  Box all;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(i).points();
    if (source) all.extend(source->bounds());
  }
  if (!all.empty() && all.size().maxCoeff() < kWhole * box.size().maxCoeff()) {
    box.extend(all);
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

std::vector<float> step_rows(const std::vector<ServoState>& steps, const Box& box) {
  const std::size_t stride = steps.size() / kSteps + 1;
  std::vector<float> values;
  for (std::size_t i = 0; i < steps.size(); i += stride) {
    const ServoState& s = steps[i];
    const Vector3d h = s.hip - box.center();
    const Vector3d p = s.contact.proxy - box.center();
    const Vector3d& f = s.force;
    for (const double v :
         {s.time - steps.front().time, h.x(), h.y(), h.z(), p.x(), p.y(), p.z(), f.x(), f.y(),
          f.z(), s.contact.touching ? 1.0 : 0.0, 1e6 * s.timing.computing}) {
      values.push_back(static_cast<float>(v));
    }
  }
  return values;
}

}  // namespace

void Picture::draw(const Scene& scene, const std::string& title, const std::string& subtitle) {
  if (steps_.empty()) throw Error("cannot draw a picture of a run without steps");
  const Waiting waiting("drawing the picture");
  const Box box = view(steps_, scene);
  const nlohmann::json facts = {{"title", title}, {"subtitle", subtitle}};
  draw_by_python(picture_script(),
                 {{"cloud.f32", float_bytes(visible_points(scene, box))},
                  {"steps.f32", float_bytes(step_rows(steps_, box))},
                  {"facts.json", facts.dump()}},
                 path_, file_);
}

namespace {

std::string subtitle(const HandReport& report) {
  const TouchStatistics& s = report.statistics;
  return fmt::format(
      "{} field, K = {:.4g} N/m, {} steps in {:.3g} s, {} contact{}, energy given to the "
      "hand {}",
      name_in(kFields, report.field.kind), report.stiffness, grouped(s.steps()), s.duration(),
      grouped(s.contacts()), s.contacts() == 1 ? "" : "s", energy(energy_at_hand(report).given));
}

}  // namespace

HandOutputs::HandOutputs(const OutputPlan& outputs, std::size_t hand) {
  if (!outputs.log.empty()) log_.emplace(numbered_path(outputs.log, hand));
  if (!outputs.picture.empty()) picture_.emplace(numbered_path(outputs.picture, hand));
}

void HandOutputs::add(const ServoState& step, const DeviceInfo& device) {
  statistics_.add(step);
  if (picture_) picture_->add(step);
  if (log_) log_->add(step, device);
}

std::string HandOutputs::close_log() {
  try {
    if (log_) log_->close();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

void HandOutputs::draw(const Scene& scene, const std::string& title, const HandReport& report) {
  if (picture_) picture_->draw(scene, title, subtitle(report));
}

namespace {

Report report_of(const RosBridge::RobotState& robot) {
  Report part("robot", robot.topic);
  part.line("targets",
            fmt::format("{} told, {} held back", grouped(robot.told), grouped(robot.held)));
  for (const auto& [reason, seconds] : robot.waits) {
    part.line("waited", fmt::format("{:.1f} s: {}", seconds, reason));
  }
  if (!robot.why.empty()) part.line("at last", robot.why, Mark::warning);
  if (robot.readers == 0) part.line("readers", "none now", Mark::warning);
  part.data = {{"topic", robot.topic},    {"told", robot.told},
               {"held_back", robot.held}, {"held_back_at_last", robot.why},
               {"waited_s", robot.waits}, {"readers", robot.readers}};
  return part;
}

Report report_of(const RecordReport& recorded) {
  Report part("recorded", recorded.path);
  part.line("steps", grouped(recorded.steps));
  if (recorded.frames > 0) part.line("frames", grouped(recorded.frames));
  if (recorded.lost_steps + recorded.lost_frames > 0) {
    part.line("lost",
              fmt::format("{} steps and {} frames, for which the disk was too slow: a replay ends "
                          "before them",
                          grouped(recorded.lost_steps), grouped(recorded.lost_frames)),
              Mark::warning);
  }
  if (!recorded.problem.empty()) part.line("ended", recorded.problem, Mark::error);
  part.data = {{"file", recorded.path},
               {"steps", recorded.steps},
               {"frames", recorded.frames},
               {"lost_steps", recorded.lost_steps},
               {"lost_frames", recorded.lost_frames},
               {"problem", recorded.problem}};
  return part;
}

}  // namespace

std::string in_words(const RosBridge::RobotState& robot) {
  if (robot.readers == 0) return "robot: no subscriber to " + robot.topic;
  if (robot.retreats) return "robot GOES BACK: " + robot.why;
  if (!robot.why.empty()) return "robot WAITS: " + robot.why;
  return fmt::format("robot: {} targets", robot.told);
}

// What is of a hand stands beside what is of the run where there is one hand, else under "hands".
Json report_on(const TouchReport& report, std::FILE* stream) {
  Json sources = Json::array();
  for (const LoadedSource& source : report.loaded.sources) {
    const Report part = source_report(source);
    part.print(stream);
    sources.push_back(part.data);
  }
  Json json = {{"palpate", std::string(version())},
               {"sources", sources},
               {"preset", report.paper ? "paper" : "default"},
               {"field", name_in(kFields, report.field.kind)},
               {"stiffness_N_per_m", report.proxy.stiffness}};
  const bool alone = report.hands.size() == 1;
  for (const HandReport& each : report.hands) {
    Report part = report_of(each, alone ? "touched" : each.hand.name);
    if (!each.unlogged.empty()) part.line("log", each.unlogged, Mark::error);
    if (!each.unlogged.empty()) part.data["log_problem"] = each.unlogged;
    part.print(stream);
    if (alone) {
      json.update(part.data);
    } else {
      json["hands"].push_back(part.data);
    }
  }
  if (report.robot) {
    const Report part = report_of(*report.robot);
    part.print(stream);
    json["robot"] = part.data;
  }
  for (const RecordReport& each : report.recorded) {
    const Report part = report_of(each);
    part.print(stream);
    json["recordings"].push_back(part.data);
  }
  return json;
}

}  // namespace palpate::app
