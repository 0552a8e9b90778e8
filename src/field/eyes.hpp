#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "field/selection.hpp"
#include "field/simd/sums.hpp"

namespace palpate {

/// The eyes that saw a patch's points. A surface holds towards its eye alone: where the gradient of
/// the field faces no eye, nothing is solid (docs/method.md 2.11). Real-time.
class Eyes {
 public:
  /// Forgets all eyes; positions are relative to `center` from now on (m, world).
  void begin(const Eigen::Vector3d& center) noexcept;

  /// Adds those of the chosen points of a layer, rising indices into it.
  void add(const ActiveLayer& layer, std::span<const std::uint32_t> indices) noexcept;

  /// Does a surface with this gradient at x (from the centre, m) hold? `weights`: of each source
  /// there. Sources whose points nobody saw hold from all sides.
  [[nodiscard]] bool hold(const Eigen::Vector3d& x, const Eigen::Vector3d& gradient,
                          std::span<const double> weights) const noexcept;

 private:
  struct Eye {
    std::size_t source = 0;
    bool remembered = false;
    Eigen::Vector3d position =
        Eigen::Vector3d::Zero();  // from the centre, m; remembered: direction
  };
  static constexpr std::size_t kMost = 2 * simd::kMaxSources;  // one a source and as many others

  void add(const Eye& eye) noexcept;

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  std::array<Eye, kMost> eyes_;
  std::size_t count_ = 0;
  std::uint32_t unseen_ = 0;  // bits of sources with points that hold from all sides
};

}  // namespace palpate
