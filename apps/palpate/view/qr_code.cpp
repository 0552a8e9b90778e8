// Draws QR codes with libqrencode.
#include <qrencode.h>

#include <memory>

#include "apps/palpate/view/address.hpp"

namespace palpate::app {

std::string qr_code(const std::string& text) {
  constexpr int kQuiet = 4;  // modules of light around it (ISO/IEC 18004)
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), &QRcode_free);
  if (!code) return {};
  const int width = code->width;
  const auto dark = [&](int row, int column) {
    const bool inside = row >= 0 && row < width && column >= 0 && column < width;
    return inside && (code->data[row * width + column] & 1) != 0;
  };
  std::string lines;
  for (int row = -kQuiet; row < width + kQuiet; row += 2) {
    lines += "\033[30;107m";
    for (int column = -kQuiet; column < width + kQuiet; ++column) {
      const bool upper = dark(row, column);
      const bool lower = dark(row + 1, column);
      lines += upper ? (lower ? "█" : "▀") : (lower ? "▄" : " ");
    }
    lines += "\033[0m\n";
  }
  return lines;
}

}  // namespace palpate::app
