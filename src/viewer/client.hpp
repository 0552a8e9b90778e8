#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "palpate/viewer/viewer_options.hpp"
#include "viewer/outbox.hpp"
#include "viewer/rate_window.hpp"

namespace palpate::viewer {

/// Why a socket is to be closed: a code of RFC 6455 and words.
struct Closing {
  std::uint16_t code = 0;
  std::string reason;
};

namespace close_code {
constexpr std::uint16_t kGoingAway = 1001;
constexpr std::uint16_t kPolicy = 1008;
constexpr std::uint16_t kTryAgainLater = 1013;
}  // namespace close_code

/// One socket, as those who know nothing of sockets see it.
struct Client {
  Client(const ViewerLimits& limits, double time)
      : opened(time),
        messages(limits.messages, 1),
        refusals(limits.refusals - 1, limits.refusal_time) {}

  double opened;         ///< s
  bool greeted = false;  ///< said hello with the token
  std::size_t points = 0;
  double heard = 0;            ///< when it said something last, s
  std::set<std::size_t> lost;  ///< tools that it does not know yet to be lost
  Outbox outbox;
  RateWindow messages;
  RateWindow refusals;
  std::optional<Closing> closing;      ///< once what is in the outbox is sent
  std::map<Topic, SharedBytes> shown;  ///< clouds and surfaces that were put into the outbox last
  std::function<void()> wake = {};     ///< there is something in the outbox, or `closing` is set
};

}  // namespace palpate::viewer
