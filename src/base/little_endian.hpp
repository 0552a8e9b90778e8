#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate {

/// Numbers one after the other, lowest byte first, whatever the processor's order. The bytes have
/// to suffice. Real-time.
class LittleEndianWriter {
 public:
  explicit LittleEndianWriter(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  void put(T value) noexcept {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_[at_++] = static_cast<std::byte>(value >> (8 * i) & 0xFF);
    }
  }
  void put(double value) noexcept { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const Eigen::Vector3d& value) noexcept {
    for (const double x : value) put(x);
  }

 private:
  std::span<std::byte> bytes_;
  std::size_t at_ = 0;
};

/// Takes them back.
class LittleEndianReader {
 public:
  explicit LittleEndianReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  T take() noexcept {
    T value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i) {
      value = static_cast<T>(value | static_cast<T>(static_cast<T>(bytes_[at_++]) << (8 * i)));
    }
    return value;
  }
  double take_double() noexcept { return std::bit_cast<double>(take<std::uint64_t>()); }
  Eigen::Vector3d take_vector() noexcept {
    Eigen::Vector3d value;
    for (double& x : value) x = take_double();
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace palpate
