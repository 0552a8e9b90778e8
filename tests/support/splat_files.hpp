// Writes splats in each of the formats that are read, after their descriptions.
#pragma once

#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "extras/splats/splat_shell.hpp"
#include "support/put.hpp"

namespace palpate::test {

inline void put_byte(std::string& out, double value) {
  put(out, static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))));
}

/// The coefficient that gives a colour of 0 to 255.
inline double harmonic_of(std::uint8_t color) {
  return (color / 255.0 - 0.5) / 0.28209479177387814;
}

inline constexpr int kHarmonics = 9;  ///< coefficients of degree 1

inline std::string splat_ply(std::span<const Splat> splats) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(splats.size()) + "\n";
  const auto add = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) out += std::string("property float ") + name + "\n";
  };
  add({"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"});
  for (int k = 0; k < kHarmonics; ++k) add({("f_rest_" + std::to_string(k)).c_str()});
  add({"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"});
  out += "end_header\n";
  for (const Splat& s : splats) {
    for (const float x : s.position) put(out, x);
    for (int k = 0; k < 3; ++k) put(out, 0.F);  // normals that are none
    for (const std::uint8_t c : s.color) put(out, static_cast<float>(harmonic_of(c)));
    for (int k = 0; k < kHarmonics; ++k) put(out, 0.F);
    put(out, std::log(s.opacity / (1 - s.opacity)));
    for (const float x : s.sigma) put(out, std::log(x));
    const Eigen::Quaternionf& q = s.rotation;
    for (const float x : {2 * q.w(), 2 * q.x(), 2 * q.y(), 2 * q.z()}) put(out, x);
  }
  return out;
}

/// The index of the component of `turn` with the largest size.
inline int largest_of(const Eigen::Vector4f& turn) {
  Eigen::Index largest = 0;
  turn.cwiseAbs().maxCoeff(&largest);
  return static_cast<int>(largest);
}

/// Bounds of a chunk of 256 splats.
struct SplatBounds {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e30F);
  Eigen::Vector3f high = Eigen::Vector3f::Constant(-1e30F);

  void extend(const Eigen::Vector3f& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  [[nodiscard]] std::uint32_t pack(const Eigen::Vector3f& p) const {
    const auto number = [&](int k, double most) {
      const double range = std::max(high[k] - low[k], 1e-20F);
      return static_cast<std::uint32_t>(std::lround((p[k] - low[k]) / range * most));
    };
    return number(0, 2047) << 21 | number(1, 1023) << 11 | number(2, 2047);
  }
};

inline std::uint32_t packed_turn(const Eigen::Quaternionf& q) {
  Eigen::Vector4f turn(q.w(), q.x(), q.y(), q.z());
  const int largest = largest_of(turn);
  if (turn[largest] < 0) turn *= -1;
  auto word = static_cast<std::uint32_t>(largest);
  for (int k = 0; k < 4; ++k) {
    if (k == largest) continue;
    word = word << 10 |
           static_cast<std::uint32_t>(std::lround((turn[k] / std::numbers::sqrt2 + 0.5) * 1023));
  }
  return word;
}

inline std::string compressed_splat_ply(std::span<const Splat> splats) {
  const std::size_t chunks = (splats.size() + 255) / 256;
  std::string out =
      "ply\nformat binary_little_endian 1.0\nelement chunk " + std::to_string(chunks) + "\n";
  for (const char* name : {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x",
                           "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y",
                           "max_scale_z", "min_r", "min_g", "min_b", "max_r", "max_g", "max_b"}) {
    out += std::string("property float ") + name + "\n";
  }
  out += "element vertex " + std::to_string(splats.size()) + "\n";
  for (const char* name : {"position", "rotation", "scale", "color"}) {
    out += std::string("property uint packed_") + name + "\n";
  }
  out += "element sh 1\nproperty uchar f_rest_0\nend_header\n";
  std::string rows;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const auto own =
        splats.subspan(256 * chunk, std::min<std::size_t>(256, splats.size() - 256 * chunk));
    SplatBounds places, scales;
    for (const Splat& s : own) {
      places.extend(s.position);
      scales.extend(s.sigma.array().log().matrix());
    }
    for (const auto& v : {places.low, places.high, scales.low, scales.high}) {
      for (const float x : v) put(out, x);
    }
    for (const float x : {0.F, 0.F, 0.F, 1.F, 1.F, 1.F}) put(out, x);
    for (const Splat& s : own) {
      put(rows, places.pack(s.position));
      put(rows, packed_turn(s.rotation));
      put(rows, scales.pack(s.sigma.array().log().matrix()));
      const auto alpha = static_cast<std::uint32_t>(std::lround(255 * s.opacity));
      put(rows, std::uint32_t{s.color[0]} << 24 | std::uint32_t{s.color[1]} << 16 |
                    std::uint32_t{s.color[2]} << 8 | alpha);
    }
  }
  return out + rows + '\x7f';
}

inline std::string dot_splat(std::span<const Splat> splats) {
  std::string out;
  for (const Splat& s : splats) {
    for (const float x : s.position) put(out, x);
    for (const float x : s.sigma) put(out, x);
    for (const std::uint8_t c : s.color) put(out, c);
    put_byte(out, 255 * s.opacity);
    const Eigen::Quaternionf& q = s.rotation;
    for (const float x : {q.w(), q.x(), q.y(), q.z()}) put_byte(out, std::floor(128 + 128 * x));
  }
  return out;
}

/// Which .spz. Version 1 has 16-bit floats, 1 and 2 rotations of three bytes.
struct SpzColumns {
  std::string positions, alphas, colors, scales, turns;
};

inline constexpr int kSpzFraction = 12;  ///< bits: positions to 0.24 mm

inline std::uint32_t spz_turn(const Eigen::Vector4f& turn) {  // x y z w
  const int largest = largest_of(turn);
  auto word = static_cast<std::uint32_t>(largest);
  for (int k = 0; k < 4; ++k) {
    if (k == largest) continue;
    const bool negative = (turn[k] < 0) != (turn[largest] < 0);
    const auto size = std::lround(511 * std::abs(turn[k]) * std::numbers::sqrt2);
    word = word << 10 | (negative ? 512U : 0U) | static_cast<std::uint32_t>(size);
  }
  return word;
}

inline void put_spz_position(std::string& out, const Eigen::Vector3f& p, int version) {
  for (const float x : {p.x(), -p.y(), -p.z()}) {
    if (version == 1) {
      put(out, std::bit_cast<std::uint16_t>(Eigen::half(x)));
      continue;
    }
    const auto number = static_cast<std::uint32_t>(std::lround(std::ldexp(x, kSpzFraction)));
    for (int b = 0; b < 3; ++b) put(out, static_cast<std::uint8_t>(number >> (8 * b)));
  }
}

inline SpzColumns spz_columns(std::span<const Splat> splats, int version) {
  SpzColumns c;
  for (const Splat& s : splats) {
    put_spz_position(c.positions, s.position, version);
    put_byte(c.alphas, 255 * s.opacity);
    for (const std::uint8_t color : s.color) {
      put_byte(c.colors, 255 * (0.15 * harmonic_of(color) + 0.5));
    }
    for (const float x : s.sigma) put_byte(c.scales, 16 * (std::log(x) + 10));
    Eigen::Vector4f turn(s.rotation.x(), -s.rotation.y(), -s.rotation.z(), s.rotation.w());
    if (version >= 3) {
      put(c.turns, spz_turn(turn));
      continue;
    }
    if (turn[3] < 0) turn *= -1;
    for (int k = 0; k < 3; ++k) put_byte(c.turns, 127.5 * (turn[k] + 1));
  }
  return c;
}

/// The inside of a .spz of version 1 to 3, which is packed with gzip, or a whole one of version 4.
inline std::string spz(std::span<const Splat> splats, int version) {
  const SpzColumns c = spz_columns(splats, version);
  std::string out = "NGSP";
  put(out, static_cast<std::uint32_t>(version));
  put(out, static_cast<std::uint32_t>(splats.size()));
  out += {'\0', static_cast<char>(kSpzFraction), '\0', version == 4 ? '\5' : '\0'};
  if (version < 4) return out + c.positions + c.alphas + c.colors + c.scales + c.turns;
  constexpr std::uint32_t kExtension = 8;  // bytes of a record that nobody knows
  put(out, 32 + kExtension);
  out.append(12 + kExtension, '\0');
  std::string streams;
  for (const std::string& column : {c.positions, c.alphas, c.colors, c.scales, c.turns}) {
    std::string packed(ZSTD_compressBound(column.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), column.data(), column.size(), 3));
    put(out, std::uint64_t{packed.size()});
    put(out, std::uint64_t{column.size()});
    streams += packed;
  }
  return out + streams;
}

}  // namespace palpate::test
