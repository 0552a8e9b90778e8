// Moves a hand with a tool through a surface and counts what it meets.
#include "tools/hands.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "geometry/turn.hpp"
#include "geometry/wrench.hpp"

namespace palpate::tools_bench {

namespace {

constexpr double kTick = 1e-3;        // s
constexpr int kLegs = 6;              // of an excursion; judgement: some seconds
constexpr double kSlowest = 0.05;     // m/s; judgement: a careful hand
constexpr double kFastest = 0.4;      // m/s; judgement: a hasty one
constexpr double kFastestTurn = 3;    // rad/s; judgement
constexpr double kLargestTurn = 1.5;  // rad to each side; judgement: what a wrist does
constexpr double kWidest = 0.04;      // m, that a gripper opens
constexpr int kLookedAt = 20;  // steps from one look at all depths to the next; they take longer

double work(const Wrench& wrench, const Pose& from, const Pose& to) {
  return wrench.force.dot(to.position - from.position) +
         wrench.torque.dot(turn_between(from.orientation, to.orientation)) +
         wrench.grip * (to.opening - from.opening);
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

WanderingHand::WanderingHand(std::uint64_t seed, const Eigen::Vector3d& middle, double radius)
    : random_(seed), middle_(middle), radius_(radius) {
  start_.position = middle + Eigen::Vector3d(0, 0, 2 * radius);
  start_.opening = kWidest;
  from_ = to_ = now_ = start_;
}

Pose WanderingHand::random_pose() {
  Eigen::Vector3d offset;
  do {
    offset = {even(-1, 1), even(-1, 1), even(-1, 1)};
  } while (offset.norm() > 1);
  const Eigen::Vector3d axis = Eigen::Vector3d(even(-1, 1), even(-1, 1), even(-1, 1)).normalized();
  return {middle_ + radius_ * offset,
          Eigen::Quaterniond(Eigen::AngleAxisd(even(0, kLargestTurn), axis)), even(0, kWidest)};
}

const Pose& WanderingHand::next() {
  if (share_ >= 1) {
    leg_ = (leg_ + 1) % kLegs;
    from_ = now_;
    to_ = leg_ == 0 ? start_ : random_pose();
    const double speed = kSlowest * std::pow(kFastest / kSlowest, random_.uniform());
    const double seconds =
        std::max((to_.position - from_.position).norm() / speed,
                 turn_between(from_.orientation, to_.orientation).norm() / kFastestTurn);
    share_ = 0;
    step_ = kTick / std::max(seconds, kTick);
  }
  share_ += step_;
  if (share_ >= 1) return now_ = to_;
  now_.position = from_.position + share_ * (to_.position - from_.position);
  now_.orientation = from_.orientation.slerp(share_, to_.orientation);
  now_.opening = from_.opening + share_ * (to_.opening - from_.opening);
  return now_;
}

Met wander(const Stage& stage, const std::shared_ptr<const Tool>& tool, WanderingHand hand,
           std::uint64_t steps, double allowed) {
  Met met;
  ToolProxy proxy(tool, {.stiffness = 500});
  proxy.reset(hand.start());
  Pose last = hand.start();
  Wrench felt;
  double sum = 0;
  for (std::uint64_t i = 0; i < steps; ++i) {
    const Pose now = hand.next();
    const double begin = thread_seconds();
    stage.update(kTick * static_cast<double>(i), now, proxy);
    const ToolContact contact = stage.step(proxy, now);
    const auto us = static_cast<float>(1e6 * (thread_seconds() - begin));
    (contact.touching ? met.touch_us : met.free_us).push_back(us);
    ++met.steps;
    met.touching += contact.touching ? 1 : 0;
    met.open += has(contact.notes, ContactNote::not_converged) ? 1 : 0;
    met.not_finite += is_finite(contact.wrench) && !has(contact.notes, ContactNote::fault) ? 0 : 1;
    sum += 0.5 * (work(felt, last, now) + work(contact.wrench, last, now));
    felt = contact.wrench;
    last = now;
    if (hand.closed() && !contact.touching) {
      met.given = std::max(met.given, sum);
      sum = 0;
    }
    if (i % kLookedAt != 0 || !contact.touching) continue;
    stage.depths(proxy, [&](double depth) {
      ++met.looked;
      met.deep += depth > allowed ? 1 : 0;
      met.deepest = std::max(met.deepest, depth);
    });
  }
  return met;
}

double quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace palpate::tools_bench
