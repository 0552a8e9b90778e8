// Reports on a whole run and draws its picture.
#include "apps/palpate/report/touch_report.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/cli/version.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/report/source_report.hpp"
#include "field/description.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::app {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kCloudPoints = 60'000;
constexpr std::size_t kWholePoints = 20'000;  // of a picture of a third of the size
constexpr std::size_t kSteps = 20'000;
constexpr double kWhole = 2.5;  // times the path: show a cloud up to this size whole
constexpr std::size_t kCloudColumns = 7;

Box bounds(const Scene& scene) {
  Box all;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(i).points();
    if (source) all.extend(source->bounds());
  }
  return all;
}

// What the picture shows: the path of hand and proxy, and some of what is around it or, unless that
// is much larger, the whole cloud.
Box view(const std::vector<ServoState>& steps, const Box& all) {
  Box box;
  for (const ServoState& step : steps) {
    box.extend(step.hip);
    box.extend(step.contact.proxy);
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

// x, y, z, normal and source of a point, relative to `from`.
void append(std::vector<float>& values, const SurfacePoints& points, std::size_t i,
            const Vector3d& from, std::size_t source) {
  const Eigen::Vector3f p =
      (points.origin + points.grid.points()[i].cast<double>() - from).cast<float>();
  const Eigen::Vector3f n = points.normals.empty() ? Eigen::Vector3f::Zero() : points.normals[i];
  values.insert(values.end(),
                {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), static_cast<float>(source)});
}

// All points, thinned evenly, to show where the view is; none where it shows them all.
std::vector<float> whole_points(const Scene& scene, const Box& all, const Box& box) {
  if (all.empty() || (box.contains(all.lower) && box.contains(all.upper))) return {};
  std::size_t count = 0;
  for (std::size_t s = 0; s < scene.size(); ++s) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(s).points();
    count += source ? source->size() : 0;
  }
  const std::size_t stride = count / kWholePoints + 1;
  std::vector<float> values;
  for (std::size_t s = 0; s < scene.size(); ++s) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(s).points();
    for (std::size_t i = 0; source && i < source->size(); i += stride) {
      append(values, *source, i, box.center(), s);
    }
  }
  return values;
}

// Points inside the view, thinned evenly.
std::vector<float> visible_points(const Scene& scene, const Box& box) {
  std::vector<float> values;
  for (std::size_t s = 0; s < scene.size(); ++s) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(s).points();
    if (!source) continue;
    for (std::size_t i = 0; i < source->size(); ++i) {
      const Vector3d world = source->origin + source->grid.points()[i].cast<double>();
      if (!box.contains(world)) continue;
      append(values, *source, i, box.center(), s);
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
  const Box all = bounds(scene);
  const Box box = view(steps_, all);
  const nlohmann::json facts = {{"title", title}, {"subtitle", subtitle}};
  draw_by_python(picture_script(),
                 {{"cloud.f32", float_bytes(visible_points(scene, box))},
                  {"whole.f32", float_bytes(whole_points(scene, all, box))},
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

HandOutputs::HandOutputs(const OutputPlan& outputs, std::size_t hand, bool turns) {
  if (!outputs.log.empty()) log_.emplace(numbered_path(outputs.log, hand), turns);
  if (!outputs.picture.empty()) picture_.emplace(numbered_path(outputs.picture, hand));
}

void HandOutputs::add(const ServoState& step, const Hand& hand) {
  statistics_.add(step);
  if (picture_) picture_->add(step);
  if (log_) log_->add(step, hand.device->info(), hand.workspace.scale);
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
  part.data = {{"topic", robot.topic}, {"waited_s", robot.waits}};
  part.row("targets", "{told} sent, {held_back} held back", robot.told, robot.held);
  for (const auto& [reason, seconds] : robot.waits) part.row("waited", "{_s}: {}", seconds, reason);
  part.row({"at last", Mark::warning}, "[{held_back_at_last}]", robot.why);
  part.data["readers"] = robot.readers;
  if (robot.readers == 0) part.note({"readers", Mark::warning}, "none now");
  return part;
}

Report report_of(const RecordReport& recorded) {
  Report part("recorded", recorded.path);
  part.data["file"] = recorded.path;
  part.row("steps", "{steps}", recorded.steps);
  part.row("frames", "[{frames}]", recorded.frames);
  part.row({"lost", Mark::warning},
           "[{?}{lost_steps} steps and {lost_frames} frames, for which the disk was too slow: a "
           "replay ends before them]",
           recorded.lost_steps + recorded.lost_frames, recorded.lost_steps, recorded.lost_frames);
  part.row({"ended", Mark::error}, "[{problem}]", recorded.problem);
  return part;
}

}  // namespace

std::string in_words(const RosBridge::RobotState& robot) {
  if (robot.readers == 0) return "robot: no subscriber to " + robot.topic;
  if (robot.retreats) return "robot GOES BACK: " + robot.why;
  if (!robot.why.empty()) return "robot WAITS: " + robot.why;
  const std::string age = robot.age > 0 ? fmt::format(", seen {:.0f} ms ago", 1e3 * robot.age) : "";
  return fmt::format("robot: {} targets{}", robot.told, age);
}

Json report_on(const TouchReport& report, std::FILE* stream) {
  const auto printed = [stream](Report part) {
    part.print(stream);
    return part.data;
  };
  Json json = {{"palpate", std::string(version())}, {"sources", Json::array()}};
  for (const LoadedSource& source : report.loaded.sources) {
    json["sources"].push_back(printed(source_report(source)));
  }
  json.update({{"preset", report.paper ? "paper" : "default"},
               {"field", name_in(kFields, report.field.kind)},
               {"stiffness_N_per_m", report.proxy.stiffness}});
  const bool alone = report.hands.size() == 1;
  for (const HandReport& each : report.hands) {
    const Json hand = printed(report_of(each, alone ? "touched" : each.hand.name));
    if (alone) json.update(hand);
    if (!alone) json["hands"].push_back(hand);
  }
  if (report.robot) json["robot"] = printed(report_of(*report.robot));
  for (const RecordReport& each : report.recorded) {
    json["recordings"].push_back(printed(report_of(each)));
  }
  return json;
}

}  // namespace palpate::app
