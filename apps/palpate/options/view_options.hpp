#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The page on which a run is seen, touched and set.
struct ViewOptions {
  bool wanted = false;                ///< the run goes on in real time until it is ended
  bool refused = false;               ///< not even where a person is at the terminal
  std::string listen;                 ///< address; empty: this machine alone
  std::optional<std::uint16_t> port;  ///< unset: the first free one from 8420 on
  bool open_browser = false;
};

void add_view_options(CLI::App& command, ViewOptions& options);

/// Those that say where the page is.
void add_page_options(CLI::App& command, ViewOptions& options);

/// Is a page served for a run in real time? One that was not asked for is where a person is at the
/// terminal.
[[nodiscard]] bool is_viewed(const ViewOptions& options);

}  // namespace palpate::app
