// Slides over planes alone, by distance and incidence.
#include "accuracy/flat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "accuracy/sweep.hpp"
#include "common/stage.hpp"
#include "common/wanted.hpp"

namespace palpate::accuracy {
namespace {

using bench::between;

constexpr std::array<double, 3> kDistances = {0.5, 0.8, 1.2};   // m; judgement: arms' lengths
constexpr std::array<double, 4> kIncidences = {0, 20, 40, 60};  // degrees; judgement: tables
constexpr double kDisparity = 525 * 0.075;  // pixels times m; derived: simulated_noise.hpp
constexpr double kMostTerraced = 8;         // pixels; derived: disparity_step's range

struct FlatBin {
  std::size_t distance = 0;
  std::size_t incidence = 0;
};

std::vector<FlatBin> all_bins() {
  std::vector<FlatBin> bins;
  for (std::size_t d = 0; d + 1 < kDistances.size(); ++d) {
    for (std::size_t i = 0; i + 1 < kIncidences.size(); ++i) bins.push_back({d, i});
  }
  return bins;
}

std::string bin_name(const FlatBin& bin) {
  return fmt::format("flat {:g}-{:g} m {:g}-{:g} deg", kDistances[bin.distance],
                     kDistances[bin.distance + 1], kIncidences[bin.incidence],
                     kIncidences[bin.incidence + 1]);
}

PlaneView draw_view(const FlatBin& bin, Random& random) {
  return draw_plane_view(random, kDistances[bin.distance], kDistances[bin.distance + 1],
                         kIncidences[bin.incidence], kIncidences[bin.incidence + 1]);
}

// Terraces are as high as the options say at the plane's own distance.
SimulatedNoiseOptions flat_noise(const BenchOptions& options, double z, std::uint64_t seed) {
  SimulatedNoiseOptions noise = noise_of(options, 0, seed);
  noise.disparity_step = std::min(options.terraces * kDisparity / (z * z), kMostTerraced);
  return noise;
}

// The frame that a camera makes of a plane. Around the place errors are `uneven` times as large:
// what reflects badly is seen worse than the rest, by which the noise is measured.
DepthFrame seen_frame(const BenchOptions& options, const TruthScene& truth, const PlaneView& view,
                      std::uint64_t seed) {
  constexpr double kPatch = 40;  // pixels; judgement: of an image that errs as the rest does
  const DepthFrame exact = exact_frame(truth);
  DepthFrame frame = noisy_frame(exact, flat_noise(options, view.distance, seed));
  const Pinhole& p = frame.camera.pinhole;
  const int width = frame.camera.width;
  for (int i = 0; i < width * frame.camera.height; ++i) {
    const double x = (i % width - p.cx) - view.x * p.fx;
    const double y = (i / width - p.cy) - view.y * p.fy;
    const double near = std::exp(-0.5 * (x * x + y * y) / (kPatch * kPatch));
    float& z = frame.depth[static_cast<std::size_t>(i)];
    const float right = exact.depth[static_cast<std::size_t>(i)];
    if (z > 0) z += static_cast<float>((options.uneven - 1) * near) * (z - right);
  }
  return frame;
}

std::string cell(const BenchResults& results, const std::string& contender, const FlatBin& bin) {
  const std::string name = bin_name(bin);
  const auto is_here = [&](const Result& result) { return result.row == name; };
  if (std::none_of(results.results.begin(), results.results.end(), is_here)) return "";
  const auto of = [&](double (*value)(const Score&)) {
    return spread(results, contender, {name, "", value, {}, {}, ""});
  };
  const Spread normal = of([](const Score& s) { return s.normal; });
  const Spread height = of([](const Score& s) { return s.height; });
  const Spread step = of([](const Score& s) { return s.step; });
  return fmt::format("{:.2f} ({:.2f}) / {:.2f} ({:.2f}) / {:.3f} ({:.3f})", normal.median,
                     normal.worst, height.median, height.worst, step.median, step.worst);
}

}  // namespace

BenchResults run_flat(const BenchOptions& options, const std::vector<Contender>& contenders) {
  BenchResults out;
  const std::vector<FlatBin> bins = all_bins();
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (!bench::is_wanted(bin_name(bins[b]), options.rows)) continue;
    for (int i = 0; i < options.seeds; ++i) {
      const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
      Random random(seed * 1000 + b);
      const PlaneView view = draw_view(bins[b], random);
      TruthScene truth = make_empty_scene();
      truth.camera = camera_of(options);
      const Path path = put_plane(view, truth);
      const Trace ideal = ideal_trace(truth, path);
      const DepthFrame frame = seen_frame(options, truth, view, random.bits());
      for (const Contender& contender : contenders) {
        const std::unique_ptr<Scene> scene = make_scene(frame, truth, contender);
        Scorer scorer;
        scorer.add(path, ideal, rendered_trace(*scene, contender, path), truth);
        out.results.push_back({seed, contender.name, bin_name(bins[b]), scorer.score(), 0});
      }
    }
  }
  return out;
}

std::string markdown_flat(const BenchResults& results, const std::string& contender) {
  std::string text = fmt::format("| {}: normal deg / height mm / step N |", contender);
  std::string line = "\n|---|";
  for (std::size_t i = 0; i + 1 < kIncidences.size(); ++i) {
    text += fmt::format(" {:g}-{:g} deg |", kIncidences[i], kIncidences[i + 1]);
    line += "---|";
  }
  text += line + "\n";
  for (const FlatBin& bin : all_bins()) {
    if (bin.incidence == 0) {
      text += fmt::format("| flat, {:g}-{:g} m |", kDistances[bin.distance],
                          kDistances[bin.distance + 1]);
    }
    text += fmt::format(" {} |", cell(results, contender, bin));
    if (bin.incidence + 2 == kIncidences.size()) text += "\n";
  }
  return text;
}

}  // namespace palpate::accuracy
