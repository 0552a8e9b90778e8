#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace palpate::app {

/// "12 345 678".
[[nodiscard]] std::string grouped(std::size_t number);

/// A length in metres with a fitting unit: "2.54 mm", "0.8 um", "1.42 km".
[[nodiscard]] std::string length(double metres);

/// An energy in joules likewise: "-12.3 mJ".
[[nodiscard]] std::string energy(double joules);

/// A time in seconds likewise: "0.35 s", "12 ms".
[[nodiscard]] std::string duration(double seconds);

/// Emphasis on a terminal, nothing elsewhere or where NO_COLOR is set.
class Style {
 public:
  explicit Style(std::FILE* stream);
  [[nodiscard]] std::string heading(const std::string& text) const { return paint("1;36", text); }
  [[nodiscard]] std::string warning(const std::string& text) const { return paint("33", text); }
  [[nodiscard]] std::string error(const std::string& text) const { return paint("1;31", text); }
  [[nodiscard]] bool colored() const { return colored_; }
  /// Colour `index` (0-255) of the terminal's palette behind `text`.
  [[nodiscard]] std::string behind(int index, const std::string& text) const;

 private:
  [[nodiscard]] std::string paint(const char* code, const std::string& text) const;
  bool colored_;
};

}  // namespace palpate::app
