// Runs the viewer: settings, server thread, and periodic pictures and reports.
#include "palpate/viewer/viewer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/latest.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/shapes.hpp"
#include "scene/bounds.hpp"
#include "viewer/access.hpp"
#include "viewer/client_sessions.hpp"
#include "viewer/messages.hpp"
#include "viewer/reports.hpp"
#include "viewer/scene_encoder.hpp"
#include "viewer/server.hpp"
#include "viewer/upright.hpp"

namespace palpate {
namespace {

using namespace viewer;

constexpr double kStatePeriod = 1.0 / 60;  // s; a screen's frame (judgement)
constexpr double kReportPeriod = 0.5;      // s (judgement)
constexpr double kEmptyRadius = 1;         // m, shown while there are no points (judgement)

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
    labels.push_back({names[i], takeable, controls.scale ? controls.scale(i) : 1});
  }
  return labels;
}

}  // namespace

struct Viewer::Parts {
  Parts(Scene& seen, std::vector<Servo*> moving, const ViewerOptions& given,
        ViewerControls controls)
      : scene(seen),
        servos(std::move(moving)),
        names(tool_names(servos)),
        options(complete(given, seen)),
        sessions(sessions_options(complete(std::move(controls), servos))),
        server(options, sessions),
        radii(servos.size(), 0.0),
        encoder(seen, {servos, *options.origin, options.streams, options.robot,
                       [this](EncodedScene encoded) { post(std::move(encoded)); }}) {
    for (std::size_t i = 0; i < servos.size(); ++i) {
      states.emplace_back(*servos[i], i, *options.origin);
    }
    server.every(kStatePeriod, [this] { tick(); });
    server.every(kReportPeriod, [this] {
      if (sessions.greeted().empty()) return;
      check_faults(streams());
      send_devices();
    });
    network = std::jthread([this] { server.run(); });
  }
  ~Parts() {
    server.stop();
    network.join();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  [[nodiscard]] ClientSessionsOptions sessions_options(const ViewerControls& controls) {
    return {options.token,   options.limits,
            controls,        labels_of(servos, controls),
            *options.origin, [this] { return welcome(); }};
  }
  [[nodiscard]] std::vector<ViewedStream> streams() const {
    return options.streams ? options.streams() : std::vector<ViewedStream>{};
  }
  [[nodiscard]] Welcome welcome();
  void check_faults(const std::vector<ViewedStream>& streams);
  void send_devices();
  void tick();
  void post(EncodedScene encoded) {
    auto shared = std::make_shared<EncodedScene>(std::move(encoded));
    server.post([this, shared] { show(*shared); });
  }
  void show(const EncodedScene& encoded);

  Scene& scene;
  std::vector<Servo*> servos;
  std::vector<std::string> names;  // of their tools
  ViewerOptions options;
  std::string run = make_token();
  ClientSessions sessions;
  Server server;
  std::vector<StateReporter> states;
  std::vector<double> radii;  // R around each tool, m
  FaultNotices notices;
  std::optional<Notice> progress;  // of work under way
  Latest<Viewer::Counts> counts;
  SceneEncoder encoder;
  std::jthread network;
};

Welcome Viewer::Parts::welcome() {
  const Box box = scene_box(scene);
  Welcome welcome;
  welcome.run = run;
  welcome.scene = options.scene;
  welcome.origin = *options.origin;
  welcome.up = *options.up;
  if (options.eye) welcome.eye = *options.eye - *options.origin;
  welcome.radius = box.empty() ? kEmptyRadius : 0.5 * box.size().norm();
  const std::vector<ViewedStream> seen = streams();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::string& name = scene.source(i).name();
    const bool camera = std::ranges::any_of(seen, [&](const ViewedStream& stream) {
      return stream.state.source == name && stream.frustum;
    });
    welcome.sources.push_back({name, camera});
  }
  check_faults(seen);
  welcome.notices = notices.present();
  if (progress) welcome.notices.push_back(*progress);
  return welcome;
}

void Viewer::Parts::check_faults(const std::vector<ViewedStream>& streams) {
  std::vector<DeviceFault> faults;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    faults.push_back({names[i], servos[i]->state().guard.fault});
  }
  for (const Notice& notice : notices.update(streams, faults)) sessions.send(notice);
}

void Viewer::Parts::send_devices() {
  std::vector<DeviceReport> reports;
  for (const Servo* servo : servos) {
    DeviceReport& report = reports.emplace_back();
    report.status = servo->state().device;
    const bool wrong = report.status == DeviceState::Status::silent ||
                       report.status == DeviceState::Status::failed;
    if (wrong) report.reason = servo->device().reason();
  }
  sessions.send_to_all({Topic::Kind::devices}, text_message(devices_text(reports)));
}

void Viewer::Parts::tick() {
  std::set<std::size_t> budgets;
  for (const Session* session : sessions.greeted()) budgets.insert(session->points);
  const bool seen = !budgets.empty();
  encoder.set_budgets(std::move(budgets));
  for (std::size_t i = 0; seen && i < states.size(); ++i) {
    if (const auto state = states[i].next(SteadyClock().now(), radii[i], sessions.taken(i))) {
      sessions.send_to_all({Topic::Kind::state, i}, binary_message(encode(*state)));
    }
  }
  if (seen) sessions.send_moment();
  counts.set(server.counts());
}

void Viewer::Parts::show(const EncodedScene& encoded) {
  for (std::size_t i = 0; i < encoded.surfaces.size(); ++i) radii[i] = encoded.surfaces[i].radius;
  for (Session* session : sessions.greeted()) {
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
  if (encoded.sources) sessions.send_to_all({Topic::Kind::sources}, {encoded.sources, true});
  if (!encoded.complaint.empty()) sessions.send({Viewer::NoticeLevel::warning, encoded.complaint});
}

Viewer::Viewer(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
               ViewerControls controls)
    : parts_(std::make_unique<Parts>(scene, std::move(servos), options, std::move(controls))) {}

Viewer::~Viewer() = default;

std::string Viewer::url() const {
  Listening listening = parts_->server.listening();
  if (listening.everywhere) listening.address = "127.0.0.1";
  return fmt::format("http://{}/#{}", authority(listening), parts_->options.token);
}

std::uint16_t Viewer::port() const noexcept {
  return parts_->server.listening().port;
}

Viewer::Counts Viewer::counts() const {
  return parts_->counts.get();
}

void Viewer::restarts(std::string why) {
  Parts& parts = *parts_;
  parts.server.post([&parts, why = std::move(why)] { parts.server.restarts(why); });
}

void Viewer::notice(Viewer::NoticeLevel level, std::string text) {
  Parts& parts = *parts_;
  parts.server.post([&parts, said = Notice{level, std::move(text)}] { parts.sessions.send(said); });
}

void Viewer::progress(std::string what, double share) {
  Parts& parts = *parts_;
  parts.server.post([&parts, notice = Notice{NoticeLevel::info, std::move(what), share}] {
    parts.progress = *notice.share < 1 ? std::optional(notice) : std::nullopt;
    parts.sessions.send(notice);
  });
}

void Viewer::settings_changed() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.sessions.send_settings(); });
}

void Viewer::time_line_changed() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.sessions.send_time_line(); });
}

void Viewer::record_ended() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.sessions.end_record(); });
}

}  // namespace palpate
