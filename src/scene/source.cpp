// Makes a cloud a source's surface, and hands it over to readers.
#include "palpate/scene/source.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "prepare/place.hpp"
#include "scene/source_inside.hpp"

namespace palpate {
namespace {

void check_factor(const std::string& name, const char* option, double factor) {
  if (factor >= 0 && factor <= 1) return;
  throw Error(
      fmt::format("source '{}': {} is {}; it must be between 0 and 1", name, option, factor));
}

void check(const std::string& name, const Snapshot& snapshot) {
  if (snapshot.layers.size() > Snapshot::kMaxLayers) {
    throw Error(fmt::format("source '{}': a snapshot of {} layers; give at most {}", name,
                            snapshot.layers.size(), Snapshot::kMaxLayers));
  }
  if (!std::isfinite(snapshot.start) || !std::isfinite(snapshot.end) ||
      snapshot.end < snapshot.start) {
    throw Error(
        fmt::format("source '{}': a snapshot from {} s to {} s; give finite times, in order", name,
                    snapshot.start, snapshot.end));
  }
  const auto check_duration = [&](const char* what, double value) {
    if (std::isfinite(value) && value >= 0) return;
    throw Error(
        fmt::format("source '{}': a snapshot's {} is {} s; it must be finite and not "
                    "below 0",
                    name, what, value));
  };
  check_duration("fade", snapshot.fade);
  check_duration("interval", snapshot.interval);
  check_duration("spare", snapshot.spare);
  if (std::isnan(snapshot.silent_from) || !std::isfinite(snapshot.stamp)) {
    throw Error(
        fmt::format("source '{}': a snapshot's stamp is {} s and it is silent from {} s; "
                    "give times",
                    name, snapshot.stamp, snapshot.silent_from));
  }
  check_factor(name, "presence_start", snapshot.presence_start);
  check_factor(name, "presence_end", snapshot.presence_end);
  for (const Snapshot::Layer& layer : snapshot.layers) {
    if (!layer.points)
      throw Error(fmt::format("source '{}': a layer has no points; give every layer some", name));
    check_factor(name, "a layer's weight_start", layer.weight_start);
    check_factor(name, "a layer's weight_end", layer.weight_end);
    check(*layer.points);
  }
}

}  // namespace

Source::Source(std::string name, const SourceOptions& options)
    : inside_(std::make_unique<Inside>()) {
  inside_->name = std::move(name);
  inside_->options = options;
  inside_->pose = options.T_world_sensor;
  check_factor(inside_->name, "soft.stiffness_factor", options.soft.stiffness_factor);
  check_factor(inside_->name, "soft.friction_factor", options.soft.friction_factor);
  SourceOptions lasting = options;
  lasting.prepare.progress = {};  // who adds a source waits for its first cloud alone
  named(inside_->name, [&] { inside_->streaming = make_streaming(lasting); });
}

Source::~Source() = default;

const std::string& Source::name() const {
  return inside_->name;
}

SourceOptions Source::options() const {
  return inside_->copy(&Inside::options);
}

Prepared::Report Source::report() const {
  return inside_->copy(&Inside::report);
}

Eigen::Isometry3d Source::pose() const {
  return inside_->copy(&Inside::pose);
}

void Source::set_pose(const Eigen::Isometry3d& T_world_sensor) {
  named(inside_->name, [&] { check_pose(T_world_sensor); });
  const std::lock_guard lock(inside_->mutex);
  inside_->pose = T_world_sensor;
}

void Source::set(const PointCloud& cloud) {
  const SourceOptions wanted = options();
  {
    const std::lock_guard lock(inside_->mutex);
    inside_->options.prepare.progress = {};  // as the constructor does for what is pushed
  }
  if (set_as_frame(*this, cloud)) return;
  Prepared prepared = named(inside_->name, [&] { return prepare(cloud, wanted.prepare, pose()); });
  prepared.points.eye = eye_of(cloud, wanted.prepare, pose());
  {
    const std::lock_guard lock(inside_->mutex);
    inside_->report = prepared.report;
    inside_->state = {};
  }
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->layers.push_back(
      {std::make_shared<const SurfacePoints>(std::move(prepared.points)), 1, 1});
  snapshot->publication = ++inside_->publications;
  publish(std::move(snapshot));
}

void Source::publish(std::shared_ptr<const Snapshot> snapshot) {
  if (snapshot) check(inside_->name, *snapshot);
  {
    const std::lock_guard lock(inside_->mutex);
    inside_->points =
        snapshot && !snapshot->layers.empty() ? snapshot->layers.front().points : nullptr;
  }
  forget_frames(inside_->streaming.get());
  inside_->handoff.publish(std::move(snapshot));
  inside_->slot.compare(*this);
}

std::shared_ptr<const SurfacePoints> Source::points() const {
  return inside_->copy(&Inside::points);
}

Source::State Source::state() const {
  return inside_->copy(&Inside::state);
}

}  // namespace palpate
