#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::sensor {

/// An .oni recording of depth images of which frame k (from 1) is k mm farther than 1 m everywhere
/// but at its first pixel (0.5 m), at 30 Hz, uncompressed, with a field of view of 1.0 x 0.8 rad.
class OniFile {
 public:
  struct Kind {
    bool mirrored = false;
    bool whole = true;  ///< false: without the properties that OpenNI2's player asks for
    int cut = 0;        ///< the frame of this number lacks half of its depths; 0: none
  };

  OniFile(int width, int height, int frames) : OniFile(width, height, frames, Kind{}) {}
  OniFile(int width, int height, int frames, const Kind& kind) {
    const auto count = static_cast<std::uint32_t>(frames);
    const auto w = static_cast<std::uint32_t>(width);
    const auto h = static_cast<std::uint32_t>(height);
    head(count);
    node(count);
    number("oniRequiredFrameSize", width * height * 2);
    number("xnMirror", kind.mirrored ? 1 : 0);
    if (kind.whole) number("xnBytesPerPixel", 2);
    general("xnMapOutputMode", numbers<std::uint32_t>({w, h, 30}));
    number("xnPixelFormat", 4);
    number("oniPixelFormat", 100);
    if (kind.whole) general("xnCropping", std::string(12, '\0'));
    general("xnFOV", numbers<double>({1.0, 0.8}));
    record(kNodeReady, "");
    record(kDataBegin, numbers<std::uint32_t>({count}) + numbers<std::uint64_t>({kStep * count}));
    for (std::uint32_t k = 1; k <= count; ++k) {
      frame(k, k == static_cast<std::uint32_t>(kind.cut) ? w * h / 2 : w * h);
    }
    record(kNodeRemoved, "");
    record(kEnd, "");
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::uint64_t kStep = 33'333;  // us

  enum Record : std::uint32_t {
    kIntProperty = 3,
    kGeneralProperty = 6,
    kNodeRemoved = 7,
    kDataBegin = 8,
    kNodeReady = 9,
    kNewData = 10,
    kEnd = 11,
    kNodeAdded = 13,
  };

  template <class T>
  static std::string numbers(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }

  static std::string name(std::string_view text) {
    return numbers<std::uint32_t>({static_cast<std::uint32_t>(text.size() + 1)}) +
           std::string(text) + '\0';
  }

  void head(std::uint32_t frames) {
    bytes_ = std::string("NI10\x01\x00\x01\x00\x00\x00\x00\x00", 12);  // version 1.0.1
    bytes_ += numbers<std::uint64_t>({kStep * frames});
    bytes_ += numbers<std::uint32_t>({1});  // nodes
  }

  void record(Record kind, const std::string& fields, const std::string& payload = "") {
    constexpr std::uint32_t kHead = 28;
    bytes_ += std::string("NIR\0", 4);
    bytes_ += numbers<std::uint32_t>({kind, 1, kHead + static_cast<std::uint32_t>(fields.size()),
                                      static_cast<std::uint32_t>(payload.size())});
    bytes_ += numbers<std::uint64_t>({0});
    bytes_ += fields + payload;
  }

  void node(std::uint32_t frames) {
    record(kNodeAdded, name("Depth") + numbers<std::uint32_t>({2}) + "NONE" +
                           numbers<std::uint32_t>({frames}) +
                           numbers<std::uint64_t>({0, kStep * frames, 0}));
  }

  void number(std::string_view property, std::int64_t value) {
    record(kIntProperty,
           name(property) + numbers<std::uint32_t>({8}) + numbers<std::int64_t>({value}));
  }

  void general(std::string_view property, const std::string& value) {
    record(kGeneralProperty,
           name(property) + numbers<std::uint32_t>({static_cast<std::uint32_t>(value.size())}) +
               value);
  }

  void frame(std::uint32_t k, std::uint32_t pixels) {
    std::vector<std::uint16_t> depth(pixels, static_cast<std::uint16_t>(1000 + k));
    depth.front() = 500;
    record(kNewData, numbers<std::uint64_t>({kStep * k}) + numbers<std::uint32_t>({k}),
           numbers<std::uint16_t>(depth));
  }

  std::string bytes_;
};

}  // namespace palpate::sensor
