#include "apps/palpate/cli/words.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <span>

namespace palpate::app {

namespace {

struct Unit {
  double size;
  const char* name;
};

// With three digits, in the largest unit that the value reaches.
std::string with_unit(double value, std::span<const Unit> units) {
  if (value == 0) return fmt::format("0 {}", units.front().name);
  const Unit* chosen = &units.back();
  for (const Unit& unit : units) {
    if (std::abs(value) < 0.9995 * unit.size) continue;
    chosen = &unit;
    break;
  }
  const double scaled = value / chosen->size;
  const int decimals = std::abs(scaled) >= 99.95 ? 0 : std::abs(scaled) >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}", scaled, decimals, chosen->name);
}

}  // namespace

std::string grouped(std::size_t number) {
  if (number < 1000) return fmt::format("{}", number);
  return fmt::format("{} {:03}", grouped(number / 1000), number % 1000);
}

std::string length(double metres) {
  static constexpr std::array<Unit, 3> kUnits = {{{1, "m"}, {1e-3, "mm"}, {1e-6, "um"}}};
  // Kilometres only where metres have five digits.
  if (std::abs(metres) >= 1e4) return fmt::format("{:.1f} km", metres / 1000);
  return with_unit(metres, kUnits);
}

std::string energy(double joules) {
  static constexpr std::array<Unit, 3> kUnits = {{{1, "J"}, {1e-3, "mJ"}, {1e-6, "uJ"}}};
  return with_unit(joules, kUnits);
}

std::string duration(double seconds) {
  static constexpr std::array<Unit, 3> kUnits = {{{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}}};
  return with_unit(seconds, kUnits);
}

Style::Style(std::FILE* stream)
    : colored_(isatty(fileno(stream)) != 0 && std::getenv("NO_COLOR") == nullptr) {}

std::string Style::behind(int index, const std::string& text) const {
  return paint(fmt::format("48;5;{}", index).c_str(), text);
}

std::string Style::paint(const char* code, const std::string& text) const {
  return colored_ ? fmt::format("\033[{}m{}\033[0m", code, text) : text;
}

}  // namespace palpate::app
