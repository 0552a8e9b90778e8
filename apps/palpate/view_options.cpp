#include "apps/palpate/view_options.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "apps/palpate/option_checks.hpp"

namespace palpate::app {

namespace {

constexpr const char* kGroup = "Page";

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& o) {
  command
      .add_flag("--view,!--no-view", o.wanted,
                wrapped("shows the run on a page in a browser, where the tool can be taken with a "
                        "mouse; it then goes on in real time until --duration or Ctrl-C. Live "
                        "runs at a terminal have a page unless --no-view"))
      ->group(kGroup)
      ->each([&o](const std::string& value) { o.refused = value == "false"; });
  add_page_options(command, o);
}

void add_page_options(CLI::App& command, ViewOptions& o) {
  command
      .add_option("--listen", o.listen,
                  wrapped("address that the page is served on (127.0.0.1: this machine alone); "
                          "who is told the page's address may move the hand"))
      ->type_name("ADDRESS")
      ->group(kGroup);
  command
      .add_option("--port", o.port, wrapped("of the page; 0: any (the first free one from 8420)"))
      ->check(whole_number(0, 65535))
      ->type_name("N")
      ->group(kGroup);
}

bool is_viewed(const ViewOptions& options) {
  const bool person = isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
  return options.wanted || (person && !options.refused);
}

}  // namespace palpate::app
