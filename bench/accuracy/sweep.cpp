// Sweeps a plane and a sphere over distance and incidence.
#include "accuracy/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "accuracy/strokes.hpp"
#include "common/stage.hpp"
#include "common/wanted.hpp"

namespace palpate::accuracy {
namespace {

using bench::between;
using Eigen::Vector3d;

// m; judgement: the range of table-top cameras
constexpr std::array<double, 7> kDistances = {0.35, 0.5, 0.7, 1.0, 1.4, 1.9, 2.5};
// degrees; judgement: beyond 75 little is measured
constexpr std::array<double, 6> kIncidences = {0, 15, 30, 45, 60, 75};
constexpr double kBallRadius = 0.06;  // m; derived: the fixed layouts' sphere
constexpr double kSweepLength = 0.1;  // m; judgement: fits the nearest image
// rad; judgement: half of the 30 degrees that the header says
constexpr double kHalfArc = 15 * kDegree;

struct Bin {
  bool sphere = false;
  std::size_t distance = 0;
  std::size_t incidence = 0;
};

struct SweepCase {
  TruthScene truth;
  Path path;
};

std::vector<Bin> all_bins() {
  std::vector<Bin> bins;
  for (const bool sphere : {false, true}) {
    for (std::size_t d = 0; d + 1 < kDistances.size(); ++d) {
      for (std::size_t i = 0; i + 1 < kIncidences.size(); ++i) bins.push_back({sphere, d, i});
    }
  }
  return bins;
}

std::string bin_name(const Bin& bin) {
  return fmt::format("{} {:.2f}-{:.2f} m {:g}-{:g} deg", bin.sphere ? "sphere" : "plane",
                     kDistances[bin.distance], kDistances[bin.distance + 1],
                     kIncidences[bin.incidence], kIncidences[bin.incidence + 1]);
}

// A place that a view looks at, with the surface there.
struct Seen {
  Vector3d place, normal, axis;  // m; unit vectors
};

Seen seen_in(const PlaneView& view) {
  Seen seen;
  seen.place = view.distance * Vector3d(view.x, view.y, 1);
  const Vector3d back = -seen.place.normalized();
  const Vector3d right = back.cross(Vector3d::UnitX()).normalized();
  seen.axis = std::cos(view.about) * right + std::sin(view.about) * back.cross(right);
  seen.normal = Eigen::AngleAxisd(view.incidence, seen.axis) * back;
  return seen;
}

SweepCase draw_case(const Bin& bin, Random& random) {
  const PlaneView view =
      draw_plane_view(random, kDistances[bin.distance], kDistances[bin.distance + 1],
                      kIncidences[bin.incidence], kIncidences[bin.incidence + 1]);
  SweepCase drawn{make_empty_scene(), {}};
  if (!bin.sphere) {
    drawn.path = put_plane(view, drawn.truth);
    return drawn;
  }
  const Seen seen = seen_in(view);
  Solid& solid = drawn.truth.solids[0];
  solid.size = Vector3d::Constant(kBallRadius);
  solid.T_world_solid.translation() = seen.place - kBallRadius * seen.normal;
  drawn.path = sphere_arc(solid, {seen.normal, seen.axis, kHalfArc});
  return drawn;
}

Spread spread_of(const BenchResults& results, const std::string& contender, const Bin& bin,
                 double (*of)(const Score&)) {
  return spread(results, contender, {bin_name(bin), "", of, {}, {}, ""});
}

// Empty where the bin was not wanted.
std::string bin_cell(const BenchResults& results, const std::string& contender, const Bin& bin) {
  const std::string name = bin_name(bin);
  const auto is_here = [&](const Result& result) { return result.row == name; };
  if (std::none_of(results.results.begin(), results.results.end(), is_here)) return "";
  const Spread normal = spread_of(results, contender, bin, [](const Score& s) { return s.normal; });
  const Spread height = spread_of(results, contender, bin, [](const Score& s) { return s.height; });
  const Spread lost =
      spread_of(results, contender, bin, [](const Score& s) { return 100 * s.lost; });
  std::string text = fmt::format("{:.2f} ({:.2f}) / {:.2f} ({:.2f})", normal.median, normal.worst,
                                 height.median, height.worst);
  if (lost.worst > 0.5) text += fmt::format(", lost {:.0f} ({:.0f}) %", lost.median, lost.worst);
  return text;
}

}  // namespace

PlaneView draw_plane_view(Random& random, double nearest, double farthest, double least,
                          double most) {
  PlaneView view;
  view.distance = between(random, nearest, farthest);
  view.incidence = between(random, least, most) * kDegree;
  view.x = between(random, -0.08, 0.08);
  view.y = between(random, -0.08, 0.08);
  view.about = between(random, 0, 2 * std::numbers::pi);
  view.turn = between(random, 0, 2 * std::numbers::pi);
  return view;
}

Path put_plane(const PlaneView& view, TruthScene& scene) {
  const Seen seen = seen_in(view);
  scene.solids[0] = half_space(seen.place, seen.normal, seen.axis);
  return slide_over(scene.solids[0], view.turn, kSweepLength, kSlideDepth);
}

BenchResults run_sweep(const BenchOptions& options, const std::vector<Contender>& contenders) {
  BenchResults out;
  const std::vector<Bin> bins = all_bins();
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (!bench::is_wanted(bin_name(bins[b]), options.rows)) continue;
    for (int i = 0; i < options.seeds; ++i) {
      const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
      Random random(seed * 1000 + b);
      SweepCase drawn = draw_case(bins[b], random);
      drawn.truth.camera = camera_of(options);
      const Trace ideal = ideal_trace(drawn.truth, drawn.path);
      const DepthFrame frame =
          noisy_frame(exact_frame(drawn.truth), noise_of(options, 0, random.bits()));
      for (const Contender& contender : contenders) {
        const std::unique_ptr<Scene> scene = make_scene(frame, drawn.truth, contender);
        Scorer scorer;
        scorer.add(drawn.path, ideal, rendered_trace(*scene, contender, drawn.path), drawn.truth);
        out.results.push_back({seed, contender.name, bin_name(bins[b]), scorer.score(), 0});
      }
    }
  }
  return out;
}

std::string markdown_sweep(const BenchResults& results, const std::string& contender) {
  std::string text = fmt::format("| {}: normal deg / height mm |", contender);
  for (std::size_t i = 0; i + 1 < kIncidences.size(); ++i) {
    text += fmt::format(" {:g}-{:g} deg |", kIncidences[i], kIncidences[i + 1]);
  }
  text += "\n|---|---|---|---|---|---|\n";
  for (const Bin& bin : all_bins()) {
    if (bin.incidence == 0) {
      text += fmt::format("| {}, {:g}-{:g} m |", bin.sphere ? "sphere" : "plane",
                          kDistances[bin.distance], kDistances[bin.distance + 1]);
    }
    text += fmt::format(" {} |", bin_cell(results, contender, bin));
    if (bin.incidence + 2 == kIncidences.size()) text += "\n";
  }
  return text;
}

}  // namespace palpate::accuracy
