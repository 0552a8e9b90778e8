// Averages each block over time while it stands still, and follows it while it moves.
#include "depth/temporal_filter.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

constexpr float kLonger = 8;    // times the memory, at most (docs/method.md 6.6)
constexpr int kCalmFrames = 2;  // calm frames after which a moving block rests (docs/method.md 6.6)
constexpr float kLearn = 1 / 16.F;  // share of a frame in the learned scatter (docs/method.md 6.6)

// Times a variance s^2; learned scatter does not reach it by chance. A product of two moves has the
// variance 5 s^4 and the covariance s^4 with the next; the running mean has 1/31 of the sum of 7.
// Five deviations up: 1 + 5 sqrt(7 / 31) (derived).
constexpr float kExcess = 3.4F;

float squared(float x) {
  return x * x;
}

/// Measurement of a block in one frame.
struct Measured {
  float rho, variance, slope_x, slope_y, slope_variance, confidence;
  FilteredDepth::State state;
};

Measured measured(const BlockFits& fits, std::size_t i) {
  return {fits.rho[i],     fits.variance[i],       fits.slope_x[i],
          fits.slope_y[i], fits.slope_variance[i], fits.confidences[i],
          fits.states[i]};
}

void restart(const Measured& now, BlockMemory& m) {
  m.rho = now.rho;
  m.variance = now.variance;
  m.extra = 0;
  m.slope_x = now.slope_x;
  m.slope_y = now.slope_y;
  m.slope_variance = now.slope_variance;
  m.confidence = now.confidence;
  m.count = 1;
  m.calm = 0;
  m.state = now.state;
}

/// Learns how frames of one surface scatter: more than they claim where the fit's window depends on
/// the noise and where rims flicker. Under noise of variance s^2, two successive moves of a still
/// surface have the mean product -s^2; a surface that moves by v adds v^2.
void learn_scatter(const Measured& now, BlockMemory& m) {
  const bool sloped = now.confidence > 0;
  const float values[] = {now.rho, sloped ? now.slope_x : m.last[1],
                          sloped ? now.slope_y : m.last[2]};
  const float limit = another_surface(std::max(now.rho, m.last[0]));
  if (m.state != now.state) m.scatter = m.slope_scatter = 0;
  const bool same = m.state == now.state && std::abs(now.rho - m.last[0]) <= limit;
  float products[3];
  for (int k = 0; k < 3; ++k) {
    const float move = same ? values[k] - m.last[k] : 0.0F;
    products[k] = move * m.moves[k];
    m.moves[k] = move;
    m.last[k] = values[k];
  }
  if (!same) return;
  const float slopes = (products[1] + products[2]) / 2;
  m.scatter = std::max(0.0F, m.scatter - kLearn * (products[0] + m.scatter));
  m.slope_scatter = std::max(0.0F, m.slope_scatter - kLearn * (slopes + m.slope_scatter));
}

/// The variance of one frame that claims to have `claimed`.
float believed(float claimed, float scatter) {
  return scatter > kExcess * claimed ? scatter : claimed;
}

/// Is the frame within the gate of what is remembered? Slopes that nothing vouches for are not
/// compared.
bool agrees(const Measured& now, const BlockMemory& m, float gate2) {
  const float share = 1 / static_cast<float>(m.count);
  const float variance = m.variance * share + m.extra + now.variance;
  if (squared(now.rho - m.rho) > gate2 * variance) return false;
  if (!(now.confidence > 0 && m.confidence > 0)) return true;
  const float slope = m.slope_variance * share + now.slope_variance;
  const float turned = squared(now.slope_x - m.slope_x) + squared(now.slope_y - m.slope_y);
  return turned <= 2 * gate2 * slope;
}

void average_slopes(const Measured& now, float share, BlockMemory& m) {
  if (now.confidence > 0) {
    if (!(m.confidence > 0)) share = 1;
    m.slope_x += share * (now.slope_x - m.slope_x);
    m.slope_y += share * (now.slope_y - m.slope_y);
    m.slope_variance += share * (now.slope_variance - m.slope_variance);
  }
  m.confidence += share * (now.confidence - m.confidence);
}

/// Frames that a still block averages: more where one frame's normal is less precise than is
/// wanted.
int remembered(const TemporalOptions& options, const BlockMemory& m) {
  const bool fitted = m.state == FilteredDepth::State::fitted && m.confidence > 0;
  if (!fitted || !(options.normal_error > 0) || options.memory == 1) return options.memory;
  const float wanted = squared(static_cast<float>(options.normal_error) * m.rho);
  const float longer = std::clamp(m.slope_variance / wanted, 1.0F, kLonger);
  return std::min(255, static_cast<int>(longer * static_cast<float>(options.memory)));
}

bool average(const Measured& now, int memory, BlockMemory& m) {
  m.count = static_cast<std::uint8_t>(std::min(memory, m.count + 1));
  const float share = 1 / static_cast<float>(m.count);
  m.rho += share * (now.rho - m.rho);
  m.variance += share * (now.variance - m.variance);
  m.extra *= squared(1 - share);
  average_slopes(now, share, m);
  return m.count == memory;
}

// Takes the frame as it is, since a hand feels whatever lags behind what moves.
void follow(const Measured& now, float gate2, BlockMemory& m) {
  const float d = now.rho - m.rho;
  // A surface that approaches slowly looks calm in each single frame.
  const float change = std::max(std::abs(d), std::abs(now.rho - m.calm_since));
  const bool calm = squared(change) <= gate2 * (m.variance + now.variance);
  const std::uint8_t calm_frames = calm ? m.calm + 1 : 0;
  restart(now, m);
  m.calm = calm_frames;
  if (!calm) m.calm_since = now.rho;
  if (calm_frames >= kCalmFrames) m.moving = false;
}

/// Takes in a measured block. Has its mean as many frames as it will have?
bool step(Measured now, const TemporalOptions& options, float gate2, BlockMemory& m) {
  m.missed = 0;
  learn_scatter(now, m);
  const float d = now.rho - m.rho;
  const float moves = another_surface(std::max(now.rho, m.rho));
  const bool another =
      m.count == 0 || squared(d) > std::max(squared(moves), gate2 * (m.variance + now.variance));
  // Caps the scatter, so that the gate does not admit another surface.
  now.variance = believed(now.variance, std::min(m.scatter, squared(moves) / (2 * gate2)));
  now.slope_variance = believed(now.slope_variance, m.slope_scatter);
  if (another || m.state != now.state) {
    restart(now, m);
    m.moving = false;
  } else if (m.moving) {
    follow(now, gate2, m);
  } else if (agrees(now, m, gate2)) {
    return average(now, remembered(options, m), m);
  } else {
    m.moving = true;
    restart(now, m);
    m.calm_since = now.rho;
  }
  return false;
}

/// Nothing was measured. Is nothing remembered, either?
bool miss(int hold, BlockMemory& m) {
  if (m.count > 0 && m.missed < std::min(hold, 255)) {
    ++m.missed;
    m.moving = false;
    return false;
  }
  m = {};
  return true;
}

void write(const BlockMemory& m, std::size_t i, BlockFits& fits) {
  const float share = 1 / static_cast<float>(m.count);
  fits.states[i] = m.state;
  fits.rho[i] = m.rho;
  fits.variance[i] = m.variance * share + m.extra;
  fits.slope_x[i] = m.slope_x;
  fits.slope_y[i] = m.slope_y;
  fits.slope_variance[i] = m.slope_variance * share;
  fits.confidences[i] = m.confidence;
}

}  // namespace

TemporalOptions temporal_options(int memory, double correlation, double normal_error) {
  TemporalOptions options;
  options.normal_error = normal_error;
  options.memory = std::clamp(memory, 1, 255);
  options.gate = correlation > 4 ? 7 : 5;
  return options;
}

void TemporalFilter::reset() {
  std::fill(memory_.begin(), memory_.end(), BlockMemory{});
}

bool TemporalFilter::begin(const BlockGrid& grid, const Eigen::Isometry3d& T_world_sensor) {
  const bool same = grid == grid_ && T_world_sensor.matrix() == T_world_sensor_.matrix();
  if (grid != grid_) {
    grid_ = grid;
    memory_.assign(grid.size(), {});
    warp_.resize(grid.size());
  } else if (!same) {
    warp_.warp(grid, T_world_sensor.inverse() * T_world_sensor_, memory_);
  }
  T_world_sensor_ = T_world_sensor;
  return same;
}

void TemporalFilter::filter(const TemporalOptions& options, int row, int first, int count,
                            BlockFits& fits, std::uint8_t* settled) {
  const auto gate2 = static_cast<float>(options.gate * options.gate);
  const std::size_t begin = grid_.index(first, row);
  for (std::size_t i = begin; i < begin + static_cast<std::size_t>(count); ++i) {
    BlockMemory& m = memory_[i];
    if (fits.states[i] == FilteredDepth::State::empty) {
      *settled++ = miss(options.hold, m) ? 1 : 0;
      continue;
    }
    *settled++ = step(measured(fits, i), options, gate2, m) ? 1 : 0;
    write(m, i, fits);
  }
}

}  // namespace palpate::depth
