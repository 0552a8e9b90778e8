#include "accuracy/depth_noise.hpp"

#include <algorithm>
#include <cmath>

#include "accuracy/normal_generator.hpp"

namespace palpate::accuracy {
namespace {

constexpr double kRounding = 1e-3;               // m
constexpr double kDisparityScale = 525 * 0.075;  // focal length times base line, pixel m
constexpr double kDisparityStep = 1.0 / 8;       // pixels, as the first Kinect has it
constexpr double kSilhouetteJump = 0.02;         // m
constexpr std::uint64_t kSilhouetteStream = 0x9e3779b97f4a7c15;

std::vector<double> gaussian(double blur) {
  const int reach = static_cast<int>(std::ceil(4 * blur));
  std::vector<double> taps;
  double energy = 0;
  for (int i = -reach; i <= reach; ++i) {
    taps.push_back(std::exp(-0.5 * i * i / (blur * blur)));
    energy += taps.back() * taps.back();
  }
  // Squares add up to 1, so that the variance of white noise stays.
  for (double& tap : taps) tap /= std::sqrt(energy);
  return taps;
}

// One pass along rows or columns; the image is taken to go on at its other side, so that the
// variance is the same everywhere.
DepthImage blur_along(const DepthImage& in, const std::vector<double>& taps, int du, int dv) {
  DepthImage out = in;
  const int reach = static_cast<int>(taps.size() / 2);
  for (int v = 0; v < in.height; ++v) {
    for (int u = 0; u < in.width; ++u) {
      double sum = 0;
      for (int i = -reach; i <= reach; ++i) {
        const int uu = (u + i * du + in.width) % in.width;
        const int vv = (v + i * dv + in.height) % in.height;
        sum += taps[static_cast<std::size_t>(i + reach)] * in.at(uu, vv);
      }
      out.at(u, v) = sum;
    }
  }
  return out;
}

double round_to(double value, double step) {
  return step * std::round(value / step);
}

double quantise_disparity(double z) {
  return kDisparityScale / std::max(kDisparityStep, round_to(kDisparityScale / z, kDisparityStep));
}

// Nearest and farthest depth among a pixel and its four neighbours.
std::pair<double, double> depth_range(const DepthImage& image, int u, int v) {
  double low = image.at(u, v);
  double high = low;
  const auto look = [&](int uu, int vv) {
    if (uu < 0 || vv < 0 || uu >= image.width || vv >= image.height) return;
    low = std::min(low, image.at(uu, vv));
    high = std::max(high, image.at(uu, vv));
  };
  look(u - 1, v);
  look(u + 1, v);
  look(u, v - 1);
  look(u, v + 1);
  return {low, high};
}

// Half of the silhouette's pixels are measured as they are, a quarter is missing and a quarter
// flies between the two depths.
DepthImage disturb_silhouettes(const DepthImage& exact, std::uint64_t seed) {
  DepthImage out = exact;
  NormalGenerator random(seed ^ kSilhouetteStream);
  for (int v = 0; v < exact.height; ++v) {
    for (int u = 0; u < exact.width; ++u) {
      const auto [low, high] = depth_range(exact, u, v);
      if (high - low < kSilhouetteJump) continue;
      const double draw = random.uniform();
      const double share = random.uniform();
      if (draw < 0.25) out.at(u, v) = 0;
      if (draw > 0.75) out.at(u, v) = low + share * (high - low);
    }
  }
  return out;
}

double blur_of(NoiseKind kind) {
  if (kind == NoiseKind::blurred) return 2;
  return kind == NoiseKind::quantised ? 4 : 0;
}

}  // namespace

double depth_sigma(double z) {
  return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
}

DepthImage unit_noise(int width, int height, double blur, std::uint64_t seed) {
  DepthImage noise{width, height, std::vector<double>(static_cast<std::size_t>(width) * height)};
  NormalGenerator random(seed);
  for (double& value : noise.depth) value = random.normal();
  if (blur <= 0) return noise;
  const std::vector<double> taps = gaussian(blur);
  return blur_along(blur_along(noise, taps, 1, 0), taps, 0, 1);
}

DepthImage add_noise(const DepthImage& exact, const NoiseOptions& options) {
  DepthImage out = options.silhouettes ? disturb_silhouettes(exact, options.seed) : exact;
  const DepthImage noise =
      unit_noise(exact.width, exact.height, blur_of(options.kind), options.seed);
  for (std::size_t i = 0; i < out.depth.size(); ++i) {
    double& z = out.depth[i];
    if (z <= 0) continue;
    z = std::max(kRounding, z + depth_sigma(z) * noise.depth[i]);
    if (options.kind == NoiseKind::quantised) z = quantise_disparity(z);
    z = round_to(z, kRounding);
  }
  return out;
}

}  // namespace palpate::accuracy
