#pragma once

#include <string>

namespace palpate::app {

/// Opens `url` in the person's browser; nothing happens where there is none, or no desktop.
void open_in_browser(const std::string& url);

}  // namespace palpate::app
