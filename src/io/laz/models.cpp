// Brings the models of LAZ up to date.
#include "io/laz/models.hpp"

namespace palpate::io::laz {

void BitModel::update() {
  constexpr std::uint32_t kMost = 1U << 13U;  // bits that are remembered (format)
  constexpr std::uint32_t kLongestCycle = 64;
  bits_ += cycle_;
  if (bits_ > kMost) {
    bits_ = (bits_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == bits_) ++bits_;
  }
  zero_ = (zeros_ * ((1U << 31U) / bits_)) >> 18U;
  cycle_ = std::min(5 * cycle_ / 4, kLongestCycle);
  left_ = cycle_;
}

void SymbolModel::start() {
  constexpr std::uint32_t kSymbolsASlot = 4;  // measured: finer ones cost more in update()
  std::uint32_t slot_bits = 1;
  while ((kSymbolsASlot << slot_bits) < symbols_) ++slot_bits;
  slot_shift_ = 15 - slot_bits;
  slots_.resize((std::size_t{1} << slot_bits) + 1);
  counts_.assign(symbols_, 1);
  before_.resize(symbols_);
  cycle_ = symbols_;
  update();
  cycle_ = (symbols_ + 6) / 2;
  left_ = cycle_;
}

void SymbolModel::update() {
  total_ += cycle_;
  if (total_ > kWhole) {
    total_ = 0;
    for (std::uint16_t& count : counts_) {
      count = static_cast<std::uint16_t>((count + 1) / 2);
      total_ += count;
    }
  }
  const std::uint32_t scale = (1U << 31U) / total_;
  std::uint32_t sum = 0;
  std::size_t slot = 0;
  for (std::uint32_t k = 0; k < symbols_; ++k) {
    const std::uint32_t before = (scale * sum) >> 16U;
    before_[k] = static_cast<std::uint16_t>(before);
    sum += counts_[k];
    for (; slot << slot_shift_ < before; ++slot) {
      slots_[slot] = static_cast<std::uint16_t>(k - 1);
    }
  }
  std::fill(slots_.begin() + static_cast<std::ptrdiff_t>(slot), slots_.end(),
            static_cast<std::uint16_t>(symbols_ - 1));
  cycle_ = std::min(5 * cycle_ / 4, 8 * (symbols_ + 6));
  left_ = cycle_;
}

}  // namespace palpate::io::laz
