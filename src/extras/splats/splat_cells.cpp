// Samples each splat in its plane and adds the samples up in cells.
#include "extras/splats/splat_cells.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "geometry/parallel.hpp"

namespace palpate::detail {
namespace {

constexpr float kReach = 2;                  // sigmas that a splat is sampled to (judgement)
constexpr float kAgreedShare = 0.5F;         // of the trace, by which l3 exceeds l2 (measured)
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

// Steps from the middle of a splat to where it ends.
float steps_for(float sigma, float edge) {
  return 2 * kReach * sigma <= edge ? 0 : std::ceil(kReach * sigma / edge);
}

Lattice lattice_of(const Splat& splat, float edge) {
  const auto [a, b, c] = sorted_axes(splat);
  const Eigen::Matrix3f axes = splat.rotation.toRotationMatrix();
  Lattice lattice;
  lattice.middle = splat.position;
  lattice.normal = axes.col(a);
  lattice.flatness = splat.sigma[b] > 0 ? 1 - splat.sigma[a] / splat.sigma[b] : 0;
  lattice.long_steps = static_cast<int>(steps_for(splat.sigma[c], edge));
  lattice.short_steps = static_cast<int>(steps_for(splat.sigma[b], edge));
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

struct Candidate {
  std::uint64_t key = 0;
  float opacity = 0;
  int sample = 0;
};

void add_shares(const Lattice& lattice, const SplatGrid& grid, std::uint32_t splat,
                std::vector<Candidate>& candidates, std::vector<SplatShare>& shares) {
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

// Takes the main direction of the sum of n n^T.
void set_normal(const Eigen::Matrix3f& sum, SplatCell& cell) {
  const float trace = sum.trace();
  if (!(trace > 0)) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solved(sum / trace);
  cell.normal = solved.eigenvectors().col(2);
  cell.confident = solved.eigenvalues()[2] - solved.eigenvalues()[1] > kAgreedShare;
}

SplatCell cell_of(std::span<const SplatShare> shares, std::span<const Splat> splats,
                  const SplatGrid& grid) {
  SplatCell cell;
  cell.key = shares.front().key;
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  // from the first sample, which keeps digits
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Matrix3f normals = Eigen::Matrix3f::Zero();
  for (const SplatShare& share : shares) {
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

// Where each cell begins among sorted shares.
std::vector<std::size_t> begins_of(std::span<const SplatShare> shares) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (i == 0 || shares[i].key != shares[i - 1].key) begins.push_back(i);
  }
  return begins;
}

}  // namespace

std::array<int, 3> sorted_axes(const Splat& splat) {
  std::array<int, 3> axes{0, 1, 2};
  std::ranges::stable_sort(axes, {}, [&](int axis) { return splat.sigma[axis]; });
  return axes;
}

double samples_of(const Splat& splat, float edge) {
  const auto [a, b, c] = sorted_axes(splat);
  const auto wide = [&](int axis) {
    return 2 * static_cast<double>(steps_for(splat.sigma[axis], edge)) + 1;
  };
  return wide(b) * wide(c);
}

std::vector<SplatShare> shares_of(std::span<const Splat> splats, const SplatGrid& grid) {
  std::vector<std::vector<SplatShare>> parts((splats.size() + kSplatsAtOnce - 1) / kSplatsAtOnce);
  parallel_each(parts.size(), 1, [&](std::size_t part) {
    std::vector<Candidate> candidates;
    const std::size_t end = std::min(splats.size(), (part + 1) * kSplatsAtOnce);
    for (std::size_t i = part * kSplatsAtOnce; i < end; ++i) {
      add_shares(lattice_of(splats[i], grid.edge), grid, static_cast<std::uint32_t>(i), candidates,
                 parts[part]);
    }
  });
  std::vector<SplatShare> shares;
  shares.reserve(std::accumulate(
      parts.begin(), parts.end(), std::size_t{0},
      [](std::size_t sum, const std::vector<SplatShare>& part) { return sum + part.size(); }));
  for (std::vector<SplatShare>& part : parts) {
    shares.insert(shares.end(), part.begin(), part.end());
    part = {};
  }
  detail::parallel_sort(shares.begin(), shares.end());
  return shares;
}

std::vector<SplatCell> cells_of(std::span<const SplatShare> shares, std::span<const Splat> splats,
                                const SplatGrid& grid) {
  const std::vector<std::size_t> begins = begins_of(shares);
  std::vector<SplatCell> cells(begins.size());
  parallel_each(cells.size(), 256, [&](std::size_t c) {
    const std::size_t end = c + 1 < begins.size() ? begins[c + 1] : shares.size();
    cells[c] = cell_of(shares.subspan(begins[c], end - begins[c]), splats, grid);
  });
  return cells;
}

}  // namespace palpate::detail
