#include "io/gzip.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

namespace palpate::io {
namespace {

constexpr std::size_t kAlwaysAllowed = std::size_t{64} << 20U;
constexpr std::size_t kLargestRatio = 250;
constexpr int kGzipWindow = 15 + 16;  // zlib's way of saying "gzip header, largest window"

// zlib's state, released whatever happens. A gzip member ends; the next one needs a reset.
class Inflater {
 public:
  explicit Inflater(const Input& input) {
    if (inflateInit2(&stream_, kGzipWindow) != Z_OK) {
      fail(input, "zlib cannot start", "Free some memory");
    }
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }
  z_stream& operator*() { return stream_; }

 private:
  z_stream stream_{};
};

uInt chunk(std::size_t size) {
  return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max() / 2));
}

std::size_t first_guess(std::size_t packed) {
  return std::clamp<std::size_t>(packed * 4, std::size_t{1} << 12U, std::size_t{1} << 30U);
}

class Gunzip {
 public:
  explicit Gunzip(const Input& input)
      : input_(input), inflater_(input), out_(first_guess(input.bytes.size())) {}

  Bytes run() {
    while (true) {
      const int status = step();
      if (status == Z_STREAM_END) {
        if (!next_member()) break;
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        fail_at_byte(input_, in_, "the gzip data is damaged",
                     "Fetch the file again; \"gzip -t\" tests it");
      } else if (in_ == input_.bytes.size() && done_ < out_.size()) {
        fail(input_, "the gzip data ends early: the file is cut", "Fetch it again");
      }
      if (done_ == out_.size()) grow();
    }
    out_.resize(done_);
    return std::move(out_);
  }

 private:
  int step() {
    z_stream& z = *inflater_;
    const uInt given_in = chunk(input_.bytes.size() - in_);
    const uInt given_out = chunk(out_.size() - done_);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(input_.bytes.data() + in_));
    z.avail_in = given_in;
    z.next_out = reinterpret_cast<Bytef*>(out_.span().data() + done_);
    z.avail_out = given_out;
    const int status = inflate(&z, Z_NO_FLUSH);
    in_ += given_in - z.avail_in;
    done_ += given_out - z.avail_out;
    return status;
  }

  // Some programs pad with zeros behind the last member: that is an end too.
  bool next_member() {
    const auto rest = input_.bytes.subspan(in_);
    if (rest.size() < 2 || rest[0] != std::byte{0x1f} || rest[1] != std::byte{0x8b}) return false;
    return inflateReset(&*inflater_) == Z_OK;
  }

  void grow() {
    const std::size_t allowed = std::max(kAlwaysAllowed, kLargestRatio * input_.bytes.size());
    if (out_.size() >= allowed) {
      fail(input_,
           fmt::format("unpacks to more than {} MiB, over {} times its size", allowed >> 20U,
                       kLargestRatio),
           "If it is to be trusted, unpack it with gunzip and read the result");
    }
    out_.resize(std::min(2 * out_.size(), allowed));
  }

  const Input& input_;
  Inflater inflater_;
  Bytes out_;
  std::size_t in_ = 0;
  std::size_t done_ = 0;
};

}  // namespace

Bytes gunzip(const Input& input) {
  return Gunzip(input).run();
}

}  // namespace palpate::io
