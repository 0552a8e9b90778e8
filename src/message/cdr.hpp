#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "message/geometry_types.hpp"
#include "palpate/base/error.hpp"

/// CDR (OMG XTypes 1.3, 7.4.1: version 1, "plain"), as ROS 2 sends messages and rosbags hold them:
/// a head of four bytes, then values aligned to their size, counted from behind the head.
namespace palpate::message {

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>;
template <class T>
concept Message = requires {
  T::kName;
};

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they lie in memory");

constexpr std::size_t kHead = 4;  ///< bytes

/// Offset of a value of `size` bytes that follows byte `at`.
constexpr std::size_t aligned(std::size_t at, std::size_t size) {
  return kHead + (at - kHead + size - 1) / size * size;
}

/// From the other byte order.
template <class T>
void swap_bytes(T& value) {
  auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
  std::ranges::reverse(bytes);
  value = std::bit_cast<T>(bytes);
}

/// Appends values to bytes.
class CdrWriter {
 public:
  /// Begins with the head: little endian. What `out` held is gone, its memory is used again.
  explicit CdrWriter(std::vector<std::uint8_t>& out) : out_(out) { out_.assign({0, 1, 0, 0}); }

  template <Number T>
  void put(const T& value) {
    align(sizeof(T));
    append(&value, sizeof(T));
  }

  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(text.c_str(), text.size() + 1);
  }

  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    put_all(std::span<const T>(values));
  }

  template <class T, std::size_t N>
  void put(const std::array<T, N>& values) {
    put_all(std::span<const T>(values));
  }

  template <Message T>
  void put(const T& message) {
    T::each(message, [&](const char*, const auto& member) { put(member); });
  }

 private:
  template <class T>
  void put_all(std::span<const T> values) {
    if constexpr (Number<T>) {
      if (values.empty()) return;
      align(sizeof(T));
      append(values.data(), values.size_bytes());
    } else {
      for (const T& value : values) put(value);
    }
  }

  void align(std::size_t size) { out_.resize(aligned(out_.size(), size)); }

  void append(const void* from, std::size_t size) {
    const std::size_t end = out_.size();
    out_.resize(end + size);
    std::memcpy(out_.data() + end, from, size);
  }

  std::vector<std::uint8_t>& out_;
};

/// Takes values from bytes of anybody. Allocates no more than a small multiple of what the bytes
/// hold.
class CdrReader {
 public:
  /// @throws Error when the bytes are no plain CDR by their head.
  explicit CdrReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    if (bytes.size() < kHead || bytes[0] != 0 || bytes[1] > 1) {
      throw Error("the message is not encoded as plain CDR; its sender has to use XCDR version 1");
    }
    swap_ = bytes[1] == 0;
    at_ = kHead;
  }

  template <Number T>
  void get(T& value) {
    align(sizeof(T));
    take(&value, sizeof(T));
    if (swap_) swap_bytes(value);
  }

  void get(bool& value) {
    std::uint8_t byte = 0;
    get(byte);
    value = byte != 0;
  }

  void get(std::string& text) {
    const std::size_t size = get_size(1);
    text.assign(reinterpret_cast<const char*>(bytes_.data()) + at_, size);
    at_ += size;
    if (!text.empty() && text.back() == '\0') text.pop_back();
  }

  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (Number<T>) {
      const std::size_t size = get_size(sizeof(T));
      values.resize(size);
      get_all(std::span<T>(values));
    } else {
      const std::size_t size = get_size(1);
      values.clear();
      for (std::size_t i = 0; i < size; ++i) get(values.emplace_back());
    }
  }

  template <class T, std::size_t N>
  void get(std::array<T, N>& values) {
    get_all(std::span<T>(values));
  }

  template <Message T>
  void get(T& message) {
    T::each(message, [&](const char*, auto& member) { get(member); });
  }

 private:
  template <Number T>
  void get_all(std::span<T> values) {
    if (values.empty()) return;
    align(sizeof(T));
    take(values.data(), values.size_bytes());
    if (swap_) std::ranges::for_each(values, swap_bytes<T>);
  }

  // Reads the length of a sequence whose elements take `least` bytes or more each.
  std::size_t get_size(std::size_t least) {
    std::uint32_t size = 0;
    get(size);
    if (size > (bytes_.size() - at_) / least) {  // get() left at_ within the bytes
      throw Error(fmt::format("the message is damaged: {} elements are announced at byte {} of {}",
                              size, at_, bytes_.size()));
    }
    return size;
  }

  void align(std::size_t size) { at_ = aligned(at_, size); }

  void take(void* to, std::size_t size) {
    if (at_ > bytes_.size() || size > bytes_.size() - at_) {
      throw Error(fmt::format("the message is damaged: it ends at byte {} of a value at byte {}",
                              bytes_.size(), at_));
    }
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool swap_ = false;
};

/// The message as bytes, head included, in the memory of `out`.
template <Message T>
void encode(const T& message, std::vector<std::uint8_t>& out) {
  CdrWriter(out).put(message);
}

/// The message that `bytes` hold. Bytes behind it are ignored: senders pad.
/// @throws Error when they hold none; `message` is then in any state.
template <Message T>
void decode(std::span<const std::uint8_t> bytes, T& message) {
  CdrReader(bytes).get(message);
}

}  // namespace palpate::message
