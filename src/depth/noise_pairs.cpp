#include "depth/noise_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

constexpr int kSide = 16;  // of a tile, pixels
constexpr double kPixels = kSide * kSide;
constexpr double kKept = 0.98;       // of the tiles, those with the smallest means
constexpr int kParts = 4;            // a frame is compared in one of so many parts of the image
constexpr double kForget = 0.99;     // what a frame leaves of the sums
constexpr double kMostShared = 2;    // n_c over what single frames say: more is motion
constexpr double kMovingMean = 5;    // standard deviations
constexpr double kMovingWithin = 3;  // times the variance
constexpr double kFewestTiles = 12;  // that make a sample
constexpr double kEnoughTiles = 40;  // to know n_c
constexpr double kMostTiles = 60;

// Sums in lanes of their own, so that they can be vectorised without changing their order.
struct Lanes {
  std::array<float, kSide> sum{};
  std::array<float, kSide> squares{};
  std::array<float, kSide> depth{};
  std::array<float, kSide> invalid{};
  std::array<float, kSide> changed{};
};

void add_row(Lanes& lanes, const float* now, const float* before, float nearest, float farthest) {
  for (std::size_t i = 0; i < kSide; ++i) {
    const float a = now[i];
    const float b = before[i];
    const bool valid = a >= nearest && a <= farthest && b >= nearest && b <= farthest;
    const float d = valid ? a - b : 0.0F;
    lanes.sum[i] += d;
    lanes.squares[i] += d * d;
    lanes.depth[i] += a;
    lanes.invalid[i] += valid ? 0.0F : 1.0F;
    lanes.changed[i] += a != b ? 1.0F : 0.0F;
  }
}

double total(const std::array<float, kSide>& lanes) {
  double sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

}  // namespace

NoisePairs::NoisePairs() {
  noise_.samples.reserve(kNoiseBins);
}

void NoisePairs::resize(int width, int height) {
  width_ = width;
  height_ = height;
  columns_ = width / kSide;
  rows_ = height / kSide;
  primed_ = false;
  part_ = 0;
  before_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F);
  tiles_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
  sorted_.reserve(tiles_.size());
  bins_ = {};
  noise_.samples.clear();
  noise_.shared = 0;
}

// Rows of tiles come in twos, for tiles of twice the size.
bool NoisePairs::in_part(int row) const {
  return row / 2 % kParts == part_;
}

// Keeps what the next frame will be compared with.
void NoisePairs::keep(const DepthView& frame) {
  part_ = (part_ + 1) % kParts;
  const auto pixels = static_cast<std::ptrdiff_t>(kSide) * width_;
  for (int r = 0; r < rows_; ++r) {
    if (!in_part(r)) continue;
    const auto* begin = frame.depth.data() + r * pixels;
    std::copy(begin, begin + pixels, before_.begin() + r * pixels);
  }
}

// False when nothing at all has changed.
bool NoisePairs::compare(const DepthView& frame) {
  double changed = 0;
  std::fill(tiles_.begin(), tiles_.end(), Tile{});
  for (int r = 0; r < rows_; ++r) {
    if (!in_part(r)) continue;
    for (int c = 0; c < columns_; ++c) {
      Lanes lanes;
      for (int y = 0; y < kSide; ++y) {
        const std::size_t at =
            static_cast<std::size_t>(r * kSide + y) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(c * kSide);
        add_row(lanes, &frame.depth[at], &before_[at], frame.nearest, frame.farthest);
      }
      const double squares = total(lanes.squares);
      changed += total(lanes.changed);
      Tile& tile = tiles_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(c)];
      if (total(lanes.invalid) > 0) continue;
      const double mean = total(lanes.sum) / kPixels;
      tile.z = static_cast<float>(total(lanes.depth) / kPixels);
      tile.mean = static_cast<float>(mean);
      tile.within = static_cast<float>(std::max(0.0, squares / kPixels - mean * mean));
    }
  }
  return changed > 0;
}

void NoisePairs::drop_moving(const NoiseModel& noise, double shared) {
  for (Tile& tile : tiles_) {
    if (tile.z <= 0) continue;
    const double variance = 2 * noise.sigma(tile.z) * noise.sigma(tile.z);
    const double mean = kMovingMean * std::sqrt(kMostShared * std::max(1.0, shared) / kPixels);
    if (tile.within > kMovingWithin * variance || tile.mean * tile.mean > mean * mean * variance) {
      tile.z = 0;
    }
  }
}

void NoisePairs::accumulate(int bin) {
  sorted_.clear();
  for (const Tile& tile : tiles_) {
    if (tile.z > 0 && noise_bin(tile.z) == bin) sorted_.push_back(tile);
  }
  const auto kept =
      static_cast<std::ptrdiff_t>(std::ceil(kKept * static_cast<double>(sorted_.size())));
  std::nth_element(
      sorted_.begin(), sorted_.begin() + std::max<std::ptrdiff_t>(0, kept - 1), sorted_.end(),
      [](const Tile& a, const Tile& b) { return std::abs(a.mean) < std::abs(b.mean); });
  Bin& sums = bins_[static_cast<std::size_t>(bin)];
  for (auto tile = sorted_.begin(); tile != sorted_.begin() + kept; ++tile) {
    ++sums.tiles;
    sums.z += tile->z;
    sums.within += tile->within;
    sums.mean2 += tile->mean * tile->mean;
  }
}

void NoisePairs::accumulate_large() {
  const auto columns = static_cast<std::size_t>(columns_);
  for (int r = 0; r + 1 < rows_; r += 2) {
    for (int c = 0; c + 1 < columns_; c += 2) {
      const Tile* a = &tiles_[static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c)];
      const Tile* b = a + columns;
      if (a[0].z <= 0 || a[1].z <= 0 || b[0].z <= 0 || b[1].z <= 0) continue;
      double mean = 0;
      double power = 0;
      for (const Tile* tile : {&a[0], &a[1], &b[0], &b[1]}) {
        mean += 0.25 * tile->mean;
        power += 0.25 * (tile->within + tile->mean * tile->mean);
      }
      Bin& sums = bins_[static_cast<std::size_t>(noise_bin(a->z))];
      ++sums.large_tiles;
      sums.large_mean2 += mean * mean;
      sums.large_power += power;
    }
  }
}

// n_c = k^2 mean(tile mean^2) / mean(D^2). Tiles of 16 and 32 pixels both cut the correlation off
// at their borders, by a share that falls with 1/k: the smaller share's half is put back.
void NoisePairs::conclude(double shared) {
  double tiles = 0;
  double small = 0;
  double large_tiles = 0;
  double large = 0;
  for (const Bin& bin : bins_) {
    if (bin.tiles < kFewestTiles) continue;
    tiles += bin.tiles;
    small += bin.tiles * kPixels * bin.mean2 / std::max(1e-30, bin.mean2 + bin.within);
    if (bin.large_power <= 0) continue;
    large_tiles += bin.large_tiles;
    large += bin.large_tiles * 4 * kPixels * bin.large_mean2 / bin.large_power;
  }
  noise_.samples.clear();
  noise_.shared = 0;
  if (tiles < kEnoughTiles) return;
  small /= tiles;
  large = large_tiles > kFewestTiles ? large / large_tiles : small;
  const double most = kMostShared * std::max(1.0, shared);
  noise_.shared = std::min(most, std::max(small, large) + 0.5 * std::max(0.0, large - small));
  for (const Bin& bin : bins_) {
    if (bin.tiles < kFewestTiles) continue;
    const double in_tile = std::min({noise_.shared, shared, 0.5 * kPixels}) / kPixels;
    const double variance = 0.5 * (bin.within / bin.tiles) / (1 - in_tile);
    if (!(variance > 0)) continue;
    noise_.samples.push_back(
        {bin.z / bin.tiles, std::sqrt(variance), std::min(bin.tiles, kMostTiles)});
  }
}

bool NoisePairs::add(const DepthView& frame, const NoiseModel& noise, double shared) {
  const bool primed = primed_;
  if (primed && !compare(frame)) return false;
  keep(frame);
  primed_ = true;
  if (!primed) return true;
  drop_moving(noise, shared);
  for (Bin& bin : bins_) {
    bin.tiles *= kForget;
    bin.z *= kForget;
    bin.within *= kForget;
    bin.mean2 *= kForget;
    bin.large_tiles *= kForget;
    bin.large_mean2 *= kForget;
    bin.large_power *= kForget;
  }
  for (int bin = 0; bin < kNoiseBins; ++bin) accumulate(bin);
  accumulate_large();
  conclude(shared);
  return true;
}

}  // namespace palpate::depth
