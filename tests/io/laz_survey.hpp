// Makes LAS files whose points use all that LAZ has models for.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "io/las_bytes.hpp"

namespace palpate {

struct Survey {
  int format = 0;
  std::size_t points = 3000;
  std::size_t extra = 0;  ///< bytes of each record
  int channels = 4;       ///< scanner channels, of formats 6 - 8
  unsigned seed = 1;
};

/// Walks along lines; now and then a value jumps.
class SurveyWriter {
 public:
  explicit SurveyWriter(const Survey& survey) : survey_(survey), random_(survey.seed) {}

  std::string run() {
    const bool extended = survey_.format >= 6;
    std::string bytes = las_bytes(extended ? 4 : 2, survey_.format, {}, survey_.extra);
    overwrite(bytes, 107, static_cast<std::uint32_t>(extended ? 0 : survey_.points));
    if (extended) overwrite<std::uint64_t>(bytes, 247, survey_.points);
    record_ = std::string(kLasRecordSizes[survey_.format] + survey_.extra, '\0');
    for (std::size_t i = 0; i < survey_.points; ++i) {
      walk();
      extended ? head_14() : head_10();
      tail();
      bytes += record_;
    }
    return bytes;
  }

 private:
  // Below `end`; no distribution of the library's, as those differ.
  std::uint32_t any(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  bool rarely(std::uint32_t times) { return any(times) == 0; }

  void walk() {
    for (std::size_t k = 0; k < 3; ++k) {
      number_[k] += k == 0 ? 40 + any(20) : any(9) - 4;
      if (rarely(500)) number_[k] = static_cast<std::uint32_t>(random_());  // any size of step
      if (rarely(200)) number_[k] += any(1U << any(31));
      overwrite(record_, 4 * k, number_[k]);
    }
    if (!rarely(3))
      intensity_ = static_cast<std::uint16_t>(rarely(50) ? any(65536) : 200 + any(30));
    overwrite(record_, 12, intensity_);
  }

  void head_10() {
    const std::uint32_t n = rarely(30) ? any(8) : 1 + any(3);
    const std::uint32_t r = rarely(30) ? any(8) : 1 + any(n + 1);
    if (rarely(2)) returns_ = n << 3U | (r & 7U);
    if (rarely(40)) direction_ ^= 64U;
    put(14, returns_ | direction_ | (rarely(100) ? 128U : 0U));
    if (rarely(20)) put(15, any(6) | (rarely(9) ? 128U : 0U));
    if (rarely(4)) put(16, any(5) - 2);
    if (rarely(15)) put(17, any(256));
    if (rarely(100)) overwrite(record_, 18, static_cast<std::uint16_t>(any(65536)));
    time(20);
  }

  void head_14() {
    if (rarely(9)) channel_ = any(static_cast<std::uint32_t>(survey_.channels));
    if (rarely(3)) {
      const std::uint32_t n = rarely(20) ? any(16) : 1 + any(15);
      put(14, n << 4U | (rarely(20) ? any(16) : (1 + any(n + 1)) & 15U));
    }
    if (rarely(30)) flags_ = any(16) | any(4) << 6U;
    put(15, flags_ | channel_ << 4U);
    if (rarely(20)) put(16, any(40));
    if (rarely(15)) put(17, any(256));
    if (rarely(4)) overwrite(record_, 18, static_cast<std::int16_t>(any(3000) - 1500));
    if (rarely(100)) overwrite(record_, 20, static_cast<std::uint16_t>(any(65536)));
    time(22);
  }

  // Four devices whose times are in no relation; steps of all factors.
  void time(std::size_t at) {
    if (survey_.format == 0 || survey_.format == 2) return;
    if (rarely(60)) device_ = any(6);
    if (rarely(3)) times_[device_] += rarely(9) ? any(1U << any(30)) : 1000 * any(12);
    if (rarely(50)) times_[device_] -= any(30000);
    overwrite(record_, at, (std::uint64_t{0x4100} + device_) << 48U | times_[device_]);
  }

  void tail() {
    const std::array<std::size_t, 9> color_at{0, 0, 20, 28, 0, 0, 0, 30, 30};
    if (const std::size_t at = color_at[survey_.format]; at > 0) color(at);
    for (std::size_t k = 0; k < survey_.extra; ++k) {
      if (rarely(1 + static_cast<std::uint32_t>(k))) put(record_.size() - 1 - k, any(7 + k));
    }
  }

  void color(std::size_t at) {
    const bool grey = rarely(3);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!rarely(2)) color_[k] = static_cast<std::uint16_t>(color_[k] + any(700) - 350);
      overwrite(record_, at + 2 * k, color_[grey ? 0 : k]);
    }
    if (survey_.format == 8 && rarely(3)) {
      overwrite(record_, at + 6, static_cast<std::uint16_t>(rarely(2) ? any(256) : any(65536)));
    }
  }

  void put(std::size_t at, std::uint32_t byte) { record_[at] = static_cast<char>(byte); }

  Survey survey_;
  std::mt19937 random_;
  std::string record_;
  std::array<std::uint32_t, 3> number_{100000, 200000, 3000};
  std::uint16_t intensity_ = 0;
  std::uint32_t returns_ = 9;
  std::uint32_t direction_ = 0;
  std::uint32_t channel_ = 0;
  std::uint32_t flags_ = 0;
  std::uint32_t device_ = 0;
  std::array<std::uint64_t, 6> times_{};
  std::array<std::uint16_t, 3> color_{};
};

inline std::string survey_of(const Survey& survey) {
  return SurveyWriter(survey).run();
}

}  // namespace palpate
