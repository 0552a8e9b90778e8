// Encodes the parts that LAZ points of all formats have: coordinates, times, colours.
#pragma once

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string_view>

#include "io/range_encoder.hpp"
#include "io/reading.hpp"

namespace palpate {

using io::laz::RunningMedian;
using io::laz::symbol_models;
using io::laz::SymbolModel;

class XyzEncoder {
 public:
  void encode_xy(RangeEncoder& out, bool single, RunningMedian& step_x, RunningMedian& step_y,
                 std::string_view last, std::string_view record) {
    move(x_, out, single ? 1 : 0, step_x, load<int>(last, 0), load<int>(record, 0));
    move(y_, out, context(x_.size(), 20, single), step_y, load<int>(last, 4), load<int>(record, 4));
  }

  void encode_z(RangeEncoder& out, bool single, std::int32_t& height, std::int32_t z) {
    z_.encode(out, static_cast<std::uint32_t>(height), static_cast<std::uint32_t>(z),
              context((x_.size() + y_.size()) / 2, 18, single));
    height = z;
  }

 private:
  static std::size_t context(std::uint32_t size, std::uint32_t most, bool single) {
    return (std::min(size, most) & ~1U) + (single ? 1U : 0U);
  }

  static void move(NumberEncoder& model, RangeEncoder& out, std::size_t context,
                   RunningMedian& median, std::int32_t last, std::int32_t now) {
    const std::uint32_t step = static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(last);
    model.encode(out, static_cast<std::uint32_t>(median.value()), step, context);
    median.add(static_cast<std::int32_t>(step));
  }

  NumberEncoder x_{32, 2};
  NumberEncoder y_{32, 22};
  NumberEncoder z_{32, 20};
};

// GPS times. Layered chunks have no symbol for "the same time again".
class TimeEncoder {
 public:
  TimeEncoder(bool layered, std::int64_t first)
      : skip_(layered ? 1 : 0),
        first_(layered ? 5 : 6),
        factor_(layered ? 515 : 516),
        times_{first} {}

  void encode(RangeEncoder& out, std::int64_t time) {
    const std::int64_t step = time - times_[now_];
    if (step == 0 && skip_ == 0) {
      out.symbol(steps_[now_] == 0 ? first_ : factor_, steps_[now_] == 0 ? 0 : 511);
    } else if (!fits(step)) {
      change_sequence(out, time);
    } else if (steps_[now_] == 0) {
      out.symbol(first_, 1 - skip_);
      set_step(out, 0, static_cast<int>(step), 0, true);
    } else {
      encode_multiple(out, static_cast<int>(step));
    }
    times_[now_] = time;
  }

 private:
  static bool fits(std::int64_t step) { return step == static_cast<std::int32_t>(step); }

  void encode_multiple(RangeEncoder& out, int step) {
    const double ratio = static_cast<double>(step) / steps_[now_];
    const int factor = static_cast<int>(std::lround(std::clamp(ratio, -10.0, 500.0)));
    out.symbol(factor_, static_cast<std::uint32_t>(factor >= 0 ? factor : 500 - factor));
    if (factor == 1) extremes_[now_] = 0;
    const std::size_t context = factor == 0     ? 7
                                : factor == 1   ? 1
                                : factor == 500 ? 4
                                : factor > 0    ? (factor < 10 ? 2 : 3)
                                : factor > -10  ? 5
                                                : 6;
    const bool extreme = factor == 0 || factor == 500 || factor == -10;
    set_step(out, static_cast<std::uint32_t>(factor) * static_cast<std::uint32_t>(steps_[now_]),
             step, context, extreme && ++extremes_[now_] > 3);
  }

  void set_step(RangeEncoder& out, std::uint32_t prediction, int step, std::size_t context,
                bool keep) {
    number_.encode(out, prediction, static_cast<std::uint32_t>(step), context);
    if (!keep) return;
    steps_[now_] = step;
    extremes_[now_] = 0;
  }

  void change_sequence(RangeEncoder& out, std::int64_t time) {
    const bool none = steps_[now_] == 0;
    for (std::uint32_t i = 1; i < 4; ++i) {
      if (!fits(time - times_[(now_ + i) % 4])) continue;
      out.symbol(none ? first_ : factor_, (none ? 2 : 512) - skip_ + i);
      now_ = (now_ + i) % 4;
      encode(out, time);
      return;
    }
    out.symbol(none ? first_ : factor_, (none ? 2 : 512) - skip_);
    number_.encode(out, static_cast<std::uint32_t>(times_[now_] >> 32),
                   static_cast<std::uint32_t>(time >> 32), 8);
    out.raw(32, static_cast<std::uint32_t>(time));
    now_ = begun_ = (begun_ + 1) % 4;
    steps_[now_] = 0;
    extremes_[now_] = 0;
  }

  std::uint32_t skip_;
  SymbolModel first_;
  SymbolModel factor_;
  NumberEncoder number_{32, 9};
  std::array<std::int64_t, 4> times_;
  std::array<int, 4> steps_{};
  std::array<int, 4> extremes_{};
  std::size_t now_ = 0;
  std::size_t begun_ = 0;
};

// Six bytes: red, green and blue, the low byte first.
class ColorEncoder {
 public:
  void encode(RangeEncoder& out, std::string_view last, std::string_view now) {
    std::uint32_t changed =
        now.substr(0, 2) == now.substr(2, 2) && now.substr(0, 2) == now.substr(4, 2) ? 0 : 64;
    for (std::size_t k = 0; k < 6; ++k) changed |= (last[k] != now[k] ? 1U : 0U) << k;
    out.symbol(changed_, changed);
    const auto byte = [](std::string_view color, std::size_t k) {
      return load<std::uint8_t>(color, k);
    };
    const auto put = [&](std::size_t k, int expected) {
      if ((changed >> k & 1U) == 0) return;
      out.symbol(differences_[k], static_cast<std::uint8_t>(byte(now, k) - expected));
    };
    for (std::size_t k = 0; k < 2; ++k) put(k, byte(last, k));
    if (changed < 64) return;
    for (std::size_t k = 0; k < 2; ++k) {
      int step = byte(now, k) - byte(last, k);
      put(k + 2, std::clamp(byte(last, k + 2) + step, 0, 255));
      step = (step + byte(now, k + 2) - byte(last, k + 2)) / 2;
      put(k + 4, std::clamp(byte(last, k + 4) + step, 0, 255));
    }
  }

 private:
  SymbolModel changed_{128};
  std::array<SymbolModel, 6> differences_ = symbol_models<6>(256);
};

}  // namespace palpate
