// Plans the strokes of an exploring hand.
#include "device/explore.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "base/requirement.hpp"
#include "device/explored_tool.hpp"
#include "device/free_way.hpp"
#include "device/stroke_player.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

namespace {

using Eigen::Vector3d;

// R above the rendered surface where the hand moves freely (judgement)
constexpr double kClearance = 2.5;
constexpr double kRoom = 0.5;     // R that a tool has around it there (judgement)
constexpr double kStep = 0.25;    // R between positions of a stroke (judgement)
constexpr double kStroke = 0.6;   // longest stroke, share of the region's extent (judgement)
constexpr double kLongest = 1.2;  // s; longest stroke (judgement)
constexpr double kDwell = 0.1;    // s at rest before and after a stroke (judgement)
// Share of the extent: a start so far from all touched positions is far enough (judgement)
constexpr double kFresh = 0.3;
constexpr double kNear = 0.3;        // weight of the path there against that distance (judgement)
constexpr int kCandidates = 24;      // start positions compared for a stroke (judgement)
constexpr int kTries = 8;            // strokes tried until a free path leads to one (judgement)
constexpr double kMostPieces = 200;  // of an arc that is looked at (judgement)
constexpr int kDirections = 4;       // directions tried from a start (judgement)

class Explorer {
 public:
  Explorer(const ExploredSurface& surface, const StrokeOptions& options)
      : options_(options),
        origin_(surface.origin),
        map_(surface, options.region, options.radius),
        tool_(options.tool),
        random_(options.seed),
        player_(surface.origin, options) {}

  Trajectory run(std::vector<Press>& presses) {
    std::vector<MapSample> stroke = next_stroke(next_start(map_.center()));
    player_.dwell(above(stroke.front()), kDwell);
    while (!player_.over()) {
      if (options_.progress) options_.progress(player_.share());
      presses.push_back(touch(stroke));
      const MapSample last = stroke.back();
      FreeWay path;
      for (int i = 0; i < kTries && !path.clear; ++i) {
        stroke = next_stroke(next_start(last.position));
        path = route(last, stroke.front());
      }
      if (path.clear) {
        player_.move(path.positions, options_.travel_speed);
      } else {
        stroke = next_stroke(last);  // walled in: go on from here
      }
    }
    return player_.take();
  }

 private:
  // That is free around a way.
  [[nodiscard]] double room() const { return 0.5 * kClearance * options_.radius; }
  [[nodiscard]] double clearance() const { return options_.offset + kClearance * options_.radius; }
  [[nodiscard]] Vector3d over(const MapSample& s, double height) const {
    return s.position + (height + tool_.reach(s.normal)) * s.normal;
  }
  [[nodiscard]] Vector3d above(const MapSample& s) const { return over(s, clearance()); }
  [[nodiscard]] Vector3d under(const MapSample& s, double depth) const {
    return over(s, options_.offset - depth);
  }

  // Can the hand leave the surface here without meeting it again? Not from inside a closed object.
  [[nodiscard]] bool open(const MapSample& s) const {
    const double step = room();
    const double farthest = std::max(map_.extent(), 3 * step);
    double d = 2 * step;
    while (d <= farthest) {
      const double room = map_.distance(s.position + d * s.normal) - 1.6 * step;
      if (room < 0) return false;
      d += step * (1 + std::floor(room / step));  // nothing can be near before
    }
    return true;
  }

  [[nodiscard]] bool fits(const MapSample& s) const {
    return tool_.fits(map_, above(s), kRoom * options_.radius);
  }

  // Down along the normal, along the stroke with the depth going up and down, and off again.
  Press touch(const std::vector<MapSample>& stroke) {
    const double depth = options_.depth;
    player_.move({above(stroke.front()), under(stroke.front(), depth)}, options_.slide_speed);
    player_.dwell(under(stroke.front(), depth), kDwell);
    Press press{player_.time()};
    std::vector<Vector3d> path;
    for (std::size_t i = 0; i < stroke.size(); ++i) {
      const double phase = static_cast<double>(i) * kStep / 6 * std::numbers::pi;
      path.push_back(under(stroke[i], depth * (0.75 + 0.25 * std::cos(phase))));
    }
    player_.move(path, options_.slide_speed);
    press.end = player_.time();
    for (const MapSample& each : stroke) press.over.push_back(origin_ + above(each));
    player_.dwell(path.back(), kDwell / 2);
    player_.move({path.back(), above(stroke.back())}, options_.slide_speed);
    press.resume = player_.time();
    press.pull = 0.5 * depth;  // where the stroke is shallowest
    return press;
  }

  std::vector<MapSample> next_stroke(const MapSample& start) {
    std::vector<MapSample> best(1, start);
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * (random_.uniform() + i) / kDirections;
      const Vector3d u = start.normal.unitOrthogonal();
      const Vector3d direction = std::cos(angle) * u + std::sin(angle) * start.normal.cross(u);
      std::vector<MapSample> stroke = follow(start, direction);
      if (stroke.size() > best.size()) best = std::move(stroke);
    }
    for (std::size_t i = 0; i < best.size(); i += 4) touched_.push_back(best[i].position);
    return best;
  }

  // The higher, the better a stroke begins there; some value up to `enough` where it is no more.
  [[nodiscard]] double score_of(const Vector3d& start, const Vector3d& here, double enough) const {
    const double cost = kNear * (start - here).norm();
    double fresh = kFresh * map_.extent();
    for (const Vector3d& p : touched_) {
      fresh = std::min(fresh, (p - start).norm());
      if (fresh - cost <= enough) break;
    }
    return fresh - cost;
  }

  // Draws random positions and picks one far from everything touched before but near `here`.
  MapSample next_start(const Vector3d& here) {
    MapSample best;
    double highest = -1e300;
    int seen = 0;
    for (int i = 0; seen < kCandidates && i < 50 * kCandidates; ++i) {
      const auto k = static_cast<std::size_t>(random_.uniform() * static_cast<double>(map_.size()));
      const MapSample sample = map_.at(map_.point(k));
      if (sample.normal.isZero() || !map_.inside(sample.position)) continue;
      if (i < 4 * kCandidates && !(open(sample) && fits(sample))) continue;
      ++seen;
      const double score = score_of(sample.position, here, highest);
      if (score > highest) {
        highest = score;
        best = sample;
      }
    }
    if (seen > 0) return best;
    // Normals cancel everywhere (noise, leaves): poke at a point from above.
    return {map_.point(0), Vector3d::UnitZ()};
  }

  // Along the surface while it goes on, not too far, and back to where the hand can leave.
  [[nodiscard]] std::vector<MapSample> follow(const MapSample& start, Vector3d direction) const {
    const double step = kStep * options_.radius;
    const double longest = std::min(kStroke * map_.extent(), kLongest * options_.slide_speed);
    std::vector<MapSample> path(1, start);
    for (double length = 0; length < longest; length += step) {
      MapSample next = map_.at(path.back().position + step * direction);
      if (next.normal.isZero() || !map_.inside(next.position)) break;
      if (next.normal.dot(path.back().normal) < 0.2) break;
      if ((next.position - path.back().position).norm() > 4 * step) break;
      if (map_.distance(above(next)) < room()) break;
      path.push_back(next);
      direction -= direction.dot(next.normal) * next.normal;
      if (direction.norm() < 1e-3) break;
      direction.normalize();
    }
    while (path.size() > 1 && !open(path.back())) path.pop_back();
    return path;
  }

  // Through free space from over one position to over another: the flattest arc that touches
  // nothing and passes over what stands between or, where a roof is over everything, under it.
  [[nodiscard]] FreeWay route(const MapSample& from, const MapSample& to) const {
    const Vector3d a = above(from);
    const Vector3d b = above(to);
    Vector3d up = from.normal + to.normal;
    if (up.norm() < 0.3) up = 0.5 * (a + b) - map_.center();
    if (up.norm() < 1e-9) up = from.normal.unitOrthogonal();
    up.normalize();
    FreeWay best;
    for (const double lift : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0}) {
      const Vector3d rise = lift * std::max((b - a).norm(), 4 * clearance()) * up;
      FreeWay path = arc({a, b}, rise, room(), kMostPieces,
                         [this](const Vector3d& x) { return map_.distance(x); });
      if (!path.clear) continue;
      const bool over = std::ranges::all_of(path.positions, [&](auto& p) { return open({p, up}); });
      if (over || !best.clear) best = std::move(path);
      if (over) break;
    }
    return best;
  }

  StrokeOptions options_;
  Vector3d origin_;
  SurfaceMap map_;
  ExploredTool tool_;
  Random random_;
  StrokePlayer player_;
  std::vector<Vector3d> touched_;
};

}  // namespace

Trajectory explore(const ExploredSurface& surface, const StrokeOptions& options,
                   std::vector<Press>* presses) {
  if (surface.points.empty()) throw Error("exploration: there are no points to explore");
  if (!surface.normals.empty() && surface.normals.size() != surface.points.size()) {
    throw Error(fmt::format("exploration: {} normals for {} points", surface.normals.size(),
                            surface.points.size()));
  }
  const Requirement require{"exploration"};
  require.positive("duration (s)", options.duration, "give one above 0");
  require.positive("period (s)", options.period, "give one above 0");
  require.positive("radius (m)", options.radius, "give one above 0");
  require.positive("region (m)", options.region, "give one above 0");
  require.positive("slide_speed (m/s)", options.slide_speed, "give one above 0");
  require.positive("travel_speed (m/s)", options.travel_speed, "give one above 0");
  require(std::isfinite(options.depth), "depth (m)", options.depth, "give a finite one");
  require(std::isfinite(options.offset), "offset (m)", options.offset, "give a finite one");
  std::vector<Press> own;
  return Explorer(surface, options).run(presses != nullptr ? *presses : own);
}

}  // namespace palpate
