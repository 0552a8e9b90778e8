// Reports a run to pages, and does what they request.
#include "viewer/run_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/geometry/shapes.hpp"
#include "scene/bounds.hpp"
#include "viewer/access.hpp"
#include "viewer/upright.hpp"

namespace palpate::viewer {
namespace {

constexpr double kEmptyRadius = 1;  // m, shown while there are no points (judgement)

// Around the points of every source's newest surface; empty where there are none.
Box scene_box(const Scene& scene) {
  Box box;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    box.extend(bounds_of(scene.source(i)));
  }
  return box;
}

// Centre of all points or, while there are none, of the sensors.
Eigen::Vector3d middle(const Scene& scene) {
  const Box box = scene_box(scene);
  if (!box.empty()) return box.center();
  Box sensors;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    sensors.extend(scene.source(i).pose().translation());
  }
  return sensors.empty() ? Eigen::Vector3d::Zero().eval() : sensors.center();
}

ViewerOptions complete(ViewerOptions options, const Scene& scene) {
  if (options.token.empty()) options.token = make_token();
  if (!is_token(options.token)) {
    throw Error(
        fmt::format("viewer: a token of {} bytes that is not valid in a URL; give 1 to {} letters, "
                    "digits or any of -._~, or none",
                    options.token.size(), kLongestWord));
  }
  if (!options.origin) options.origin = middle(scene);
  if (!options.up) options.up = likely_up(scene);
  return options;
}

ViewerControls complete(ViewerControls controls, const std::vector<Servo*>& servos) {
  if (controls.time_line) return controls;
  if (!controls.pause) {
    controls.pause = [servos](bool on) {
      for (Servo* servo : servos) servo->pause(on);
    };
  }
  if (!controls.reset) {
    controls.reset = [servos](std::optional<std::size_t> hand) {
      for (std::size_t i = 0; i < servos.size(); ++i) {
        if (i == hand.value_or(i)) servos[i]->reset();
      }
    };
  }
  return controls;
}

std::vector<DeviceLabel> labels_of(const std::vector<Servo*>& servos,
                                   const ViewerControls& controls) {
  if (servos.size() > std::numeric_limits<std::uint8_t>::max()) {
    throw Error(fmt::format("viewer: {} servos; give at most 255", servos.size()));
  }
  const std::vector<std::string> names = tool_names(servos);
  std::vector<DeviceLabel> labels;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    const bool takeable = controls.hand && (!controls.takeable || controls.takeable(i));
    labels.push_back(
        {names[i], takeable, controls.scale ? controls.scale(i) : 1, servos[i]->options().tool});
  }
  return labels;
}

}  // namespace

RunView::RunView(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
                 ViewerControls controls)
    : scene_(scene),
      servos_(std::move(servos)),
      names_(tool_names(servos_)),
      options_(complete(options, scene)),
      run_(make_token()),
      sessions_(sessions_options(complete(std::move(controls), servos_))),
      radii_(servos_.size(), 0.0) {
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    states_.emplace_back(*servos_[i], i, *options_.origin);
  }
}

ClientSessionsOptions RunView::sessions_options(const ViewerControls& controls) {
  return {options_.token,   options_.limits,
          controls,         labels_of(servos_, controls),
          *options_.origin, [this] { return welcome(); }};
}

SceneEncoderOptions RunView::encoding() const {
  return {servos_, *options_.origin, options_.streams, options_.robot};
}

std::vector<ViewedStream> RunView::streams() const {
  return options_.streams ? options_.streams() : std::vector<ViewedStream>{};
}

Welcome RunView::welcome() {
  const Box box = scene_box(scene_);
  Welcome welcome;
  welcome.run = run_;
  welcome.scene = options_.scene;
  welcome.origin = *options_.origin;
  welcome.up = *options_.up;
  if (options_.eye) welcome.eye = *options_.eye - *options_.origin;
  welcome.radius = box.empty() ? kEmptyRadius : 0.5 * box.size().norm();
  const std::vector<ViewedStream> seen = streams();
  for (std::size_t i = 0; i < scene_.size(); ++i) {
    const std::string& name = scene_.source(i).name();
    const bool camera = std::ranges::any_of(seen, [&](const ViewedStream& stream) {
      return stream.state.source == name && stream.frustum;
    });
    welcome.sources.push_back({name, camera});
  }
  check_faults(seen);
  welcome.notices = notices_.present();
  if (progress_) welcome.notices.push_back(*progress_);
  return welcome;
}

void RunView::check_faults(const std::vector<ViewedStream>& streams) {
  std::vector<DeviceFault> faults;
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    faults.push_back({names_[i], servos_[i]->state().guard.fault});
  }
  for (const Notice& notice : notices_.update(streams, faults)) sessions_.send(notice);
}

void RunView::send_faults() {
  if (sessions_.greeted().empty()) return;
  check_faults(streams());
  std::vector<DeviceReport> reports;
  for (const Servo* servo : servos_) {
    DeviceReport& report = reports.emplace_back();
    report.status = servo->state().device;
    const bool wrong = report.status == DeviceState::Status::silent ||
                       report.status == DeviceState::Status::failed;
    if (wrong) report.reason = servo->device().reason();
  }
  sessions_.send_to_all({Topic::Kind::devices}, text_message(devices_text(reports)));
}

std::set<std::size_t> RunView::budgets() const {
  std::set<std::size_t> budgets;
  for (const Session* session : sessions_.greeted()) budgets.insert(session->points);
  return budgets;
}

void RunView::send_states(double now) {
  if (sessions_.greeted().empty()) return;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (const auto state = states_[i].next(now, radii_[i], sessions_.taken(i))) {
      sessions_.send_to_all({Topic::Kind::state, i}, binary_message(encode(*state)));
    }
  }
  sessions_.send_moment();
}

void RunView::show(const EncodedScene& encoded) {
  for (std::size_t i = 0; i < encoded.surfaces.size(); ++i) radii_[i] = encoded.surfaces[i].radius;
  for (Session* session : sessions_.greeted()) {
    if (session->points == 0) continue;
    for (const EncodedCloud& cloud : encoded.clouds) {
      if (session->points != cloud.budget) continue;
      session->show({Topic::Kind::cloud, cloud.source}, cloud.bytes);
    }
    for (std::size_t i = 0; i < encoded.surfaces.size(); ++i) {
      if (encoded.surfaces[i].bytes == nullptr) continue;
      session->show({Topic::Kind::surface, i}, encoded.surfaces[i].bytes);
    }
  }
  if (encoded.sources) sessions_.send_to_all({Topic::Kind::sources}, {encoded.sources, true});
  if (!encoded.complaint.empty()) {
    sessions_.send({Viewer::NoticeLevel::warning, encoded.complaint});
  }
}

void RunView::show_progress(std::string what, double share) {
  const Notice notice{Viewer::NoticeLevel::info, std::move(what), share};
  progress_ = share < 1 ? std::optional(notice) : std::nullopt;
  sessions_.send(notice);
}

}  // namespace palpate::viewer
