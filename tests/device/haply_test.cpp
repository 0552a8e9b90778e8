// The driver of Haply's Inverse3, against a service that stands for the maker's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "device/drivers.hpp"
#include "device/fake_haply_service.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FakeHaplyService;
using testing::AllOf;
using testing::HasSubstr;
using Fault = FakeHaplyService::Fault;

const Vector3d kForce(1, 2, -3);
const SteadyClock kClock;

class Haply : public testing::Test {
 protected:
  [[nodiscard]] std::string name(const std::string& id = "04EA") const {
    return "haply:" + id + ",url=" + service_.url();
  }
  [[nodiscard]] std::unique_ptr<DeviceDriver> open() const {
    return device::open_haply(device::parse_device_name(name()), kClock);
  }
  [[nodiscard]] static std::string refusal(const std::string& name) {
    try {
      (void)device::open_haply(device::parse_device_name(name), kClock);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  // What an exchange says while something is wrong.
  [[nodiscard]] std::string complaint(Fault fault) {
    service_.set(Fault::none);
    const auto link = open();
    (void)link->exchange(kForce);
    service_.set(fault);
    try {
      (void)link->exchange(kForce);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  // Where the service's device is after the last command, m.
  [[nodiscard]] double told_x() const { return 1e-6 * service_.commands(); }

  FakeHaplyService service_;
};

TEST_F(Haply, TellsTheHandAndAppliesTheForce) {
  const auto link = open();
  const DeviceState reading = link->exchange(kForce);
  EXPECT_EQ(reading.position, Vector3d(told_x(), -0.036, -0.061));
  EXPECT_EQ(reading.velocity, Vector3d(0.1, 0.2, -0.3));
  EXPECT_EQ(reading.buttons, 5u);
  EXPECT_EQ(service_.forces().front(), kForce);
  EXPECT_EQ(link->info().name, "haply:04EA");
  EXPECT_EQ(link->info().maximum_force, *device_profile("inverse3").maximum_force);
}

TEST_F(Haply, TellsHowItsGripIsHeld) {
  auto link = open();
  EXPECT_TRUE(link->info().has_orientation);
  EXPECT_FALSE(link->info().has_gripper);
  EXPECT_TRUE(
      link->exchange(kForce).orientation.isApprox(Eigen::Quaterniond(0.6, 0, -0.8, 0), 1e-12));
  service_.set(Fault::no_rotation);
  EXPECT_TRUE(link->exchange(kForce).orientation.isApprox(Eigen::Quaterniond::Identity(), 0));
  link.reset();
  EXPECT_FALSE(open()->info().has_orientation);
}

TEST_F(Haply, TellsWhereTheHandIsAfterThisCommand) {
  const auto link = open();
  for (int i = 0; i < 100; ++i) {
    const double x = link->exchange(kForce).position.x();
    ASSERT_EQ(x, told_x());
  }
}

TEST_F(Haply, EndsWithoutAForce) {
  auto link = open();
  (void)link->exchange(kForce);
  const int before = service_.commands();
  link.reset();
  while (service_.commands() == before) std::this_thread::yield();
  EXPECT_EQ(service_.forces().back().norm(), 0);
}

TEST_F(Haply, SaysWhyThereIsNone) {
  EXPECT_THAT(refusal("haply,url=ws://127.0.0.1:1"),
              AllOf(HasSubstr("127.0.0.1:1"), HasSubstr("haply-inverse-service")));
  EXPECT_THAT(refusal("haply,url=localhost"), HasSubstr("ws://HOST:PORT"));
  EXPECT_THAT(refusal("haply,uri=ws://localhost:1"), AllOf(HasSubstr("uri"), HasSubstr("url")));
  EXPECT_THAT(refusal(name("BEEF")), AllOf(HasSubstr("BEEF"), HasSubstr("0001, 04EA")));
  EXPECT_THAT(refusal(name() + ",profile=inverse4"), HasSubstr("inverse4"));
  service_.set(Fault::reset);
  EXPECT_THAT(refusal(name()), AllOf(HasSubstr("not calibrated"), HasSubstr("Hub")));
  service_.set(Fault::closes);
  EXPECT_THAT(refusal(name()), HasSubstr("closed"));
  EXPECT_THAT(refusal("haply,url=" + service_.url()), HasSubstr("the connection was closed"));
  EXPECT_EQ(service_.commands(), 0) << "no force where there is no hand";
}

TEST_F(Haply, ComplainsOfWhateverIsWrong) {
  EXPECT_THAT(complaint(Fault::closes), HasSubstr("was closed"));
  EXPECT_THAT(complaint(Fault::garbage), HasSubstr("not a frame"));
  EXPECT_THAT(complaint(Fault::not_a_number), HasSubstr("not a frame"));
  EXPECT_THAT(complaint(Fault::null), HasSubstr("no position"));
  EXPECT_THAT(complaint(Fault::far), HasSubstr("impossible"));
  EXPECT_THAT(complaint(Fault::gone), HasSubstr("was disconnected"));
  EXPECT_THAT(complaint(Fault::reset), HasSubstr("not calibrated"));
  EXPECT_THAT(complaint(Fault::silent), HasSubstr("stopped answering"));
}

TEST_F(Haply, ServiceThatIsSilentIsToldToTakeTheForceAway) {
  const auto link = open();
  (void)link->exchange(kForce);
  const std::size_t before = service_.forces().size();
  service_.set(Fault::silent);
  EXPECT_THROW((void)link->exchange(kForce), Error);
  std::vector<Vector3d> forces = service_.forces();
  // A first answer that comes late meets a zero, which the service may count after `before`.
  if (forces.at(before).norm() == 0) {
    forces.erase(forces.begin() + static_cast<std::ptrdiff_t>(before));
  }
  ASSERT_EQ(forces.size(), before + 2);
  EXPECT_EQ(forces[before], kForce);
  EXPECT_EQ(forces[before + 1].norm(), 0);
}

TEST_F(Haply, AnswerThatComesLateMeetsNoForce) {
  const auto link = open();
  (void)link->exchange(kForce);
  const std::size_t before = service_.forces().size();
  service_.set(Fault::late);
  (void)link->exchange(kForce);
  service_.set(Fault::none);
  EXPECT_EQ(service_.forces()[before + 1].norm(), 0);
  const double x = link->exchange(kForce).position.x();
  EXPECT_EQ(x, told_x()) << "the answer to this command, no older one";
}

TEST_F(Haply, IsLostAndComesBackBehindTheServosThread) {
  SteadyClock clock;
  const auto device = open_device(name(), clock, {.retry_interval = 0.01});
  const auto step_until = [&](DeviceState::Status wanted) {
    while (device->read().status != wanted) {
      device->write(kForce);
      clock.wait_until(clock.now() + 1e-3);
    }
  };
  step_until(DeviceState::Status::ok);
  for (const Fault fault : {Fault::closes, Fault::garbage, Fault::null}) {
    service_.set(fault);
    step_until(DeviceState::Status::silent);
    EXPECT_THAT(device->reason(), HasSubstr("04EA"));
    service_.set(Fault::none);
    step_until(DeviceState::Status::ok);
    EXPECT_EQ(device->reason(), "");
  }
  EXPECT_GE(service_.connections(), 2);
}

}  // namespace
}  // namespace palpate
