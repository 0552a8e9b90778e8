#include "palpate/viewer/viewer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/base/latest.hpp"
#include "viewer/client_message.hpp"
#include "viewer/painter.hpp"
#include "viewer/scene_box.hpp"
#include "viewer/server.hpp"
#include "viewer/state_source.hpp"
#include "viewer/token.hpp"
#include "viewer/tool_names.hpp"
#include "viewer/troubles.hpp"

namespace palpate {
namespace {

using namespace viewer;

constexpr double kStatePeriod = 1.0 / 60;  // s
constexpr double kReportPeriod = 0.5;      // s
constexpr double kEmptyRadius = 1;         // m, shown where there is nothing yet

Message binary(std::string bytes) {
  return {std::make_shared<const std::string>(std::move(bytes)), false};
}

// Of all points; where there are none yet, of where the sensors stand.
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
    throw Error(fmt::format(
        "viewer: a token of {} bytes that cannot end an address; give 1 to {} letters, digits and "
        "any of -._~, or none",
        options.token.size(), kLongestWord));
  }
  if (!options.origin) options.origin = middle(scene);
  return options;
}

ViewerControls complete(ViewerControls controls, const std::vector<Servo*>& servos) {
  if (!controls.pause) {
    controls.pause = [servos](bool on) {
      for (Servo* servo : servos) servo->pause(on);
    };
  }
  if (!controls.reset) {
    controls.reset = [servos] {
      for (Servo* servo : servos) servo->reset();
    };
  }
  return controls;
}

std::vector<DeviceLabel> labels_of(const std::vector<Servo*>& servos,
                                   const ViewerControls& controls) {
  if (servos.size() > std::numeric_limits<std::uint8_t>::max()) {
    throw Error(fmt::format("viewer: {} servos; at most 255 can be shown", servos.size()));
  }
  const std::vector<std::string> names = tool_names(servos);
  std::vector<DeviceLabel> labels;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    const bool takeable = controls.hand && (!controls.takeable || controls.takeable(i));
    labels.push_back({names[i], takeable});
  }
  return labels;
}

}  // namespace

struct Viewer::Parts {
  Parts(Scene& seen, const std::vector<Servo*>& moving, const ViewerOptions& given,
        const ViewerControls& controls)
      : scene(seen),
        servos(moving),
        names(tool_names(servos)),
        options(complete(given, seen)),
        lobby(lobby_options(complete(controls, servos))),
        server(options, lobby),
        radii(servos.size(), 0.0),
        painter(seen, {servos, *options.origin, options.streams,
                       [this](Picture picture) { post(std::move(picture)); }}) {
    for (std::size_t i = 0; i < servos.size(); ++i) {
      states.emplace_back(*servos[i], i, *options.origin);
    }
    server.every(kStatePeriod, [this] { tick(); });
    server.every(kReportPeriod, [this] {
      if (lobby.greeted().empty()) return;
      look_for_trouble(streams());
      tell_devices();
    });
    network = std::jthread([this] { server.run(); });
  }
  ~Parts() {
    server.stop();
    network.join();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  [[nodiscard]] LobbyOptions lobby_options(const ViewerControls& controls) {
    return {options.token,   options.limits,
            controls,        labels_of(servos, controls),
            *options.origin, [this] { return welcome(); }};
  }
  [[nodiscard]] std::vector<ViewerStream> streams() const {
    return options.streams ? options.streams() : std::vector<ViewerStream>{};
  }
  [[nodiscard]] Welcome welcome();
  void look_for_trouble(const std::vector<ViewerStream>& streams);
  void tell_devices();
  void tick();
  void post(Picture picture) {
    auto shared = std::make_shared<Picture>(std::move(picture));
    server.post([this, shared] { show(*shared); });
  }
  void show(const Picture& picture);

  Scene& scene;
  std::vector<Servo*> servos;
  std::vector<std::string> names;  // of their tools
  ViewerOptions options;
  Lobby lobby;
  Server server;
  std::vector<StateSource> states;
  std::vector<double> radii;  // R around each tool, m
  Troubles troubles;
  Latest<ViewerCounts> counts;
  Painter painter;
  std::jthread network;
};

Welcome Viewer::Parts::welcome() {
  const Box box = scene_box(scene);
  Welcome welcome;
  welcome.scene = options.scene;
  welcome.origin = *options.origin;
  welcome.up = options.up;
  welcome.radius = box.empty() ? kEmptyRadius : 0.5 * box.size().norm();
  const std::vector<ViewerStream> seen = streams();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::string& name = scene.source(i).name();
    const bool camera = std::ranges::any_of(seen, [&](const ViewerStream& stream) {
      return stream.state.source == name && stream.frustum;
    });
    welcome.sources.push_back({name, camera});
  }
  look_for_trouble(seen);
  welcome.notices = troubles.present();
  return welcome;
}

void Viewer::Parts::look_for_trouble(const std::vector<ViewerStream>& streams) {
  std::vector<DeviceFault> faults;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    faults.push_back({names[i], servos[i]->state().guard.fault});
  }
  for (const Notice& notice : troubles.look(streams, faults)) lobby.tell(notice);
}

void Viewer::Parts::tell_devices() {
  std::vector<DeviceReport> reports;
  for (const Servo* servo : servos) {
    DeviceReport& report = reports.emplace_back();
    report.status = servo->state().device;
    const bool wrong =
        report.status == DeviceStatus::silent || report.status == DeviceStatus::failed;
    if (wrong) report.reason = servo->device().reason();
  }
  lobby.tell_all({Topic::Kind::devices},
                 {std::make_shared<const std::string>(devices_text(reports)), true});
}

void Viewer::Parts::tick() {
  std::set<std::size_t> budgets;
  for (const Client* client : lobby.greeted()) budgets.insert(client->points);
  const bool seen = !budgets.empty();
  painter.look(std::move(budgets));
  for (std::size_t i = 0; seen && i < states.size(); ++i) {
    if (const auto state = states[i].next(Hub::now(), radii[i], lobby.taken(i))) {
      lobby.tell_all({Topic::Kind::state, i}, binary(encode(*state)));
    }
  }
  counts.set(server.counts());
}

void Viewer::Parts::show(const Picture& picture) {
  for (std::size_t i = 0; i < picture.surfaces.size(); ++i) radii[i] = picture.surfaces[i].radius;
  for (Client* client : lobby.greeted()) {
    if (client->points == 0) continue;
    for (const PaintedCloud& cloud : picture.clouds) {
      if (client->points != cloud.budget) continue;
      Lobby::show(*client, {Topic::Kind::cloud, cloud.source}, cloud.bytes);
    }
    for (std::size_t i = 0; i < picture.surfaces.size(); ++i) {
      if (picture.surfaces[i].bytes == nullptr) continue;
      Lobby::show(*client, {Topic::Kind::surface, i}, picture.surfaces[i].bytes);
    }
  }
  if (picture.sources) lobby.tell_all({Topic::Kind::sources}, {picture.sources, true});
  if (!picture.complaint.empty()) lobby.tell({NoticeLevel::warning, picture.complaint});
}

Viewer::Viewer(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
               ViewerControls controls)
    : parts_(std::make_unique<Parts>(scene, servos, options, controls)) {}

Viewer::~Viewer() = default;

std::string Viewer::url() const {
  Listening listening = parts_->server.listening();
  if (listening.everywhere) listening.address = "127.0.0.1";
  return fmt::format("http://{}/#{}", authority(listening), parts_->options.token);
}

std::uint16_t Viewer::port() const noexcept {
  return parts_->server.listening().port;
}

ViewerCounts Viewer::counts() const {
  return parts_->counts.get();
}

void Viewer::notice(NoticeLevel level, std::string text) {
  Parts& parts = *parts_;
  parts.server.post(
      [&parts, notice = Notice{level, std::move(text)}] { parts.lobby.tell(notice); });
}

void Viewer::settings_changed() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.lobby.tell_settings(); });
}

void Viewer::record_ended() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.lobby.end_record(); });
}

}  // namespace palpate
