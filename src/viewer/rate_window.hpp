#pragma once

namespace palpate::viewer {

/// Are there more than `most` events in a stretch of time? Stretches follow one another, so twice
/// as many may fall into one that lies across two.
class RateWindow {
 public:
  RateWindow(int most, double length) noexcept : most_(most), length_(length) {}

  /// An event at `now` (s). True: it is one too many.
  bool exceeded(double now) noexcept {
    if (!(now - begin_ < length_)) {
      begin_ = now;
      count_ = 0;
    }
    if (count_ > most_) return true;
    return ++count_ > most_;
  }

 private:
  int most_;
  double length_;
  double begin_ = -1e300;
  int count_ = 0;
};

}  // namespace palpate::viewer
