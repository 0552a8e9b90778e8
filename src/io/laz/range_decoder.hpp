// Decodes the adaptive range coder of LAZ files (A. Said, "Introduction to Arithmetic Coding",
// 2004).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/laz/models.hpp"

namespace palpate::io::laz {

/// Bytes to bits, symbols and raw numbers. Bytes that are damaged give wrong numbers, but none out
/// of range; behind the last byte it reads zeros.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::byte> bytes)
      : next_(bytes.data()), end_(bytes.data() + bytes.size()) {
    for (int i = 0; i < 4; ++i) value_ = value_ << 8U | next_byte();
  }

  /// True when the bytes ended before what was read.
  [[nodiscard]] bool overran() const { return missing_ > kLongestTail; }

  bool bit(BitModel& model) {
    const std::uint32_t zero = model.zero() * (length_ >> 13U);
    const bool one = value_ >= zero;
    if (one) {
      value_ -= zero;
      length_ -= zero;
    } else {
      length_ = zero;
    }
    model.add(one);
    renormalise();
    return one;
  }

  std::uint32_t symbol(SymbolModel& model) {
    model.prepare();
    const std::uint32_t step = length_ >> 15U;
    const std::uint32_t symbol = model.at(value_ / step);
    const std::uint32_t begin = model.before(symbol) * step;
    const bool last = symbol + 1 == model.symbols();
    length_ = (last ? length_ : model.before(symbol + 1) * step) - begin;
    value_ -= begin;
    model.add(symbol);
    renormalise();
    return symbol;
  }

  /// A number of that many bits, 0 - 32, all values alike.
  std::uint32_t raw(unsigned bits) {
    if (bits > kMostRawBits) {
      const std::uint32_t low = raw(16);
      return raw(bits - 16) << 16U | low;
    }
    length_ >>= bits;
    const std::uint32_t number = std::min(value_ / length_, (1U << bits) - 1);
    value_ -= number * length_;
    renormalise();
    return number;
  }

 private:
  static constexpr std::uint32_t kShortest = 1U << 24U;  // interval (format)
  static constexpr unsigned kMostRawBits = 19;           // at once (format)
  static constexpr std::size_t kLongestTail = 4;         // zeros that an encoder may leave out

  void renormalise() {
    while (length_ < kShortest) {
      value_ = value_ << 8U | next_byte();
      length_ <<= 8U;
    }
  }

  std::uint32_t next_byte() {
    if (next_ != end_) return std::to_integer<std::uint32_t>(*next_++);
    ++missing_;
    return 0;
  }

  const std::byte* next_ = nullptr;
  const std::byte* end_ = nullptr;
  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  std::size_t missing_ = 0;  // bytes read behind the end
};

/// Numbers of so many bits, each near a prediction. Contexts model how far off it is likely to be.
class NumberModel {
 public:
  NumberModel(unsigned bits, std::size_t contexts)
      : mask_(bits < 32 ? (1U << bits) - 1 : 0xFFFFFFFFU), sizes_(contexts, SymbolModel(bits + 1)) {
    for (unsigned size = 1; size <= std::min(bits, 31U); ++size) {
      errors_.emplace_back(1U << std::min(size, kModelledBits));
    }
  }

  /// Bits of the last number's error: a hint of how large the next error is.
  [[nodiscard]] std::uint32_t size() const { return size_; }

  std::uint32_t decode(RangeDecoder& in, std::uint32_t prediction, std::size_t context = 0) {
    size_ = in.symbol(sizes_[context]);
    return (prediction + error(in)) & mask_;
  }

 private:
  static constexpr unsigned kModelledBits = 8;  // bits below them are raw (format)

  // Errors of `size_` bits are -(2^size - 1) ... -2^(size - 1) and 2^(size - 1) + 1 ... 2^size.
  std::uint32_t error(RangeDecoder& in) {
    if (size_ == 0) return in.bit(zero_or_one_) ? 1 : 0;
    if (size_ == 32) return 1U << 31U;
    std::uint32_t number = in.symbol(errors_[size_ - 1]);
    if (size_ > kModelledBits) {
      const unsigned raw = size_ - kModelledBits;
      number = number << raw | in.raw(raw);
    }
    const std::uint32_t half = 1U << (size_ - 1);
    return number >= half ? number + 1 : number - (2 * half - 1);
  }

  std::uint32_t mask_;
  std::uint32_t size_ = 0;
  std::vector<SymbolModel> sizes_;
  BitModel zero_or_one_;
  std::vector<SymbolModel> errors_;
};

}  // namespace palpate::io::laz
