// Learns how likely bits, symbols and numbers are, as the LAZ format prescribes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpate::io::laz {

/// Learns how likely a bit is 0 from those before it. The numbers are the format's.
class BitModel {
 public:
  /// Share of the bits that are 0, in steps of 2^-13.
  [[nodiscard]] std::uint32_t zero() const { return zero_; }

  void add(bool bit) {
    if (!bit) ++zeros_;
    if (--left_ == 0) update();
  }

 private:
  void update();

  std::uint32_t zero_ = 1U << 12U;
  std::uint32_t zeros_ = 1;
  std::uint32_t bits_ = 2;
  std::uint32_t cycle_ = 4;  // bits between two updates
  std::uint32_t left_ = 4;
};

/// Learns how likely each of n symbols is from those before. Takes memory when first used: most of
/// the many models of a chunk never are.
class SymbolModel {
 public:
  explicit SymbolModel(std::uint32_t symbols) : symbols_(symbols) {}

  /// Makes the model ready; call it before anything else below.
  void prepare() {
    if (counts_.empty()) start();
  }

  [[nodiscard]] std::uint32_t symbols() const { return symbols_; }

  /// Share of the symbols before `symbol`, in steps of 2^-15.
  [[nodiscard]] std::uint32_t before(std::uint32_t symbol) const { return before_[symbol]; }

  /// The symbol within whose share `value` lies, 0 - 2^15.
  [[nodiscard]] std::uint32_t at(std::uint32_t value) const {
    const std::uint32_t slot = std::min(value, kWhole - 1) >> slot_shift_;
    std::uint32_t symbol = slots_[slot];
    std::uint32_t end = slots_[slot + 1] + 1U;
    while (symbol + 1 < end) {
      const std::uint32_t middle = (symbol + end) / 2;
      (before_[middle] <= value ? symbol : end) = middle;
    }
    return symbol;
  }

  void add(std::uint32_t symbol) {
    ++counts_[symbol];
    if (--left_ == 0) update();
  }

 private:
  static constexpr std::uint32_t kWhole = 1U << 15U;

  void start();
  void update();

  std::uint32_t symbols_;
  std::uint32_t slot_shift_ = 0;
  std::uint32_t total_ = 0;
  std::uint32_t cycle_ = 0;  // symbols between two updates
  std::uint32_t left_ = 0;
  std::vector<std::uint16_t> counts_;
  std::vector<std::uint16_t> before_;
  std::vector<std::uint16_t> slots_;  // the symbol at the start of each slot, to find others from
};

/// Makes `count` models of one kind.
template <std::size_t count>
std::array<SymbolModel, count> symbol_models(std::uint32_t symbols) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<SymbolModel, count>{((void)i, SymbolModel(symbols))...};
  }
  (std::make_index_sequence<count>());
}

/// The median of about five numbers, which predicts the next one.
class RunningMedian {
 public:
  [[nodiscard]] std::int32_t value() const { return sorted_[2]; }

  /// Replaces the largest or the smallest one by a number; which of them changes when the
  /// number lies on that side.
  void add(std::int32_t number) {
    auto& v = sorted_;
    std::size_t k = 0;
    if (drops_largest_) {
      drops_largest_ = number < v[2];
      for (k = 4; k > 0 && number < v[k - 1]; --k) v[k] = v[k - 1];
    } else {
      drops_largest_ = number <= v[2];
      for (; k < 4 && v[k + 1] < number; ++k) v[k] = v[k + 1];
    }
    v[k] = number;
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool drops_largest_ = true;
};

}  // namespace palpate::io::laz
