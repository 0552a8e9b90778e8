// Two of 3D Systems' devices, which share one library: what one of them meets is not the other's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <string>

#include "device/openhaptics_rig.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate {
namespace {

using device::OpenHapticsDriver;
using Eigen::Vector3d;
using test::FakeHd;
using test::kDouble;
using test::kOther;
using test::kPush;
using test::kTouch;
using testing::HasSubstr;

constexpr unsigned kFirst = 0;  // their handles
constexpr unsigned kSecond = 1;
constexpr unsigned kNobody = 0xffffffff;

class OpenHapticsPair : public test::OpenHapticsRig {
 protected:
  using Links = std::array<std::unique_ptr<OpenHapticsDriver>, 2>;

  [[nodiscard]] Links open_both() {
    Links links{open_running(kTouch), open_running(kOther)};
    library_.flag("fake_by_itself", false);
    return links;
  }
  void close(Links& links) {
    library_.flag("fake_by_itself", true);
    links = {};
  }
  // One tick for all, and how many of them were answered.
  int exchange(const Links& links) {
    for (const auto& each : links) each->request({.force = kPush});
    tick(1);
    int answered = 0;
    for (const auto& each : links) answered += is_answered(*each) ? 1 : 0;
    return answered;
  }
  static bool is_answered(OpenHapticsDriver& link) {
    try {
      (void)link.answer();
      return true;
    } catch (const Error&) {
      return false;
    }
  }
  void error(unsigned device, unsigned code) const {
    library_.find<void(unsigned, unsigned)>("fake_error")(device, code);
  }
  [[nodiscard]] bool is_pushed(unsigned device) const {
    Vector3d force;
    library_.find<void(unsigned, double*)>("fake_force_of")(device, force.data());
    return force.norm() > 0.7;
  }
  [[nodiscard]] int disturbances() const { return library_.find<int()>("fake_disturbances")(); }
};

TEST_F(OpenHapticsPair, AnErrorTakesTheForceOfItsDeviceAlone) {
  for (const unsigned failing : {kFirst, kSecond}) {
    const unsigned other = 1 - failing;
    Links links = open_both();
    EXPECT_EQ(exchange(links), 2);
    EXPECT_TRUE(is_pushed(kFirst) && is_pushed(kSecond));
    error(failing, 0x0201);
    EXPECT_EQ(exchange(links), 1);
    EXPECT_FALSE(is_pushed(failing)) << "in the very frame that meets it";
    EXPECT_TRUE(is_pushed(other));
    EXPECT_FALSE(is_answered(*links[failing]));
    for (int i = 0; i < 5; ++i) (void)exchange(links);
    EXPECT_FALSE(is_pushed(failing));
    EXPECT_TRUE(is_answered(*links[other])) << failing;
    EXPECT_TRUE(is_pushed(other));
    close(links);
  }
}

TEST_F(OpenHapticsPair, AnErrorOfOneIsFiledWhileTheOtherIsOpened) {
  const auto second = open_running(kOther);
  set(&FakeHd::failing_meanwhile, 0x0201);
  const auto first = open_running(kTouch);
  EXPECT_NO_THROW((void)first->exchange(kPush));
  EXPECT_THROW((void)second->exchange(kPush), Error) << "it is kept for whom it names";
  EXPECT_NO_THROW((void)first->exchange(kPush));
}

TEST_F(OpenHapticsPair, ADeviceThatDoesNotOpenCostsTheOtherNoError) {
  const auto second = open_running(kOther);
  EXPECT_THAT(refusal("openhaptics:Left,library=" + kDouble), HasSubstr("0x0303"));
  EXPECT_NO_THROW((void)second->exchange(kPush));
  set(&FakeHd::failing, 0x0300);
  EXPECT_THAT(refusal(kTouch), HasSubstr("HD_DEVICE_FAULT")) << "in its first frame";
  EXPECT_NO_THROW((void)second->exchange(kPush));
}

TEST_F(OpenHapticsPair, ErrorsOfNobodyAreTheAskersAndThoseOfTheClosedNobodys) {
  auto first = open_running(kTouch);
  const auto second = open_running(kOther);
  first.reset();
  error(kFirst, 0x0300);
  EXPECT_NO_THROW((void)second->exchange(kPush));
  EXPECT_NO_THROW((void)second->exchange(kPush));
  error(kNobody, 0x0300);
  (void)is_answered(*second);
  EXPECT_THROW((void)second->exchange(kPush), Error);
}

TEST_F(OpenHapticsPair, OneIsNotOpenedWhereTheOtherDoesNotComeToRest) {
  const auto first = open_running(kTouch);
  set(&FakeHd::hangs, true);
  EXPECT_THAT(refusal(kOther), HasSubstr("does not stop"));
  EXPECT_EQ(disturbances(), 0);
  set(&FakeHd::hangs, false);
  EXPECT_NO_THROW((void)first->exchange(kPush)) << "it goes on";
  pass(device::OpenHapticsSession::kInterval);
  EXPECT_EQ(refusal(kOther), "no error");
}

TEST_F(OpenHapticsPair, OneThatDoesNotOpenLeavesTheOtherInPeaceForAWhile) {
  auto second = open_running(kOther);
  set(&FakeHd::busy, true);
  EXPECT_THAT(refusal(), HasSubstr("ALREADY"));
  EXPECT_THAT(refusal(), HasSubstr("in 10 s"));
  pass(9.5);
  EXPECT_THAT(refusal(), HasSubstr("in 1 s"));
  pass(0.5);
  EXPECT_THAT(refusal(), HasSubstr("ALREADY"));
  second.reset();
  EXPECT_THAT(refusal(), HasSubstr("ALREADY")) << "nobody is disturbed any more";
}

// A hand with its threads, in real time; no deadline.
class OpenHapticsHeld : public OpenHapticsPair {
 protected:
  // What a servo does, until something is so. False: it never was.
  template <class Condition>
  bool hold(const Condition& condition) {
    for (int i = 0; i < 20000; ++i) {
      const bool ok = second_.read().status == DeviceState::Status::ok;
      second_.write(ok ? kPush : Vector3d::Zero().eval());
      if (condition()) return true;
      steady_.wait_until(steady_.now() + 1e-3);
    }
    return false;
  }
  bool is_held() {
    return hold([this] { return is_pushed(kSecond); });
  }
  // Lets somebody else work meanwhile.
  template <class Work>
  void hold_during(const Work& work) {
    std::future<void> done = std::async(std::launch::async, work);
    (void)hold([&] { return done.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
    EXPECT_NO_THROW(done.get());
  }

  SteadyClock steady_;
  int opened_ = 0;
  ThreadedDevice second_{[this] {
                           ++opened_;
                           return std::make_unique<OpenHapticsDriver>(
                               device::parse_device_name(kOther), steady_);
                         },
                         steady_};
};

TEST_F(OpenHapticsHeld, RestsWithoutAForceWhileAnotherIsOpenedAndClosed) {
  ASSERT_TRUE(is_held());
  // Longer than an exchange waits for a frame.
  set(&FakeHd::opening, 1.3 * OpenHapticsDriver::kPatience);
  std::unique_ptr<OpenHapticsDriver> first;
  hold_during([&] {
    first = std::make_unique<OpenHapticsDriver>(device::parse_device_name(kTouch), steady_);
  });
  EXPECT_EQ(disturbances(), 0);
  EXPECT_TRUE(is_held()) << "it goes on by itself";
  hold_during([&] { first.reset(); });
  EXPECT_EQ(disturbances(), 0);
  EXPECT_TRUE(is_held());
  EXPECT_EQ(opened_, 1);
}

}  // namespace
}  // namespace palpate
