// Samples each splat in its plane and adds the samples up in cells.
#include "geometry/splat_cells.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate::detail {
namespace {

constexpr float kReach = 2;             // sigmas that a splat is sampled to (judgement)
constexpr float kFaintest = 1.F / 255;  // opacity; renderers pass over less (format)
constexpr float kMostOpaque = 0.99F;    // opacity; renderers clamp to it (format)
constexpr int kMostSteps = 35;          // from a splat's middle: 71 x 71 samples (judgement)
constexpr double kUsualSamples = 400;   // a splat, on the mean; more would fill memory (judgement)
constexpr double kMostSamples = 2e8;    // of all splats: 3 GB as shares (judgement)
constexpr std::size_t kMostCells = 8'000'000;  // 1.5 GB with all that is found of them (judgement)
constexpr double kCoarser = 1.25;              // edges are tried in steps of this (judgement)
constexpr float kSureShare = 0.5F;  // of the trace, by which l3 has to exceed l2 (measured)
constexpr std::size_t kSplatsAtOnce = 4096;  // that one thread samples (judgement)

// A splat's sampling: a lattice in the plane of its two long axes.
struct Lattice {
  Eigen::Vector3f middle;      // m
  Eigen::Vector3f long_step;   // m
  Eigen::Vector3f short_step;  // m
  Eigen::Vector3f normal;      // its short axis
  float flatness = 0;          // 1 - shortest / middle axis
  int long_steps = 0;          // to each side of the middle
  int short_steps = 0;
  float opacity = 0;

  [[nodiscard]] int size() const { return (2 * long_steps + 1) * (2 * short_steps + 1); }
};

// Axes of a splat, the shortest first.
std::array<int, 3> sorted_axes(const Splat& splat) {
  std::array<int, 3> axes{0, 1, 2};
  std::ranges::stable_sort(axes, {}, [&](int axis) { return splat.sigma[axis]; });
  return axes;
}

int steps_for(float sigma, float edge) {
  if (2 * kReach * sigma <= edge) return 0;
  return static_cast<int>(std::min(std::ceil(kReach * sigma / edge), float{kMostSteps}));
}

Lattice lattice_of(const Splat& splat, float edge) {
  const auto [a, b, c] = sorted_axes(splat);
  const Eigen::Matrix3f axes = splat.rotation.toRotationMatrix();
  Lattice lattice;
  lattice.middle = splat.position;
  lattice.normal = axes.col(a);
  lattice.flatness = splat.sigma[b] > 0 ? 1 - splat.sigma[a] / splat.sigma[b] : 0;
  lattice.long_steps = steps_for(splat.sigma[c], edge);
  lattice.short_steps = steps_for(splat.sigma[b], edge);
  const auto step = [&](int axis, int steps) -> Eigen::Vector3f {
    return axes.col(axis) * (kReach * splat.sigma[axis] / static_cast<float>(std::max(steps, 1)));
  };
  lattice.long_step = step(c, lattice.long_steps);
  lattice.short_step = step(b, lattice.short_steps);
  lattice.opacity = std::min(splat.opacity, kMostOpaque);
  return lattice;
}

struct Sample {
  Eigen::Vector3f position;  // m
  float opacity = 0;         // 0: outside of the splat
};

Sample sample_of(const Lattice& lattice, int k) {
  const int width = 2 * lattice.long_steps + 1;
  const auto i = static_cast<float>(k % width - lattice.long_steps);
  const auto j = static_cast<float>(k / width - lattice.short_steps);
  const float u = kReach * i / static_cast<float>(std::max(lattice.long_steps, 1));
  const float v = kReach * j / static_cast<float>(std::max(lattice.short_steps, 1));
  const float square = u * u + v * v;  // in sigmas
  Sample sample{lattice.middle + i * lattice.long_step + j * lattice.short_step, 0};
  if (square <= kReach * kReach) sample.opacity = lattice.opacity * std::exp(-square / 2);
  return sample;
}

// A splat in a cell, by its strongest sample there.
struct Share {
  std::uint64_t key = 0;
  std::uint32_t splat = 0;
  std::uint32_t sample = 0;

  [[nodiscard]] bool operator<(const Share& other) const {
    return std::tie(key, splat) < std::tie(other.key, other.splat);
  }
};

struct Candidate {
  std::uint64_t key = 0;
  float opacity = 0;
  int sample = 0;
};

void add_shares(const Lattice& lattice, const SplatGrid& grid, std::uint32_t splat,
                std::vector<Candidate>& candidates, std::vector<Share>& shares) {
  candidates.clear();
  for (int k = 0; k < lattice.size(); ++k) {
    const Sample sample = sample_of(lattice, k);
    if (sample.opacity < kFaintest) continue;
    if (const auto key = grid.key_of(sample.position)) {
      candidates.push_back({*key, sample.opacity, k});
    }
  }
  std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
    return std::tuple(a.key, -a.opacity, a.sample) < std::tuple(b.key, -b.opacity, b.sample);
  });
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& each = candidates[i];
    if (i > 0 && candidates[i - 1].key == each.key) continue;
    shares.push_back({each.key, splat, static_cast<std::uint32_t>(each.sample)});
  }
}

// Every splat's shares, sorted by cell.
std::vector<Share> shares_of(std::span<const Splat> splats, const SplatGrid& grid) {
  std::vector<std::vector<Share>> parts((splats.size() + kSplatsAtOnce - 1) / kSplatsAtOnce);
  parallel_each(parts.size(), 1, [&](std::size_t part) {
    std::vector<Candidate> candidates;
    const std::size_t end = std::min(splats.size(), (part + 1) * kSplatsAtOnce);
    for (std::size_t i = part * kSplatsAtOnce; i < end; ++i) {
      if (splats[i].opacity < kFaintest) continue;
      add_shares(lattice_of(splats[i], grid.edge), grid, static_cast<std::uint32_t>(i), candidates,
                 parts[part]);
    }
  });
  std::vector<Share> shares;
  shares.reserve(std::accumulate(
      parts.begin(), parts.end(), std::size_t{0},
      [](std::size_t sum, const std::vector<Share>& part) { return sum + part.size(); }));
  for (std::vector<Share>& part : parts) {
    shares.insert(shares.end(), part.begin(), part.end());
    part = {};
  }
  tbb::parallel_sort(shares.begin(), shares.end());
  return shares;
}

// Takes the main direction of the sum of n n^T.
void set_normal(const Eigen::Matrix3f& sum, SplatCell& cell) {
  const float trace = sum.trace();
  if (!(trace > 0)) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solved(sum / trace);
  cell.normal = solved.eigenvectors().col(2);
  cell.sure = solved.eigenvalues()[2] - solved.eigenvalues()[1] > kSureShare;
}

SplatCell cell_of(std::span<const Share> shares, std::span<const Splat> splats,
                  const SplatGrid& grid) {
  SplatCell cell;
  cell.key = shares.front().key;
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  // from the first sample, which keeps digits
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Matrix3f normals = Eigen::Matrix3f::Zero();
  for (const Share& share : shares) {
    const Splat& splat = splats[share.splat];
    const Lattice lattice = lattice_of(splat, grid.edge);
    const Sample sample = sample_of(lattice, static_cast<int>(share.sample));
    const float depth = -std::log(1 - sample.opacity);
    if (cell.depth == 0) first = sample.position;
    cell.depth += depth;
    offset += depth * (sample.position - first);
    normals += lattice.flatness * lattice.flatness * lattice.normal * lattice.normal.transpose();
    cell.color += depth * Eigen::Vector3f(splat.color[0], splat.color[1], splat.color[2]);
  }
  cell.position = first + offset / cell.depth;
  cell.color /= cell.depth;
  set_normal(normals, cell);
  return cell;
}

// The size such that splats of half the opacity are smaller, m; 0 of none.
float typical_size(std::span<const Splat> splats) {
  std::vector<std::pair<float, float>> sizes;  // and opacities
  double all = 0;
  for (const Splat& splat : splats) {
    if (splat.opacity < kLeastOpacity) continue;
    const auto [a, b, c] = sorted_axes(splat);
    sizes.emplace_back(std::sqrt(splat.sigma[b] * splat.sigma[c]), splat.opacity);
    all += static_cast<double>(splat.opacity);
  }
  std::ranges::sort(sizes);
  double sum = 0;
  for (const auto& [size, opacity] : sizes) {
    sum += static_cast<double>(opacity);
    if (2 * sum >= all) return size;
  }
  return 0;
}

// Samples of splats whose two long sigmas these are, m.
double samples_at(std::span<const std::array<float, 2>> sigmas, float edge) {
  double sum = 0;
  for (const auto& [b, c] : sigmas) {
    sum += (2 * steps_for(b, edge) + 1) * (2 * steps_for(c, edge) + 1);
  }
  return sum;
}

// The smallest edge, in steps from `edge`, at which samples do not fill memory, m.
float bounded_edge(std::span<const Splat> splats, float edge) {
  const auto count = static_cast<double>(splats.size());
  const double most = std::min(kUsualSamples * (count + 1000), std::max(kMostSamples, 2 * count));
  std::vector<std::array<float, 2>> sigmas;
  sigmas.reserve(splats.size());
  for (const Splat& splat : splats) {
    const auto [a, b, c] = sorted_axes(splat);
    sigmas.push_back({splat.sigma[b], splat.sigma[c]});
  }
  while (samples_at(sigmas, edge) > most) edge *= static_cast<float>(kCoarser);
  return edge;
}

// Where each cell begins among sorted shares.
std::vector<std::size_t> begins_of(std::span<const Share> shares) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (i == 0 || shares[i].key != shares[i - 1].key) begins.push_back(i);
  }
  return begins;
}

}  // namespace

SplatGrid grid_for(std::span<const Splat> splats) {
  SplatGrid grid;
  grid.edge = typical_size(splats);
  if (!(grid.edge > 0)) return grid;
  grid.edge = bounded_edge(splats, grid.edge);
  std::vector<float> values(splats.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(splats, values.begin(),
                           [&](const Splat& s) { return s.position[axis]; });
    grid.middle[axis] = static_cast<float>(median(values));
  }
  return grid;
}

std::vector<SplatCell> cells_of(std::span<const Splat> splats, SplatGrid& grid) {
  std::vector<Share> shares = shares_of(splats, grid);
  std::vector<std::size_t> begins = begins_of(shares);
  while (begins.size() > kMostCells) {
    grid.edge *= static_cast<float>(kCoarser);
    shares = {};  // both would fill memory
    shares = shares_of(splats, grid);
    begins = begins_of(shares);
  }
  std::vector<SplatCell> cells(begins.size());
  parallel_each(cells.size(), 256, [&](std::size_t c) {
    const std::size_t end = c + 1 < begins.size() ? begins[c + 1] : shares.size();
    const std::span<const Share> own(shares.data() + begins[c], end - begins[c]);
    cells[c] = cell_of(own, splats, grid);
  });
  return cells;
}

}  // namespace palpate::detail
