// Encodes what io/laz/range_decoder.hpp decodes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/laz/models.hpp"

namespace palpate {

class RangeEncoder {
 public:
  void bit(io::laz::BitModel& model, bool one) {
    const std::uint32_t zero = model.zero() * (length_ >> 13U);
    narrow(one ? zero : 0, one ? length_ - zero : zero);
    model.add(one);
  }

  void symbol(io::laz::SymbolModel& model, std::uint32_t symbol) {
    model.prepare();
    const std::uint32_t step = length_ >> 15U;
    const std::uint32_t begin = model.before(symbol) * step;
    const bool last = symbol + 1 == model.symbols();
    narrow(begin, (last ? length_ : model.before(symbol + 1) * step) - begin);
    model.add(symbol);
  }

  void raw(unsigned bits, std::uint32_t number) {
    if (bits > 19) {
      raw(16, number & 0xFFFFU);
      raw(bits - 16, number >> 16U);
      return;
    }
    const std::uint32_t step = length_ >> bits;
    narrow(number * step, step);
  }

  // All bytes; nothing can be encoded after that.
  std::string finish() {
    for (int i = 0; i < 4; ++i, base_ <<= 8U) bytes_ += static_cast<char>(base_ >> 24U);
    return std::move(bytes_);
  }

 private:
  void narrow(std::uint32_t begin, std::uint32_t length) {
    base_ += begin;
    if (base_ < begin) {  // carry
      for (std::size_t i = bytes_.size(); i-- > 0 && ++bytes_[i] == 0;) continue;
    }
    for (length_ = length; length_ < 1U << 24U; length_ <<= 8U, base_ <<= 8U) {
      bytes_ += static_cast<char>(base_ >> 24U);
    }
  }

  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  std::string bytes_;
};

// Mirror image of io::laz::NumberModel.
class NumberEncoder {
 public:
  NumberEncoder(unsigned bits, std::size_t contexts)
      : bits_(bits), sizes_(contexts, io::laz::SymbolModel(bits + 1)) {
    for (unsigned k = 1; k <= std::min(bits, 31U); ++k) errors_.emplace_back(1U << std::min(k, 8U));
  }

  [[nodiscard]] std::uint32_t size() const { return size_; }

  void encode(RangeEncoder& out, std::uint32_t prediction, std::uint32_t number,
              std::size_t context = 0) {
    const unsigned unused = 32 - bits_;
    const auto error = static_cast<std::int32_t>((number - prediction) << unused) >> unused;
    size_ = size_of(error);
    out.symbol(sizes_[context], size_);
    if (size_ == 0) {
      out.bit(zero_or_one_, error == 1);
    } else if (size_ < 32) {
      const std::int64_t shifted = error > 0 ? error - 1 : error + (std::int64_t{1} << size_) - 1;
      const auto code = static_cast<std::uint32_t>(shifted);
      const unsigned low = size_ > 8 ? size_ - 8 : 0;
      out.symbol(errors_[size_ - 1], code >> low);
      if (low > 0) out.raw(low, code & ((1U << low) - 1));
    }
  }

 private:
  static std::uint32_t size_of(std::int64_t error) {
    std::uint32_t size = 0;
    while (error > std::int64_t{1} << size || error < 1 - (std::int64_t{1} << size)) ++size;
    return size;
  }

  unsigned bits_;
  std::uint32_t size_ = 0;
  std::vector<io::laz::SymbolModel> sizes_;
  io::laz::BitModel zero_or_one_;
  std::vector<io::laz::SymbolModel> errors_;
};

}  // namespace palpate
