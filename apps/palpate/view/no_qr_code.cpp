// Replaces qr_code.cpp where libqrencode is absent.
#include "apps/palpate/view/address.hpp"

namespace palpate::app {

std::string qr_code(const std::string& /*text*/) {
  return {};
}

}  // namespace palpate::app
