#include "palpate/scene/source.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

void check_factor(const std::string& name, const char* option, double factor) {
  if (factor >= 0 && factor <= 1) return;
  throw Error(
      fmt::format("source '{}': {} is {}; it must be between 0 and 1", name, option, factor));
}

void check(const std::string& name, const Snapshot& snapshot) {
  if (snapshot.layers.size() > Snapshot::kMaxLayers) {
    throw Error(fmt::format("source '{}': a snapshot of {} layers; at most {} are felt", name,
                            snapshot.layers.size(), Snapshot::kMaxLayers));
  }
  if (!std::isfinite(snapshot.start) || !std::isfinite(snapshot.end) ||
      snapshot.end < snapshot.start) {
    throw Error(
        fmt::format("source '{}': a snapshot from {} s to {} s; give finite times, in order", name,
                    snapshot.start, snapshot.end));
  }
  check_factor(name, "presence_start", snapshot.presence_start);
  check_factor(name, "presence_end", snapshot.presence_end);
  for (const Layer& layer : snapshot.layers) {
    if (!layer.points) throw Error(fmt::format("source '{}': a layer without points", name));
    check_factor(name, "a layer's weight_start", layer.weight_start);
    check_factor(name, "a layer's weight_end", layer.weight_end);
    check(*layer.points);
  }
}

}  // namespace

Source::Source(std::string name, const SourceOptions& options)
    : name_(std::move(name)), options_(options) {
  check_factor(name_, "soft.stiffness_factor", options_.soft.stiffness_factor);
  check_factor(name_, "soft.friction_factor", options_.soft.friction_factor);
}

void Source::set(const PointCloud& cloud) {
  Prepared prepared = [&] {
    try {
      return prepare(cloud, options_.prepare, options_.T_world_sensor);
    } catch (const Error& error) {
      throw Error(fmt::format("source '{}': {}", name_, error.what()));
    }
  }();
  report_ = prepared.report;
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back(
      {std::make_shared<const SurfacePoints>(std::move(prepared.points)), 1, 1});
  publish(std::move(snapshot));
}

void Source::publish(std::unique_ptr<const Snapshot> snapshot) {
  if (snapshot) check(name_, *snapshot);
  {
    const std::lock_guard lock(points_mutex_);
    points_ = snapshot && !snapshot->layers.empty() ? snapshot->layers.front().points : nullptr;
  }
  handoff_.publish(std::move(snapshot));
}

std::shared_ptr<const SurfacePoints> Source::points() const {
  const std::lock_guard lock(points_mutex_);
  return points_;
}

}  // namespace palpate
