#include "palpate/sensor/simulated_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr float kDisparityScale = 525 * 0.075f;  // focal length times base line, pixel m
constexpr float kDisparitySteps = 8;             // a pixel, as the first Kinect has it
constexpr float kSilhouetteJump = 0.02f;         // m
constexpr std::uint64_t kSilhouetteStream = 0x9e3779b97f4a7c15u;
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

double blur_of(NoiseKind kind) {
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

float quantise_disparity(float z) {
  const float steps = std::rint(kDisparitySteps * kDisparityScale / z);
  return kDisparitySteps * kDisparityScale / std::max(1.0f, steps);
}

struct Image {
  int width;
  int height;
  const float* depth;

  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * width + u];
  }
};

// The depths that meet at a pixel, and whether nothing at all is beside it.
struct Around {
  float low;
  float high;
  bool open = false;
};

Around around(const Image& image, int u, int v) {
  Around out{image.at(u, v), image.at(u, v)};
  const auto look = [&](int uu, int vv) {
    if (uu < 0 || vv < 0 || uu >= image.width || vv >= image.height) return;
    const float z = image.at(uu, vv);
    if (z <= 0) {
      out.open = true;
      return;
    }
    out.low = std::min(out.low, z);
    out.high = std::max(out.high, z);
  };
  look(u - 1, v);
  look(u + 1, v);
  look(u, v - 1);
  look(u, v + 1);
  return out;
}

// Half of the silhouette's pixels are measured as they are.
void disturb_silhouettes(const Image& exact, std::uint64_t seed, std::vector<float>& depth) {
  Random random(seed);
  for (int v = 0; v < exact.height; ++v) {
    for (int u = 0; u < exact.width; ++u) {
      if (exact.at(u, v) <= 0) continue;
      const Around near = around(exact, u, v);
      if (near.high - near.low < kSilhouetteJump && !near.open) continue;
      const double draw = random.uniform();
      const auto share = static_cast<float>(random.uniform());
      float& z = depth[static_cast<std::size_t>(v) * exact.width + u];
      if (draw < 0.25) z = 0;
      if (draw > 0.75) z = near.low + share * (near.high - near.low);
    }
  }
}

void check(const SimulatedNoiseOptions& options) {
  if (!(options.rounding >= 0 && options.rounding < 1)) {
    throw Error(fmt::format("depths cannot be rounded to {:g} m; give 0 to 1", options.rounding));
  }
}

}  // namespace

NoiseModel kinect_like_noise() {
  NoiseModel model;
  model.coefficients = {0.0012 + 0.0019 * 0.4 * 0.4, -2 * 0.0019 * 0.4, 0.0019};
  return model;
}

SimulatedNoise::SimulatedNoise(const SimulatedNoiseOptions& options)
    : options_(options), taps_(half_gaussian(blur_of(options.kind))) {
  check(options);
  if (options.kind != NoiseKind::none) quantiles_ = normal_quantiles();
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

// One draw of 64 bits serves four pixels.
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

void SimulatedNoise::apply(int width, int height, std::uint64_t frame, std::vector<float>& depth) {
  if (options_.silhouettes) {
    exact_ = depth;
    disturb_silhouettes({width, height, exact_.data()},
                        stream(options_.seed ^ kSilhouetteStream, frame), depth);
  }
  const std::vector<float>& noise = unit_noise(width, height, frame);
  const auto step = static_cast<float>(options_.rounding);
  const float steps = step > 0 ? 1 / step : 0;
  const float least = std::max(step, 1e-6f);
  const bool quantised = options_.kind == NoiseKind::quantised;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float exact = depth[i];
    float z = exact + static_cast<float>(options_.model.sigma(exact)) * noise[i];
    z = std::max(least, z);
    if (quantised) z = quantise_disparity(z);
    if (step > 0) z = step * std::rint(steps * z);
    depth[i] = exact > 0 ? z : 0;
  }
}

}  // namespace palpate
