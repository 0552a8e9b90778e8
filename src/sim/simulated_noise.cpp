// Disturbs exact depths as a sensor does: correlated noise, fixed patterns, faults, rounding.
#include "sim/simulated_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "geometry/parallel.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr float kDisparityScale = 525 * 0.075f;  // focal length times base line, pixel m
constexpr float kKinectStep = 0.125f;            // of disparity, pixels, as the first Kinect has it
constexpr std::uint64_t kSilhouetteStream = 0x9e3779b97f4a7c15u;
constexpr std::uint64_t kPatternStream = 0xc2b2ae3d27d4eb4fu;
constexpr std::uint64_t kHopStream = 0xd6e8feb86659fd93u;
constexpr std::uint64_t kRowStream = 0x165667b19e3779f9u;
constexpr int kQuantileBits = 16;

double density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
}

// The upper half's quantiles by Newton's method, each from the one before it; scaled so that the
// mean of their squares is 1 as the distribution's is.
std::vector<float> normal_quantiles() {
  const int n = 1 << kQuantileBits;
  std::vector<double> upper;
  double x = 0;
  double squares = 0;
  for (int i = 0; i < n / 2; ++i) {
    const double above = (n / 2 - i - 0.5) / n;  // probability of larger values
    for (int k = 0; k < 4; ++k) {
      x += (0.5 * std::erfc(x / std::numbers::sqrt2) - above) / density(x);
    }
    upper.push_back(x);
    squares += x * x;
  }
  const double scale = std::sqrt(static_cast<double>(n / 2) / squares);
  std::vector<float> quantiles;
  for (int i = 0; i < n; ++i) {
    const double value = i < n / 2 ? -upper[n / 2 - 1 - i] : upper[i - n / 2];
    quantiles.push_back(static_cast<float>(scale * value));
  }
  return quantiles;
}

// The middle tap and those on one side of it. Squares of all add up to 1, so that the variance of
// white noise stays.
std::vector<float> half_gaussian(double blur) {
  if (blur <= 0) return {};
  const int reach = static_cast<int>(std::ceil(4 * blur));
  double energy = 0;
  for (int i = -reach; i <= reach; ++i) energy += std::exp(-i * i / (blur * blur));
  std::vector<float> taps;
  for (int i = 0; i <= reach; ++i) {
    taps.push_back(static_cast<float>(std::exp(-0.5 * i * i / (blur * blur)) / std::sqrt(energy)));
  }
  return taps;
}

// The correlation of white noise after a Gaussian blur of s pixels is 2 sqrt(pi) s.
double blur_of(NoiseKind kind, double correlation) {
  if (correlation > 0) return correlation / (2 * std::sqrt(std::numbers::pi));
  if (kind == NoiseKind::blurred) return 2;
  return kind == NoiseKind::quantised ? 4 : 0;
}

// Independent streams for frames beside one another.
std::uint64_t stream(std::uint64_t seed, std::uint64_t frame) {
  return Random(Random(seed).bits() + frame).bits();
}

// out[i] = t0 in[i] + sum t_k (in[i - k] + in[i + k]), where in[i +- k] is at `stride` * k.
void blur_span(const float* in, std::size_t stride, std::size_t count,
               const std::vector<float>& taps, float* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = taps[0] * in[i];
  for (std::size_t k = 1; k < taps.size(); ++k) {
    const float tap = taps[k];
    const float* before = in - k * stride;
    const float* behind = in + k * stride;
    for (std::size_t i = 0; i < count; ++i) out[i] += tap * (before[i] + behind[i]);
  }
}

// `scale` is kDisparityScale over the step; a row that is `offset` steps off rounds elsewhere.
float quantise_disparity(float z, float scale, float offset) {
  return scale / std::max(1.0f, std::rint(scale / z + offset));
}

// Steps of disparity, a quarter at most. Correlation windows see the same piece of the sensor and
// of its pattern in each frame, so it does not change and averaging over frames leaves it.
float row_offset(std::uint64_t seed, std::uint64_t row) {
  return static_cast<float>(0.5 * Random(stream(seed ^ kRowStream, row)).uniform() - 0.25);
}

// What a whole frame is off by, m: most are not.
double hop_of(const SimulatedNoiseOptions& options, std::uint64_t frame) {
  constexpr double kShare = 0.25;  // of frames that are off; judgement
  Random random(stream(options.seed ^ kHopStream, frame));
  const double drawn = random.uniform();
  return drawn < kShare ? options.hops * (2 * random.uniform() - 1) : 0;
}

void check(const SimulatedNoiseOptions& options) {
  struct Bounded {
    const char* what;
    double value, least, most;
  };
  for (const Bounded& range : {Bounded{"a rounding (m)", options.rounding, 0, 1},
                               Bounded{"a disparity step (pixels)", options.disparity_step, 0, 8},
                               Bounded{"a curl (m)", options.curl, -0.1, 0.1},
                               Bounded{"a footprint of mixed pixels", options.mixed, 0, 1},
                               Bounded{"a pattern (m)", options.pattern, 0, 0.1},
                               Bounded{"a correlation (pixels)", options.correlation, 0, 30},
                               Bounded{"a smoothing (pixels)", 1.0 * options.smoothing, 0, 15},
                               Bounded{"hops (m)", options.hops, 0, 0.1},
                               Bounded{"a share of holes", options.holes, 0, 0.9}}) {
    if (range.value >= range.least && range.value <= range.most) continue;
    throw Error(fmt::format("a simulated camera cannot have {} of {:g}; give {:g} to {:g}",
                            range.what, range.value, range.least, range.most));
  }
}

}  // namespace

NoiseModel kinect_like_noise() {
  NoiseModel model;
  model.coefficients = {0.0012 + 0.0019 * 0.4 * 0.4, -2 * 0.0019 * 0.4, 0.0019};
  return model;
}

SimulatedNoise::SimulatedNoise(const SimulatedNoiseOptions& options)
    : options_(options), taps_(half_gaussian(blur_of(options.kind, options.correlation))) {
  check(options);
  if (options.kind != NoiseKind::none || options.pattern > 0) quantiles_ = normal_quantiles();
}

const std::vector<float>& SimulatedNoise::unit_noise(int width, int height, std::uint64_t frame) {
  noise_.resize(static_cast<std::size_t>(width) * height);
  if (options_.kind == NoiseKind::none) {
    std::fill(noise_.begin(), noise_.end(), 0.0f);
    return noise_;
  }
  draw(stream(options_.seed, frame));
  if (!taps_.empty()) blur(width, height);
  return noise_;
}

// Uses each draw of 64 bits for four pixels.
void SimulatedNoise::draw(std::uint64_t seed) {
  Random random(seed);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    bits = i % 4 == 0 ? random.bits() : bits >> kQuantileBits;
    noise_[i] = quantiles_[bits & ((1u << kQuantileBits) - 1)];
  }
}

// Along rows, then along columns. The image is taken to go on at its other side, so that the
// variance is the same everywhere.
void SimulatedNoise::blur(int width, int height) {
  const int reach = static_cast<int>(taps_.size()) - 1;
  const auto columns = static_cast<std::size_t>(width);
  row_.resize(columns + 2 * static_cast<std::size_t>(reach));
  padded_.resize(columns * static_cast<std::size_t>(height + 2 * reach));
  const auto around = [](int i, int n) { return static_cast<std::size_t>(((i % n) + n) % n); };
  for (int v = 0; v < height; ++v) {
    const float* in = &noise_[columns * static_cast<std::size_t>(v)];
    for (int i = 0; i < width + 2 * reach; ++i) {
      row_[static_cast<std::size_t>(i)] = in[around(i - reach, width)];
    }
    blur_span(&row_[static_cast<std::size_t>(reach)], 1, columns, taps_,
              &padded_[columns * static_cast<std::size_t>(v + reach)]);
  }
  for (int i = 0; i < 2 * reach; ++i) {
    const int v = i < reach ? i : height + i;
    const std::size_t from = around(v - reach, height) + static_cast<std::size_t>(reach);
    std::copy_n(&padded_[columns * from], columns, &padded_[columns * static_cast<std::size_t>(v)]);
  }
  for (int v = 0; v < height; ++v) {
    blur_span(&padded_[columns * static_cast<std::size_t>(v + reach)], columns, columns, taps_,
              &noise_[columns * static_cast<std::size_t>(v)]);
  }
}

// Applies the faults at depth jumps to exact depths.
void SimulatedNoise::disturb_rims(int width, int height, std::uint64_t frame,
                                  std::vector<float>& depth) {
  const auto copy = [&] {
    exact_ = depth;
    return sim::DepthView{width, height, exact_.data()};
  };
  if (options_.curl != 0) sim::bend_rims(copy(), options_, depth.data());
  if (options_.mixed > 0) sim::mix_rims(copy(), options_, depth.data());
  if (options_.silhouettes) {
    sim::disturb_silhouettes(copy(), stream(options_.seed ^ kSilhouetteStream, frame),
                             options_.curl != 0, depth.data());
  }
}

// Means over squares, of pixels that differ from the middle one by less than 2 %.
void SimulatedNoise::smooth(int width, int height, std::vector<float>& depth) {
  constexpr float kSame = 0.02F;  // of the depth; judgement
  exact_ = depth;
  const sim::DepthView view{width, height, exact_.data()};
  const int reach = options_.smoothing;
  detail::parallel_each(static_cast<std::size_t>(height), 8, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < width; ++u) {
      const float middle = view.at(u, v);
      float sum = 0;
      int count = 0;
      for (int y = std::max(v - reach, 0); y <= std::min(v + reach, height - 1); ++y) {
        for (int x = std::max(u - reach, 0); x <= std::min(u + reach, width - 1); ++x) {
          const float z = view.at(x, y);
          if (std::abs(z - middle) > kSame * middle) continue;
          sum += z;
          ++count;
        }
      }
      if (middle > 0) depth[row * static_cast<std::size_t>(width) + u] = sum / count;
    }
  });
}

// The same in all frames.
void SimulatedNoise::add_pattern(int width, int height, std::vector<float>& depth) {
  if (pattern_.size() != depth.size()) {
    noise_.resize(depth.size());
    draw(stream(options_.seed ^ kPatternStream, 0));
    if (options_.correlation > 0 && !taps_.empty()) blur(width, height);
    pattern_ = noise_;
  }
  const auto deviation = static_cast<float>(options_.pattern);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] > 0) depth[i] += deviation * pattern_[i];
  }
}

void SimulatedNoise::apply(int width, int height, std::uint64_t frame, std::vector<float>& depth) {
  disturb_rims(width, height, frame, depth);
  if (options_.pattern > 0) add_pattern(width, height, depth);
  const std::vector<float>& noise = unit_noise(width, height, frame);
  const auto step = static_cast<float>(options_.rounding);
  const float steps = step > 0 ? 1 / step : 0;
  const float least = std::max(step, 1e-6f);
  const bool terraced = options_.disparity_step > 0;
  const bool quantised = terraced || options_.kind == NoiseKind::quantised;
  const float scale =
      kDisparityScale / (terraced ? static_cast<float>(options_.disparity_step) : kKinectStep);
  const auto hop = static_cast<float>(options_.hops > 0 ? hop_of(options_, frame) : 0);
  const auto columns = static_cast<std::size_t>(width);
  for (std::size_t first = 0; first < depth.size(); first += columns) {
    const float offset = terraced ? row_offset(options_.seed, first / columns) : 0;
    for (std::size_t i = first; i < first + columns; ++i) {
      const float exact = depth[i];
      float z = exact + hop + static_cast<float>(options_.model.sigma(exact)) * noise[i];
      z = std::max(least, z);
      if (quantised) z = quantise_disparity(z, scale, offset);
      if (step > 0) z = step * std::rint(steps * z);
      depth[i] = exact > 0 ? z : 0;
    }
  }
  if (options_.smoothing > 0) smooth(width, height, depth);
  if (options_.holes > 0) {
    sim::punch_holes({width, height, depth.data()}, options_, frame, depth.data());
  }
}

}  // namespace palpate
