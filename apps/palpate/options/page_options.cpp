// Options of the page on which a run is seen.
#include "apps/palpate/options/page_options.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"

namespace palpate::app {

namespace {

constexpr Scope kPage{&RunFacts::page, "applies only to the page; add --view"};

void check_address(const std::string& text) {
  in6_addr parsed;  // has room for either kind
  for (const int kind : {AF_INET, AF_INET6}) {
    if (inet_pton(kind, text.c_str(), &parsed) == 1) return;
  }
  throw UsageError(fmt::format(
      "'{}' is not an IP address; give one like 127.0.0.1, ::1 or 0.0.0.0 (all interfaces)", text));
}

Eigen::Vector3d parse_up(const std::string& text) {
  const bool down = text.starts_with('-') && text.size() == 2;
  const std::size_t axis = std::string_view("xyz").find(text.substr(down ? 1 : 0));
  if (axis < 3 && text.size() == (down ? 2U : 1U)) {
    return (down ? -1 : 1) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
  }
  const bool three = text.find(',') != std::string::npos;
  const Eigen::Vector3d up = three ? parse_point(text, "--up") : Eigen::Vector3d::Zero();
  if (up.isZero(0)) {
    throw UsageError(fmt::format(
        "--up: '{}' is no direction; give x, y, z, -x, -y, -z or three numbers X,Y,Z", text));
  }
  return up.stableNormalized();
}

}  // namespace

void add_page_options(OptionTable& table, PagePlan& page) {
  table.under("Page");
  table.add_flag("--headless", page.headless, "do not open a browser").only_for(kPage);
  table
      .add("--listen", page.address, "ADDRESS", parsed_by(check_address),
           "address to serve the page on (127.0.0.1: this machine only); anyone who knows the "
           "page's URL can move the hand")
      .only_for(kPage);
  table
      .add("--port", page.port, "N", whole_number(0, 65535),
           "port of the page; 0: any free port (default: the first free one from 8420)")
      .only_for(kPage);
  table
      .add_text(
          "--up", KeyKind::numbers_or_text, "AXIS",
          [&page](const std::string& text) { page.up = parse_up(text); },
          "what the page shows as up: x, y, z, -x, -y, -z or a direction X,Y,Z (default: z; y or "
          "-y where the cloud stands on a flat base along it; -y where all is in one camera's own "
          "axes, which have y down)")
      .only_for(kPage);
}

}  // namespace palpate::app
