// Parses depth frames that another program sends over a socket.
#include "sensor/remote_frame.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string_view>

#include "base/little_endian.hpp"
#include "palpate/base/error.hpp"
#include "sensor/pose_track.hpp"

namespace palpate::sensor {
namespace {

constexpr std::uint32_t kMagic = 0x44706C70;  // "plpD"

constexpr unsigned kHasPose = 1;
constexpr unsigned kHasStamp = 2;
constexpr unsigned kFloats = 4;

// Pixels: the filter needs 2 x 2 blocks and their neighbours, so three blocks (derived).
constexpr std::uint32_t kSmallestSide = 6;
constexpr std::uint32_t kLargestSide = 8192;  // pixels (judgement)
constexpr double kFarthestPixel = 1e6;        // pixels (judgement)
constexpr double kMostBent = 1000;            // largest coefficient of a lens (judgement)
constexpr double kLargestStamp = 1e10;        // s, either sign (judgement)

// A number from least to most; not for NaN.
double within(double value, double least, double most, std::string_view name,
              std::string_view wanted) {
  if (value >= least && value <= most) return value;
  throw Error(fmt::format("{} is {}; send {}", name, value, wanted));
}

unsigned read_flags(LittleEndianReader& reader) {
  if (const auto magic = reader.take<std::uint32_t>(); magic != kMagic) {
    throw Error(
        fmt::format("a header begins with {:#010x}, not with \"plpD\" ({:#010x}); send a header "
                    "of {} bytes, all its pixels, then the next header",
                    magic, kMagic, kFrameHeaderSize));
  }
  if (const auto version = reader.take<std::uint16_t>(); version != kRemoteFrameVersion) {
    throw Error(fmt::format("the version is {}; send version {}", version, kRemoteFrameVersion));
  }
  const unsigned flags = reader.take<std::uint16_t>();
  if ((flags & ~(kHasPose | kHasStamp | kFloats)) != 0) {
    throw Error(fmt::format("the flags are {:#x}; send 1, 2 and 4 alone", flags));
  }
  return flags;
}

void read_size(LittleEndianReader& reader, CameraModel& camera) {
  const auto width = reader.take<std::uint32_t>();
  const auto height = reader.take<std::uint32_t>();
  const auto possible = [](std::uint32_t side) {
    return side >= kSmallestSide && side <= kLargestSide;
  };
  if (!possible(width) || !possible(height) || width * height > kMostFramePixels) {
    throw Error(fmt::format("the size is {} x {} pixels; send {} to {} each way, {} in all at most",
                            width, height, kSmallestSide, kLargestSide, kMostFramePixels));
  }
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
}

void read_lens(LittleEndianReader& reader, CameraModel& camera) {
  const auto take = [&](double least, double most, std::string_view name, std::string_view wanted) {
    return within(reader.take_double(), least, most, name, wanted);
  };
  constexpr std::string_view kFocal = "the focal length in pixels";
  constexpr std::string_view kCentre = "the principal point in pixels";
  constexpr std::string_view kBrown = "a coefficient of Brown and Conrady's, or 0";
  Pinhole& p = camera.pinhole;
  p.fx = take(1e-3, kFarthestPixel, "fx", kFocal);
  p.fy = take(1e-3, kFarthestPixel, "fy", kFocal);
  p.cx = take(-kFarthestPixel, kFarthestPixel, "cx", kCentre);
  p.cy = take(-kFarthestPixel, kFarthestPixel, "cy", kCentre);
  CameraModel::Distortion& d = camera.distortion;
  d.k1 = take(-kMostBent, kMostBent, "k1", kBrown);
  d.k2 = take(-kMostBent, kMostBent, "k2", kBrown);
  d.p1 = take(-kMostBent, kMostBent, "p1", kBrown);
  d.p2 = take(-kMostBent, kMostBent, "p2", kBrown);
  d.k3 = take(-kMostBent, kMostBent, "k3", kBrown);
}

Eigen::Isometry3d read_pose(LittleEndianReader& reader) {
  const Eigen::Vector3d p = reader.take_vector();
  const Eigen::Vector3d q = reader.take_vector();
  const double w = reader.take_double();
  const auto pose = rigid(p, Eigen::Quaterniond(w, q.x(), q.y(), q.z()));
  if (pose) return *pose;
  throw Error(
      fmt::format("the pose is {}, {}, {} and {}, {}, {}, {}; send metres within 1e6, then a "
                  "quaternion x, y, z, w of length 1, or no flag 1",
                  p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), w));
}

}  // namespace

FrameHeader parse_frame_header(std::span<const std::byte> bytes) {
  LittleEndianReader reader(bytes);
  const unsigned flags = read_flags(reader);
  FrameHeader header;
  header.floats = (flags & kFloats) != 0;
  read_size(reader, header.camera);
  header.unit = within(reader.take_double(), 1e-9, 1, "the unit", "the metres a step, 1e-9 to 1");
  read_lens(reader, header.camera);
  const double stamp = reader.take_double();
  if ((flags & kHasStamp) != 0) {
    header.stamp = within(stamp, -kLargestStamp, kLargestStamp, "the stamp",
                          "seconds on a clock that grows, or no flag 2");
  }
  if ((flags & kHasPose) != 0) header.T_world_sensor = read_pose(reader);
  return header;
}

bool FrameAssembler::add(std::size_t count) {
  used_ += count;
  if (used_ < bytes_.size()) return false;
  if (used_ > kFrameHeaderSize) return true;
  header_ = parse_frame_header(bytes_);
  bytes_.resize(kFrameHeaderSize + header_.pixel_bytes());
  return false;
}

void FrameAssembler::take(DepthFrame& frame) {
  frame.camera = header_.camera;
  frame.T_world_sensor = header_.T_world_sensor;
  frame.colors.clear();
  frame.cloud.reset();
  frame.depth.resize(header_.pixel_bytes() / (header_.floats ? 4 : 2));
  take_depths(std::span<const std::byte>(bytes_).subspan(kFrameHeaderSize), frame.depth);
  bytes_.resize(kFrameHeaderSize);
  used_ = 0;
}

void FrameAssembler::take_depths(std::span<const std::byte> pixels, std::span<float> depth) {
  LittleEndianReader reader(pixels);
  if (!header_.floats) {
    samples_.resize(depth.size());
    for (std::uint16_t& sample : samples_) sample = reader.take<std::uint16_t>();
    return to_metres(samples_, header_.unit, depth);
  }
  for (float& z : depth) {
    const double value = static_cast<double>(std::bit_cast<float>(reader.take<std::uint32_t>()));
    const auto metres = static_cast<float>(value * header_.unit);
    z = std::isfinite(metres) && metres > 0 ? metres : 0.0F;
  }
}

}  // namespace palpate::sensor
