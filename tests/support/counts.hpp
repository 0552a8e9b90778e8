#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace palpate::test {

/// The largest count of this machine, as text.
inline const std::string kLargestCount = std::to_string(std::numeric_limits<std::size_t>::max());

/// Two to the power of `bits` less than a count has, as text.
inline std::string count_short_of_bits(int bits) {
  return std::to_string(std::size_t{1} << (std::numeric_limits<std::size_t>::digits - bits));
}

/// The square of it is no count of this machine any more, as text.
inline const std::string kCountOfHalfTheBits =
    count_short_of_bits(std::numeric_limits<std::size_t>::digits / 2);

}  // namespace palpate::test
