#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpate::viewer {

/// Values at the corners of kCells^3 cubic cells around a centre; those that nobody put are not
/// known.
class Lattice {
 public:
  static constexpr int kCells = 32;
  static constexpr int kCorners = kCells + 1;

  /// `half`: half of the cube's edge, m.
  explicit Lattice(double half)
      : half_(half), cell_(2 * half / kCells), values_(kCount, kUnknown), supports_(kCount, 0) {}

  [[nodiscard]] double cell() const { return cell_; }
  /// Of a corner, m, relative to the centre.
  [[nodiscard]] Eigen::Vector3d place(const Eigen::Vector3i& corner) const {
    return cell_ * corner.cast<double>() - Eigen::Vector3d::Constant(half_);
  }
  [[nodiscard]] bool known(const Eigen::Vector3i& corner) const {
    return !std::isnan(value(corner));
  }
  [[nodiscard]] float value(const Eigen::Vector3i& corner) const { return values_[index(corner)]; }
  [[nodiscard]] float support(const Eigen::Vector3i& corner) const {
    return supports_[index(corner)];
  }
  void put(const Eigen::Vector3i& corner, double value, double support) {
    values_[index(corner)] = static_cast<float>(value);
    supports_[index(corner)] = static_cast<float>(support);
  }

 private:
  static constexpr std::size_t kCount = static_cast<std::size_t>(kCorners) * kCorners * kCorners;
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  [[nodiscard]] static std::size_t index(const Eigen::Vector3i& corner) {
    return static_cast<std::size_t>((corner.z() * kCorners + corner.y()) * kCorners + corner.x());
  }

  double half_;
  double cell_;
  std::vector<float> values_;
  std::vector<float> supports_;
};

}  // namespace palpate::viewer
