// Touches flat parts of a real recording and scores them against averaged planes.
#include "accuracy/recorded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "accuracy/flat_patch.hpp"
#include "accuracy/score.hpp"
#include "accuracy/strokes.hpp"
#include "accuracy/table.hpp"
#include "common/stage.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/scene/scene_field.hpp"
#include "sensor/sequence.hpp"

namespace palpate::accuracy {
namespace {

using bench::between;
using Eigen::Vector3d;

constexpr double kLength = 0.08;   // m, of a slide; derived: two thirds of a patch
constexpr int kTries = 20000;      // places that are looked at; judgement
constexpr double kDepth = 0.01;    // m, of slides; judgement: the sensors err by some mm
constexpr double kFree = 0.02;     // m, from any point; judgement
constexpr double kWay = 0.15;      // m, length of a way at most; judgement
constexpr double kWaySpeed = 0.5;  // m/s; judgement: a fast hand

std::vector<DepthFrame> frames_of(const RecordedOptions& options) {
  const auto camera = open_sequence(read_sequence(options.folder));
  std::vector<DepthFrame> frames;
  DepthFrame frame;
  for (std::size_t i = 0; i < options.first + options.count; ++i) {
    if (camera->read(frame, 0) != DepthCamera::Status::frame) {
      throw Error(fmt::format("{} has no frame {}; ask for fewer", options.folder.string(), i));
    }
    frame.T_world_sensor.reset();  // the camera is the world
    if (i >= options.first) frames.push_back(frame);
  }
  return frames;
}

// Averages each pixel that most of the frames measured.
DepthFrame average(const std::vector<DepthFrame>& frames) {
  DepthFrame mean = frames.front();
  std::vector<float> depths;
  for (std::size_t i = 0; i < mean.depth.size(); ++i) {
    depths.clear();
    for (const DepthFrame& frame : frames) {
      if (frame.depth[i] > 0) depths.push_back(frame.depth[i]);
    }
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    const bool sure = 2 * depths.size() > frames.size();
    double sum = 0;
    double count = 0;
    for (const float z : depths) {
      const bool near = sure && std::abs(z - *middle) < 0.03F * *middle;
      sum += near ? z : 0;
      count += near ? 1 : 0;
    }
    mean.depth[i] = count > 0 ? static_cast<float>(sum / count) : 0;
  }
  return mean;
}

std::vector<Patch> flat_patches(const DepthFrame& mean, const RecordedOptions& options) {
  Random random(options.seed);
  std::vector<Patch> patches;
  for (int i = 0; i < kTries && std::ssize(patches) < options.patches; ++i) {
    const int u = static_cast<int>(between(random, 0, mean.camera.width));
    const int v = static_cast<int>(between(random, 0, mean.camera.height));
    if (auto patch = flat_patch(mean, u, v)) patches.push_back(std::move(*patch));
  }
  if (patches.empty()) {
    throw Error(options.folder.string() + " shows nothing flat; name other frames");
  }
  return patches;
}

struct Touched {
  std::vector<double> normal, height, ripple, lost;
};

using Felt = std::function<Trace(const Path&)>;

void touch(const Felt& felt, const Patch& patch, double turn, Touched& touched) {
  TruthScene truth = make_empty_scene();
  truth.solids[0] = half_space(patch.center, patch.normal, patch.normal.unitOrthogonal());
  const Path path = slide_over(truth.solids[0], turn, kLength, kDepth);
  Scorer scorer;
  scorer.add(path, ideal_trace(truth, path), felt(path), truth);
  const Score score = scorer.score();
  touched.normal.push_back(score.normal);
  touched.height.push_back(score.height);
  touched.ripple.push_back(score.ripple);
  touched.lost.push_back(100 * score.lost);
}

// Scores a plane through all pixels that one frame has of the patch.
void touch_own_plane(const Patch& own, const Patch& patch, Touched& touched) {
  const double cosine = std::min(1.0, own.normal.dot(patch.normal));
  touched.normal.push_back(std::acos(cosine) / kDegree);
  touched.height.push_back(1e3 * patch.normal.dot(own.center - patch.center));
}

// Deviation of a patch's frames from their average, over the noise that the filter reports.
struct Noise {
  std::vector<double> pixel, mean;

  void add(const std::vector<DepthFrame>& frames, const DepthFrame& average, const Patch& patch,
           const Source::State& told) {
    const double sigma = told.noise * std::pow(patch.center.z() / told.depth, 2);
    const double rest = static_cast<double>(frames.size()) /
                        std::max<double>(1, static_cast<double>(frames.size()) - 1);
    double squares = 0;
    double pixels = 0;
    double means = 0;
    for (const DepthFrame& frame : frames) {
      double sum = 0;
      double count = 0;
      for (const PatchPixel& p : patch.pixels) {
        const double off = frame.depth[p.number] - average.depth[p.number];
        if (frame.depth[p.number] <= 0 || std::abs(off) > 0.03 * patch.center.z()) continue;
        sum += off;
        squares += off * off;
        ++count;
      }
      pixels += count;
      if (count > 0) means += sum * sum / count;
    }
    if (pixels < 1) return;
    const double measured = std::sqrt(rest * squares / pixels);
    pixel.push_back(measured / sigma);
    mean.push_back(std::sqrt(rest * means / static_cast<double>(frames.size())) / measured /
                   told.correlation);
  }
};

// Straight ones through what is free for certain, and those of them with a force.
struct Ways {
  int gone = 0;
  int felt = 0;
};

Ways go_ways(const Felt& felt, const CellGrid& grid, int ways, Random& random) {
  std::vector<CellGrid::Neighbor> nearest;
  const auto is_free = [&](const Vector3d& x) {
    grid.nearest(x.cast<float>(), 1, nearest);
    const double z = grid.points()[nearest.front().index].z();
    const double near = std::max(kFree, 3 * kWorstNoise * z * z);
    return nearest.front().squared_distance > near * near;
  };
  const auto& points = grid.points();
  if (points.empty()) return {};
  Ways all;
  for (int tries = 0; all.gone < ways && tries < kTries; ++tries) {
    const Vector3d seen = points[random.bits() % points.size()].cast<double>();
    const Vector3d from = between(random, 0.3, 1.1) * seen;
    const Vector3d to(random.normal(), random.normal(), random.normal());
    if (!is_free(from)) continue;
    Path path;
    const Vector3d step = kWaySpeed * kTick * to.normalized();
    for (Vector3d x = from; (x - from).norm() < kWay && is_free(x); x += step) {
      path.hip.push_back(x);
    }
    ++all.gone;
    const auto pushes = [](const Vector3d& force) { return force.norm() > 1e-3; };
    all.felt += std::ranges::any_of(felt(path).force, pushes) ? 1 : 0;
  }
  return all;
}

std::string row(const std::string& name, const Touched& touched, const std::string& felt) {
  const auto cell = [](const std::vector<double>& values, int digits) {
    const Spread s = spread(values);
    return fmt::format("{:.{}f} ({:.{}f})", s.median, digits, s.worst, digits);
  };
  return fmt::format("| {} | {} | {} | {} | {} | {} |\n", name, cell(touched.normal, 2),
                     cell(touched.height, 2), cell(touched.ripple, 3), cell(touched.lost, 1), felt);
}

struct Recording {
  std::vector<DepthFrame> frames;
  DepthFrame mean;
  std::vector<Patch> patches;
};

// Through what each frame alone has of the patches.
std::string plane_row(const Recording& recording) {
  Touched touched;
  for (const DepthFrame& frame : recording.frames) {
    for (const Patch& patch : recording.patches) {
      Patch own = patch_at(frame, patch.u, patch.v, patch.center.z());
      if (own.pixels.empty()) continue;
      settle_on_plane(own);
      touch_own_plane(own, patch, touched);
    }
  }
  return row("a plane through its pixels", touched, "");
}

// Each frame by itself.
std::string feeler_row(const Recording& recording, const RecordedOptions& options,
                       const Feeler& feeler) {
  Touched touched;
  Random random(options.seed + 1);
  Ways all;
  for (const DepthFrame& frame : recording.frames) {
    const Felt felt = feeler.shown(frame);
    for (const Patch& patch : recording.patches) {
      if (patch_at(frame, patch.u, patch.v, patch.center.z()).pixels.empty()) continue;
      touch(felt, patch, between(random, 0, 2 * std::numbers::pi), touched);
    }
    const CellGrid grid(back_project(frame).positions);
    const int share = options.ways / static_cast<int>(recording.frames.size());
    const Ways ways = go_ways(felt, grid, share, random);
    all.gone += ways.gone;
    all.felt += ways.felt;
  }
  return row(feeler.name, touched, fmt::format("{} of {}", all.felt, all.gone));
}

std::unique_ptr<Scene> scene_of(const DepthFrame& frame, const Contender& contender) {
  TruthScene seen;
  seen.camera.model = frame.camera;
  return make_scene(frame, seen, contender);
}

std::string noise_line(const Recording& recording) {
  if (recording.frames.size() < 2) return "";
  const auto scene = scene_of(recording.frames.back(), all_contenders().front());
  const Source::State told = scene->source(0).state();
  if (!(told.noise > 0)) return "";
  Noise noise;
  for (const Patch& patch : recording.patches) {
    noise.add(recording.frames, recording.mean, patch, told);
  }
  return fmt::format("Measured over told: a pixel's sigma {:.2f}, its correlation {:.2f}.\n\n",
                     spread(noise.pixel).median, spread(noise.mean).median);
}

}  // namespace

Feeler feeler_of(const Contender& contender) {
  return {contender.name, [contender](const DepthFrame& frame) {
            const std::shared_ptr<Scene> scene = scene_of(frame, contender);
            return [=](const Path& path) { return rendered_trace(*scene, contender, path); };
          }};
}

std::string recorded_report(const RecordedOptions& options, const std::vector<Feeler>& feelers) {
  Recording recording{frames_of(options), {}, {}};
  recording.mean = average(recording.frames);
  recording.patches = flat_patches(recording.mean, options);
  std::vector<double> distances;
  for (const Patch& patch : recording.patches) distances.push_back(patch.center.z());
  std::string rows = recording.frames.size() > 1 ? plane_row(recording) : "";
  for (const Feeler& feeler : feelers) rows += feeler_row(recording, options, feeler);
  return fmt::format(
      "{}, {} frames from {}, {} flat parts at {:.2f} m (median), seed {}. Median (worst).\n\n"
      "| | normal, degrees | height, mm | ripple, N | lost, % | ways that felt something |\n"
      "|---|---|---|---|---|---|\n{}\n{}",
      options.folder.filename().string(), recording.frames.size(), options.first,
      recording.patches.size(), spread(distances).median, options.seed, rows,
      noise_line(recording));
}

}  // namespace palpate::accuracy
