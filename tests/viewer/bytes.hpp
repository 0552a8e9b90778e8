#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace palpate::test {

/// A little-endian number at an offset of a message, as docs/viewer_protocol.md lays it out.
template <class T>
T number_at(const std::string& bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little);
  if (offset + sizeof(T) > bytes.size()) throw std::out_of_range("a message too short");
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

inline float f32(const std::string& bytes, std::size_t offset) {
  return number_at<float>(bytes, offset);
}
inline std::uint16_t u16(const std::string& bytes, std::size_t offset) {
  return number_at<std::uint16_t>(bytes, offset);
}
inline std::int16_t i16(const std::string& bytes, std::size_t offset) {
  return number_at<std::int16_t>(bytes, offset);
}
inline std::uint32_t u32(const std::string& bytes, std::size_t offset) {
  return number_at<std::uint32_t>(bytes, offset);
}
inline std::uint8_t u8(const std::string& bytes, std::size_t offset) {
  return number_at<std::uint8_t>(bytes, offset);
}
inline std::int8_t i8(const std::string& bytes, std::size_t offset) {
  return number_at<std::int8_t>(bytes, offset);
}

}  // namespace palpate::test
