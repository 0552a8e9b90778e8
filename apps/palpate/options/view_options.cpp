#include "apps/palpate/options/view_options.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/option_checks.hpp"

namespace palpate::app {

namespace {

constexpr const char* kGroup = "Page";

void check_address(const std::string& text) {
  in6_addr parsed;  // has room for either kind
  for (const int kind : {AF_INET, AF_INET6}) {
    if (inet_pton(kind, text.c_str(), &parsed) == 1) return;
  }
  throw UsageError(fmt::format(
      "'{}' is no address; give one like 127.0.0.1, ::1 or 0.0.0.0 (everywhere)", text));
}

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& o) {
  command
      .add_flag("--view", o.wanted,
                wrapped("shows the run on a page in a browser, where the tool can be taken with a "
                        "mouse; it then goes on in real time until --duration or Ctrl-C"))
      ->group(kGroup);
  command
      .add_flag("--no-view", o.refused,
                wrapped("no page; without this, runs of cameras and sequences in real time have "
                        "one where they are started at a terminal"))
      ->group(kGroup);
  add_page_options(command, o);
}

void add_page_options(CLI::App& command, ViewOptions& o) {
  command
      .add_option("--listen", o.listen,
                  wrapped("address that the page is served on (127.0.0.1: this machine alone); "
                          "whoever knows the page's address may move the hand"))
      ->check(parsed_by(check_address))
      ->type_name("ADDRESS")
      ->group(kGroup);
  command
      .add_option("--port", o.port,
                  wrapped("port of the page; 0: any (the first free one from 8420)"))
      ->check(whole_number(0, 65535))
      ->type_name("N")
      ->group(kGroup);
}

bool is_viewed(const ViewOptions& options) {
  const bool person = isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
  return options.wanted || (person && !options.refused);
}

}  // namespace palpate::app
