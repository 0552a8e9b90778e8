#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {

/// The protocol by which any program is a camera (docs/remote_camera.md): a stream of frames, each
/// a header of fixed size and its pixels, little-endian, version 1. No socket and no clock here.
inline constexpr std::uint16_t kRemoteFrameVersion = 1;
inline constexpr std::size_t kFrameHeaderSize = 160;                        ///< bytes
inline constexpr std::uint32_t kMostFramePixels = std::uint32_t{1} << 24U;  ///< of a frame

/// Header of a frame, sent before its pixels. All numbers are in range.
struct FrameHeader {
  CameraModel camera;
  double unit = 0;              ///< m a step of the pixels' values
  bool floats = false;          ///< pixels are f32; otherwise u16
  std::optional<double> stamp;  ///< s, on a clock of the client's; unset: it sends none
  std::optional<Eigen::Isometry3d> T_world_sensor;  ///< unset: where the source stands

  /// Size of all pixels, bytes.
  [[nodiscard]] std::size_t pixel_bytes() const {
    return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height) *
           (floats ? 4 : 2);
  }
};

/// Reads kFrameHeaderSize bytes.
/// @throws Error that names the first value that cannot be used, and what was wanted.
[[nodiscard]] FrameHeader parse_frame_header(std::span<const std::byte> bytes);

/// Puts the frames of a stream of bytes together, however it is cut. Takes memory for what a header
/// that was checked announces, and keeps it for the frames that follow. One thread.
class FrameAssembler {
 public:
  /// Buffer for the next bytes; never empty.
  [[nodiscard]] std::span<std::byte> room() { return std::span(bytes_).subspan(used_); }

  /// The first `count` bytes of room() were put there. True: a frame is whole.
  /// @throws Error as parse_frame_header() does; then no byte that follows means anything.
  [[nodiscard]] bool add(std::size_t count);

  /// The header of the frame that is whole; otherwise of an earlier one, or none.
  [[nodiscard]] const FrameHeader& header() const { return header_; }

  /// Fills camera, pose and depths of `frame` from the frame that is whole, and begins the next.
  void take(DepthFrame& frame);

  /// Bytes of the frame that is not whole yet.
  [[nodiscard]] std::size_t used() const { return used_; }

 private:
  void take_depths(std::span<const std::byte> pixels, std::span<float> depth);

  std::vector<std::byte> bytes_ = std::vector<std::byte>(kFrameHeaderSize);
  std::size_t used_ = 0;
  FrameHeader header_;
  std::vector<std::uint16_t> samples_;  // of one frame
};

}  // namespace palpate::sensor
