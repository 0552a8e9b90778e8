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
  /// An eye by where it is (from the centre, m) or, of remembered points, by its direction.
  struct Eye {
    std::size_t source = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };
  static constexpr std::size_t kMost = kMostLayers;  // positions: one a layer (derived)
  /// Directions. A hemisphere of them, each 18 degrees from the others, has room; judgement.
  static constexpr std::size_t kMostDirections = 64;

  void add(const Eye& eye) noexcept;
  void add_direction(const Eye& eye) noexcept;
  [[nodiscard]] bool has_direction(const Eye& eye) const noexcept;
  void merge_directions() noexcept;

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  std::array<Eye, kMost> eyes_;
  std::size_t count_ = 0;
  std::array<Eye, kMostDirections> directions_;
  std::size_t direction_count_ = 0;
  double same_ = 1;           // cosine between directions that count as one
  std::uint32_t unseen_ = 0;  // bits of sources with points that hold from all sides
};

}  // namespace palpate
