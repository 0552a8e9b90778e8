#pragma once

#include <string>

namespace palpate::app {

/// Prints on standard error where a page is, and where other machines find it: on each network
/// interface that is up, if it is served on all (`listened`). On a terminal the first of these is
/// a QR code, too, for a phone's camera.
void announce_page(const std::string& url, const std::string& listened);

/// The token in a page's address: what stands behind `#`.
[[nodiscard]] inline std::string token_of(const std::string& url) {
  return url.substr(url.find('#') + 1);
}

/// The QR code of `text` in lines of half blocks, dark on light by the terminal's own colours of
/// these names; empty: this build makes none, or the text is too long.
[[nodiscard]] std::string qr_code(const std::string& text);

}  // namespace palpate::app
