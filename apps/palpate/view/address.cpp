// Prints where the page is, with a QR code.
#include "apps/palpate/view/address.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <unistd.h>

#include <array>
#include <memory>

namespace palpate::app {
namespace {

// The interface's address as text; empty if others cannot reach it.
std::string address_of(const ifaddrs& interface) {
  const bool up = (interface.ifa_flags & IFF_UP) != 0 && (interface.ifa_flags & IFF_LOOPBACK) == 0;
  if (!up || interface.ifa_addr == nullptr || interface.ifa_addr->sa_family != AF_INET) return {};
  std::array<char, NI_MAXHOST> text{};
  const bool found = getnameinfo(interface.ifa_addr, sizeof(sockaddr_in), text.data(), text.size(),
                                 nullptr, 0, NI_NUMERICHOST) == 0;
  return found ? text.data() : std::string();
}

void announce_others(const std::string& url) {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> freed(all, &freeifaddrs);
  const std::size_t port = url.rfind(':', url.find('#'));
  bool shown = isatty(STDERR_FILENO) == 0;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const std::string address = address_of(*each);
    if (address.empty()) continue;
    const std::string its = "http://" + address + url.substr(port);
    fmt::print(stderr, "from other machines: {} ({})\n", its, each->ifa_name);
    if (!shown) fmt::print(stderr, "{}", qr_code(its));
    shown = true;
  }
}

}  // namespace

void announce_page(const std::string& url, const std::string& listened) {
  fmt::print(stderr, "page: {}\n", url);
  if (listened == "0.0.0.0" || listened == "::") announce_others(url);
}

}  // namespace palpate::app
