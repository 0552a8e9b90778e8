#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"

namespace palpate {

/// Reads bytes; numbers are metres, whatever the file states, unless `options` leave that open.
inline CloudFile read_text(std::string_view bytes, const std::string& name = "cloud",
                           const ReadOptions& options = {.scale = 1}) {
  return read_cloud_bytes(std::as_bytes(std::span(bytes)), name, options);
}

/// What the reader says to bytes that it refuses; "no error" if it takes them.
inline std::string refusal(std::string_view bytes, const std::string& name = "cloud",
                           const ReadOptions& options = {.scale = 1}) {
  try {
    (void)read_text(bytes, name, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// The first point; the origin of a cloud of one point is that point.
inline Eigen::Vector3f first_point(const CloudFile& file) {
  return file.cloud.point(0).cast<float>();
}

template <class T>
void append(std::string& out, T value, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

/// The number in the bytes from `offset` on, in the order of this machine.
template <class T>
T load(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Writes a number over the bytes from `offset` on.
template <class T>
void overwrite(std::string& out, std::size_t offset, T value) {
  std::string bytes;
  append(bytes, value);
  out.replace(offset, bytes.size(), bytes);
}

}  // namespace palpate
