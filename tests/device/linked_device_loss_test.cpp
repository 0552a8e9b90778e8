#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "device/fake_hardware.hpp"
#include "palpate/device/linked_device.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::MovedClock;

// Tells when it lets go of the motors, and fails in its first exchange.
class FailingLink final : public DeviceLink {
 public:
  explicit FailingLink(std::function<void()> lets_go) : lets_go_(std::move(lets_go)) {}
  ~FailingLink() override { lets_go_(); }
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LinkReading exchange(const Vector3d& /*force*/) override {
    throw Error("its cable broke");
  }

 private:
  std::function<void()> lets_go_;
  DeviceInfo info_;
};

// Words take memory and a lock that others may hold.
TEST(LinkedDeviceLoss, ForceIsGoneBeforeItIsSaidWhy) {
  MovedClock clock;
  std::optional<LinkedDevice> device;
  std::string said_then;
  const auto open = [&] {
    return std::make_unique<FailingLink>([&] { said_then = device->reason(); });
  };
  device.emplace(open, clock, LinkedDeviceOptions{.threaded = false});
  device->turn();
  EXPECT_NE(said_then.find("does not answer"), std::string::npos) << said_then;
  EXPECT_EQ(device->reason(), "its cable broke");
}

}  // namespace
}  // namespace palpate
