#include "io/png.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <memory>

namespace palpate::io {
namespace {

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

constexpr std::size_t kLargestChunk = std::size_t{64} << 20U;  // bytes of text, profiles, ...

void check(const Input& input, int status) {
  if (status == SPNG_OK) return;
  fail(input, fmt::format("the PNG data is damaged or cut ({})", spng_strerror(status)),
       "Fetch or export the image again");
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
