#pragma once

#include <algorithm>
#include <cstddef>

#include "palpate/io/read_cloud.hpp"

namespace palpate::io {

/// Tells the caller's callback how far a read has come, about a hundred times in all, so that it
/// costs a comparison a point.
class Progress {
 public:
  /// `total`: whatever is counted (bytes, points). `options` must outlive this.
  Progress(const ReadOptions& options, std::size_t total)
      : options_(options),
        total_(std::max<std::size_t>(total, 1)),
        stride_(total_ / kReports + 1),
        next_(stride_) {}

  void at(std::size_t done) {
    if (done >= next_) report(done);
  }

 private:
  static constexpr std::size_t kReports = 100;

  void report(std::size_t done) {
    next_ = done + stride_;
    if (options_.progress) {
      options_.progress(std::min(1.0, static_cast<double>(done) / static_cast<double>(total_)));
    }
  }

  const ReadOptions& options_;
  std::size_t total_;
  std::size_t stride_;
  std::size_t next_;
};

}  // namespace palpate::io
