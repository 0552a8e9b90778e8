// Reads depth images (PGM, PNG) and turns them into points.
#include "io/depth_image.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "io/cloud_builder.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::size_t kFarBeyond = 10;  // times the median depth (judgement)

// 0 when no pixel is valid.
std::size_t median_depth(const DepthImage& image) {
  std::vector<std::uint16_t> valid;
  std::copy_if(image.samples.begin(), image.samples.end(), std::back_inserter(valid),
               [&](std::uint16_t s) { return is_depth(image, s); });
  if (valid.empty()) return 0;
  const auto middle = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() / 2);
  std::nth_element(valid.begin(), middle, valid.end());
  return *middle;
}

}  // namespace

Pinhole intrinsics_of(const Input& input, const DepthImage& image) {
  if (!input.options.intrinsics) {
    fail(input,
         fmt::format("a depth image of {} x {} pixels without camera intrinsics", image.width,
                     image.height),
         "Give them in pixels (--intrinsics fx,fy,cx,cy, or a sequence.json or camera file next to "
         "the image) and the metres per depth unit (--depth-unit)");
  }
  const Pinhole camera = *input.options.intrinsics;
  const bool sane = std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
                    std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx != 0 &&
                    camera.fy != 0;
  if (!sane) {
    fail(input,
         fmt::format("intrinsics {},{},{},{} are invalid", camera.fx, camera.fy, camera.cx,
                     camera.cy),
         "Give fx,fy,cx,cy in pixels, with nonzero fx and fy");
  }
  return camera;
}

double unit_of(const Input& input) {
  const double unit = input.options.depth_unit;
  if (std::isfinite(unit) && unit > 0) return unit;
  fail(input, fmt::format("invalid depth unit of {} metres", unit),
       "Give the metres per depth unit, e.g. 0.001 for millimetres");
}

bool is_depth(const DepthImage& image, std::uint16_t sample) {
  return sample != 0 && sample < image.largest && sample != 65535;
}

CloudFile cloud_of(const Input& input, const DepthImage& image) {
  const Pinhole camera = intrinsics_of(input, image);
  const double unit = unit_of(input);
  const std::size_t farthest = kFarBeyond * median_depth(image);
  CloudBuilder builder(input, {}, ColorScale::byte, image.samples.size());
  builder.organise(image.width, image.height);
  Progress progress(input.options, image.samples.size());
  Row row{};
  for (std::size_t i = 0; i < image.samples.size(); ++i) {
    progress.at(i);
    const std::uint16_t sample = image.samples[i];
    const bool kept = is_depth(image, sample) && sample <= farthest;
    const double z = kept ? unit * sample : std::nan("");
    row[0] = (static_cast<double>(i % image.width) - camera.cx) * z / camera.fx;
    row[1] = (static_cast<double>(i / image.width) - camera.cy) * z / camera.fy;
    row[2] = z;
    builder.add(row);
  }
  CloudFile file = builder.finish(image.format);
  file.cloud.viewpoint = Eigen::Vector3d::Zero();
  return file;
}

void check_image_size(const Input& input, std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t kLargestRatio = 1032;  // of deflate: 258 bytes from 2 bits (derived)
  constexpr std::uint64_t kWidest = 65536;       // pixels (judgement)
  const bool sane = width > 0 && height > 0 && width <= kWidest && height <= kWidest &&
                    2 * width * height / kLargestRatio <= input.bytes.size();
  if (sane) return;
  fail(input,
       fmt::format("{} x {} pixels declared, too many for {} bytes", width, height,
                   input.bytes.size()),
       "The file is truncated or damaged: download it again");
}

namespace {

constexpr std::size_t kEveryRow = 4;  // one row in four is enough (judgement)
// Swapped images of real sensors are 20 to 100 times rougher than right ones.
constexpr std::uint64_t kRougher = 4;  // times (judgement)
constexpr std::uint64_t kFewest = 32;  // steps to judge by (judgement)

std::uint16_t exchanged(std::uint16_t v) {
  return static_cast<std::uint16_t>((v >> 8U) | (v << 8U));
}

std::uint64_t step(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint64_t>(std::abs(static_cast<int>(a) - static_cast<int>(b)));
}

}  // namespace

bool looks_swapped(const DepthImage& image) {
  std::uint64_t steps = 0;
  std::uint64_t fine = 0;  // samples that are more than a count of 256
  std::uint64_t as_read = 0;
  std::uint64_t as_exchanged = 0;
  for (std::size_t row = 0; row < image.height; row += kEveryRow) {
    const std::uint16_t* samples = image.samples.data() + row * image.width;
    for (std::size_t i = 1; i < image.width; ++i) {
      const std::uint16_t a = samples[i - 1];
      const std::uint16_t b = samples[i];
      if (a == 0 || b == 0 || a == 65535 || b == 65535) continue;
      ++steps;
      fine += (b & 0xffU) != 0 ? 1 : 0;
      as_read += step(a, b);
      as_exchanged += step(exchanged(a), exchanged(b));
    }
  }
  // Whole counts of 256 are coarse, and look smooth in either byte order.
  return steps >= kFewest && 2 * fine > steps && as_read > kRougher * as_exchanged;
}

void swap_bytes(DepthImage& image) {
  for (std::uint16_t& sample : image.samples) sample = exchanged(sample);
}

namespace {

// The three numbers of the header are separated by white space and comments up to the line's end;
// exactly one white-space character follows the last.
class PgmHeaderParser {
 public:
  explicit PgmHeaderParser(const Input& input)
      : input_(input), offset_(std::min<std::size_t>(2, input.bytes.size())) {}

  std::size_t number(std::string_view what) {
    const std::string_view text = input_.text();
    while (offset_ < text.size() && (is_space(text[offset_]) || text[offset_] == '#')) {
      if (text[offset_] == '#') offset_ = std::min(text.find('\n', offset_), text.size() - 1);
      ++offset_;
    }
    const std::size_t begin = offset_;
    while (offset_ < text.size() && text[offset_] >= '0' && text[offset_] <= '9') ++offset_;
    const std::optional<std::size_t> value = parse_count(text.substr(begin, offset_ - begin));
    if (!value) {
      fail_at_byte(input_, begin, fmt::format("the PGM header lacks its {}", what),
                   "Download or export the image again");
    }
    return *value;
  }

  [[nodiscard]] std::size_t data_offset() const { return offset_ + 1; }

 private:
  const Input& input_;
  std::size_t offset_;  // at first behind "P5"
};

}  // namespace

DepthImage read_pgm(const Input& input) {
  PgmHeaderParser header(input);
  DepthImage image;
  image.width = header.number("width");
  image.height = header.number("height");
  const std::size_t largest = header.number("largest value");
  if (largest < 256 || largest > 65535) {
    fail(input, fmt::format("a PGM picture of values up to {}, not a 16-bit depth image", largest),
         "Give the depth image of the camera, or a point cloud");
  }
  check_image_size(input, image.width, image.height);
  image.largest = static_cast<std::uint16_t>(largest);
  image.format = fmt::format("depth PGM, {} x {}", image.width, image.height);
  const std::size_t begin = std::min(header.data_offset(), input.bytes.size());
  const std::size_t pixels = image.width * image.height;
  const std::size_t present = (input.bytes.size() - begin) / 2;
  if (present < pixels) {
    fail_at_byte(input, input.bytes.size(),
                 fmt::format("the file ends after {} of {} pixels", present, pixels),
                 "Download the image again");
  }
  image.samples.reserve(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    image.samples.push_back(
        load_as<std::uint16_t>(input.bytes.data() + begin + 2 * i, std::endian::big));
  }
  return image;
}

namespace {

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

// Bytes of text, profiles, ... (judgement)
constexpr std::size_t kLargestChunk = std::size_t{64} << 20U;

void check(const Input& input, int status) {
  if (status == SPNG_OK) return;
  fail(input, fmt::format("the PNG data is damaged or truncated ({})", spng_strerror(status)),
       "Download or export the image again");
}

}  // namespace

DepthImage read_png(const Input& input) {
  const std::unique_ptr<spng_ctx, FreeContext> context(spng_ctx_new(0));
  if (!context) fail(input, "libspng cannot start", "Free some memory");
  spng_set_chunk_limits(context.get(), kLargestChunk, kLargestChunk);
  check(input, spng_set_png_buffer(context.get(), input.bytes.data(), input.bytes.size()));
  spng_ihdr header{};
  check(input, spng_get_ihdr(context.get(), &header));
  if (header.color_type != SPNG_COLOR_TYPE_GRAYSCALE || header.bit_depth != 16) {
    fail(input,
         fmt::format("a picture (PNG, {} bits), not a 16-bit grey depth image", header.bit_depth),
         "Give the depth image of the camera, or a point cloud");
  }
  check_image_size(input, header.width, header.height);
  DepthImage image{.width = header.width,
                   .height = header.height,
                   .samples = {},
                   .format = fmt::format("depth PNG, {} x {}", header.width, header.height)};
  image.samples.resize(image.width * image.height);
  // SPNG_FMT_PNG gives 16-bit samples in the byte order of this machine; the file's is big endian.
  check(input, spng_decode_image(context.get(), image.samples.data(),
                                 image.samples.size() * sizeof(std::uint16_t), SPNG_FMT_PNG, 0));
  return image;
}

}  // namespace palpate::io
