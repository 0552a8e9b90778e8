#include "apps/palpate/touch/live_run.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <thread>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/options/touch_usage.hpp"
#include "apps/palpate/run/live_feed.hpp"
#include "apps/palpate/touch/live_hand.hpp"
#include "apps/palpate/touch/live_status.hpp"
#include "apps/palpate/view/view.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kLook{20};

using LiveHands = std::deque<LiveHand>;

// Returns the time at which all of them were there.
double start_hands(Run& run, WaitingClock& clock, LiveHands& hands) {
  for (std::size_t i = 0; i < run.hands.size(); ++i) hands.emplace_back(run, i, clock);
  const double start = clock.now();
  for (LiveHand& hand : hands) hand.begin(start);
  return start;
}

std::vector<Servo*> servos_of(LiveHands& hands) {
  std::vector<Servo*> servos;
  for (LiveHand& hand : hands) servos.push_back(&hand.servo());
  return servos;
}

bool any_goes_on(const LiveHands& hands, double now) {
  return std::ranges::any_of(hands, [now](const LiveHand& hand) { return !hand.over(now); });
}

LiveMoment moment_of(LiveHands& hands, const LiveFeed& feed, double now, double start) {
  LiveMoment moment;
  moment.time = now - start;
  for (LiveHand& hand : hands) moment.hands.push_back(hand.moment(now));
  moment.streams = feed.states();
  return moment;
}

// Says once of each hand that its device failed, where others go on.
class FailureWatch {
 public:
  void look(const LiveHands& hands, double now, LiveStatus& status) {
    told_.resize(hands.size());
    if (!any_goes_on(hands, now)) return;
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const std::string failure = told_[i] ? "" : hands[i].failure();
      if (failure.empty()) continue;
      told_[i] = true;
      status.tell(failure + "; it feels nothing any more, the others go on");
    }
  }

 private:
  std::vector<bool> told_;
};

LiveOutcome outcome_of(const LiveHands& hands, bool interrupted) {
  LiveOutcome outcome;
  for (const LiveHand& hand : hands) outcome.hands.push_back(hand.report());
  outcome.interrupted = interrupted;
  return outcome;
}

}  // namespace

LiveOutcome run_live(Run& run, WaitingClock& clock, const EachStep& each) {
  const Interruption interruption;
  LiveStatus status;
  FailureWatch failures;
  LiveHands hands;
  // Setting them up may take half a second; recordings begin when the hands do.
  const double start = start_hands(run, clock, hands);
  LiveFeed feed(run.touched, run.felt, clock, start);
  std::optional<View> view;
  if (has_page(run.options)) view.emplace(run, servos_of(hands), feed);
  const EachStep keep = [&](std::size_t hand, const TouchStep& step) {
    each(hand, step);
    if (view) view->add(hand, step);
  };
  while (any_goes_on(hands, clock.now()) && !interruption.asked()) {
    std::this_thread::sleep_for(kLook);
    for (LiveHand& hand : hands) hand.take_steps(keep);
    if (view) view->look();
    const double now = clock.now();
    failures.look(hands, now, status);
    if (status.due(now - start)) status.show(moment_of(hands, feed, now, start));
  }
  for (LiveHand& hand : hands) hand.stop();
  for (LiveHand& hand : hands) hand.take_steps(keep);
  view.reset();  // it looks at what the feed takes down
  feed.finish();
  return outcome_of(hands, interruption.asked());
}

}  // namespace palpate::app
