// Bends, mixes and frays simulated depths at silhouettes, and punches holes.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/numbers.hpp"
#include "sim/simulated_noise.hpp"

namespace palpate::sim {
namespace {

constexpr float kDepthJump = 0.02f;      // m between neighbouring pixels (judgement)
constexpr int kRim = 3;                  // pixels before and behind a jump (judgement)
constexpr int kWindow = 8;               // pixels in which a rim's overhang is constant (judgement)
constexpr double kLeastRadius = 1.5;     // of holes, pixels (judgement)
constexpr double kMostRadius = 6;        // of holes, pixels (judgement)
constexpr std::uint64_t kLeastLife = 2;  // of holes, frames (judgement)
constexpr std::uint64_t kMostLife = 8;   // of holes, frames (judgement)
constexpr std::uint64_t kRimStream = 0x27d4eb2f165667c5u;
constexpr std::uint64_t kHoleStream = 0x85ebca77c2b2ae63u;

// The depths that meet at a pixel, and whether nothing at all is beside it.
struct Around {
  float low;
  float high;
  bool open = false;
};

Around around(const DepthView& image, int u, int v) {
  Around out{image.at(u, v), image.at(u, v)};
  const auto look = [&](int uu, int vv) {
    if (!image.inside(uu, vv)) return;
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

// Calls f(u, v, depth there) for pixels that have one.
template <class F>
void for_pixels(const DepthView& image, float* depth, const F& f) {
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u, ++depth) {
      if (image.at(u, v) > 0) f(u, v, *depth);
    }
  }
}

// Calls f(u, v, du, dv) where depths jump: at the nearer pixel, with the direction to the farther
// one.
template <class F>
void for_jumps(const DepthView& image, const F& f) {
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const float z = image.at(u, v);
      for (const auto& [du, dv] : {std::pair{1, 0}, {0, 1}}) {
        if (u + du >= image.width || v + dv >= image.height) continue;
        const float other = image.at(u + du, v + dv);
        if (std::abs(other - z) < kDepthJump || z <= 0 || other <= 0) continue;
        other > z ? f(u, v, du, dv) : f(u + du, v + dv, -du, -dv);
      }
    }
  }
}

// Overhang of a rim over the background, pixels.
int reach_at(std::uint64_t seed, int u, int v) {
  const auto window = static_cast<std::uint64_t>((v / kWindow << 16) + u / kWindow);
  return 1 + static_cast<int>(Random(seed ^ (kRimStream + window)).bits() % kRim);
}

}  // namespace

// First the nearer sides, where the rim next to a pixel bends it; then what they cover.
void bend_rims(const DepthView& exact, const SimulatedNoiseOptions& options, float* depth) {
  const auto bend = [&](int distance) {
    return static_cast<float>(options.curl * distance * distance / (4 * kRim * kRim));
  };
  for_jumps(exact, [&](int u, int v, int du, int dv) {
    for (int distance = kRim; distance > 0; --distance, u -= du, v -= dv) {
      if (!exact.inside(u, v) || exact.at(u, v) <= 0) return;
      float& z = depth[v * exact.width + u];
      const float bent = exact.at(u, v) + bend(distance);
      z = options.curl > 0 ? std::max(z, bent) : std::min(z, bent);
    }
  });
  for_jumps(exact, [&](int u, int v, int du, int dv) {
    const float base = exact.at(u, v);
    for (int k = reach_at(options.seed, u, v); k > 0; --k) {
      if (!exact.inside(u + k * du, v + k * dv)) continue;
      float& z = depth[(v + k * dv) * exact.width + u + k * du];
      if (z > 0) z = std::min(z, base + bend(kRim + k));
    }
  });
}

void mix_rims(const DepthView& exact, const SimulatedNoiseOptions& options, float* depth) {
  const double beside = std::exp(-0.5 / (options.mixed * options.mixed));
  for_pixels(exact, depth, [&](int u, int v, float& measured) {
    const Around near = around(exact, u, v);
    if (near.high - near.low < kDepthJump) return;
    double light = 0;
    double sum = 0;
    for (int i = 0; i < 9; ++i) {
      const int uu = u + i % 3 - 1;
      const int vv = v + i / 3 - 1;
      const double z = exact.inside(uu, vv) ? exact.at(uu, vv) : 0;
      if (z <= 0) continue;
      const double weight = (uu == u ? 1 : beside) * (vv == v ? 1 : beside) / (z * z);
      light += weight;
      sum += weight * z;
    }
    measured = static_cast<float>(sum / light);
  });
}

// Half of the silhouette's pixels are measured as they are.
void disturb_silhouettes(const DepthView& exact, std::uint64_t seed, bool far_side, float* depth) {
  Random random(seed);
  for_pixels(exact, depth, [&](int u, int v, float& z) {
    const Around near = around(exact, u, v);
    if (near.high - near.low < kDepthJump && !near.open) return;
    const double draw = random.uniform();
    const auto share = static_cast<float>(random.uniform());
    if (far_side && z - near.low < near.high - z) return;
    if (draw < 0.25) z = 0;
    if (draw > 0.75) z = near.low + share * (near.high - near.low);
  });
}

// So many slots each have one disc at a time, in no order with one another: n of them cover
// 1 - exp(-n area / all). Nothing is kept from frame to frame, as frames may be lost.
void punch_holes(const DepthView& exact, const SimulatedNoiseOptions& options, std::uint64_t frame,
                 float* depth) {
  const double across = exact.width + 2 * kMostRadius;
  const double down = exact.height + 2 * kMostRadius;
  const double area = std::numbers::pi / 3 *
                      (kLeastRadius * kLeastRadius + kLeastRadius * kMostRadius +
                       kMostRadius * kMostRadius);  // mean
  const std::uint64_t first = Random(options.seed ^ kHoleStream).bits();
  const auto slots =
      static_cast<std::uint64_t>(std::lround(-std::log1p(-options.holes) * across * down / area));
  for (std::uint64_t slot = 0; slot < slots; ++slot) {
    Random own(first + slot);
    const std::uint64_t life = kLeastLife + own.bits() % (kMostLife - kLeastLife + 1);
    const std::uint64_t before = (frame + own.bits() % life) / life;
    Random disc(own.bits() + before);
    const double radius = kLeastRadius + (kMostRadius - kLeastRadius) * disc.uniform();
    const double u = across * disc.uniform() - kMostRadius;
    const double v = down * disc.uniform() - kMostRadius;
    for (int row = static_cast<int>(std::ceil(v - radius)); row <= v + radius; ++row) {
      const double half = std::sqrt(radius * radius - (row - v) * (row - v));
      for (int column = static_cast<int>(std::ceil(u - half)); column <= u + half; ++column) {
        if (exact.inside(column, row)) depth[row * exact.width + column] = 0;
      }
    }
  }
}

}  // namespace palpate::sim
