#pragma once

#include <array>
#include <cstring>
#include <string>

namespace palpate::test {

/// Appends a number as little endian bytes.
template <class T>
void put(std::string& out, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  out.append(bytes.data(), bytes.size());
}

}  // namespace palpate::test
