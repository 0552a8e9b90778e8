// Nodes that send what no node should. Nothing of it crashes palpate, fills its memory or becomes a
// force.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <thread>

#include "dds/endpoint.hpp"
#include "message/depth_images.hpp"
#include "message/transforms.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate {
namespace {

using namespace message;
using Bytes = std::vector<std::uint8_t>;
using Status = DepthCamera::Status;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kPatience = 20;            // s that a loaded machine may take
constexpr double kMostMemory = 64'000'000;  // bytes that may be held for what floods in

dds::DomainOptions own_domain() {
  setenv("ROS_DOMAIN_ID", std::to_string(100 + getpid() % 100).c_str(), 1);
  return dds::environment_options();
}

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

// Resident, bytes.
double memory() {
  double all = 0;
  double resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

bool before_long(const std::function<bool()>& done) {
  SteadyClock clock;
  for (const double end = clock.now() + kPatience; clock.now() < end;) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

template <class T>
Bytes bytes_of(const T& message) {
  Bytes bytes;
  encode(message, bytes);
  return bytes;
}

Image small_image() {
  DepthFrame frame;
  frame.camera = {.width = 4, .height = 3, .pinhole = {}, .distortion = {}};
  frame.depth.assign(12, 1.5F);
  Image image = image_of(frame);
  image.header = {to_time(wall_clock()), "camera"};
  return image;
}

// A node that sends any bytes as images, and a camera that takes them.
class HostileImages : public testing::Test {
 protected:
  void send(const Bytes& bytes) {
    CameraInfo info =
        info_of({.width = 4, .height = 3, .pinhole = {5, 5, 2, 1.5}, .distortion = {}});
    infos_.write(info);
    images_.write(bytes);
  }

  // The camera's next answer to `bytes`, sent until it has one; frames are of what was sent before.
  Status answer_to(const Bytes& bytes) {
    Status status = Status::waiting;
    before_long([&] {
      send(bytes);
      status = camera_->read(frame_, 0.05);
      return status != Status::waiting && status != Status::frame;
    });
    return status;
  }

  bool sees_a_frame() {
    return before_long([&] {
      send(bytes_of(small_image()));
      return camera_->read(frame_, 0.05) == Status::frame;
    });
  }

  dds::Participant participant_{own_domain()};
  dds::RawWriter images_{participant_, {"/cam/image", Image::kName, Image::kHash}, {.depth = 2}};
  dds::Writer<CameraInfo> infos_{participant_, "/cam/camera_info", {.reliable = true}};
  SteadyClock clock_;
  std::unique_ptr<DepthCamera> camera_ = open_camera("ros:/cam/image", {.clock = &clock_});
  DepthFrame frame_;
};

TEST_F(HostileImages, ThatAreDamagedAreToldAndLeftOut) {
  ASSERT_TRUE(sees_a_frame()) << camera_->reason();
  const auto spoiled = [](auto&& spoil) {
    Image image = small_image();
    spoil(image);
    return bytes_of(image);
  };
  const Bytes whole = bytes_of(small_image());
  std::vector<Bytes> damaged = {{},
                                {0, 1, 0, 0},
                                {0, 9, 0, 0, 1, 2, 3, 4},
                                Bytes(whole.begin(), whole.begin() + 40),
                                Bytes(whole.begin(), whole.end() - 20),
                                spoiled([](Image& image) { image.step = 0; }),
                                spoiled([](Image& image) { image.step = 0x80000000U; }),
                                spoiled([](Image& image) { image.width = 0x80000000U; }),
                                spoiled([](Image& image) { image.height = 0xffffffffU; }),
                                spoiled([](Image& image) { image.encoding = "16UC1\xff"; }),
                                spoiled([](Image& image) { image.data.clear(); })};
  Bytes length = whole;  // of the frame's name: 2^31 and more
  std::fill_n(length.begin() + 12, 4, 0xff);
  damaged.push_back(length);
  for (const Bytes& bytes : damaged) {
    EXPECT_EQ(answer_to(bytes), Status::damaged) << testing::PrintToString(bytes);
    EXPECT_FALSE(camera_->reason().empty());
  }
  EXPECT_TRUE(sees_a_frame()) << camera_->reason();
}

TEST_F(HostileImages, WithStampsThatJumpAreTakenAsTheyCome) {
  for (const double stamp : {0.0, 1e9, wall_clock() - 3600, wall_clock() + 3600, 2147483646.0}) {
    Image image = small_image();
    image.header.stamp = to_time(stamp);
    const double begin = clock_.now();
    ASSERT_TRUE(before_long([&] {
      send(bytes_of(image));
      return camera_->read(frame_, 0.05) == Status::frame;
    }));
    EXPECT_GE(frame_.stamp, begin - 1) << stamp;
    EXPECT_LE(frame_.stamp, clock_.now()) << stamp;
  }
}

TEST_F(HostileImages, TenThousandASecondFillNoMemory) {
  ASSERT_TRUE(sees_a_frame()) << camera_->reason();
  Image image = small_image();
  image.data.resize(40'000);
  const Bytes bytes = bytes_of(image);
  const double before = memory();
  std::atomic<bool> done = false;
  std::thread flood([&] {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20'000; ++i) {
      images_.write(bytes);
      std::this_thread::sleep_until(start + std::chrono::microseconds(100) * i);
    }
    done = true;
  });
  int frames = 0;
  while (!done) {
    frames += camera_->read(frame_, 0.05) == Status::frame ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(33));  // what the filter takes
  }
  flood.join();
  EXPECT_GT(frames, 10);
  EXPECT_LT(memory() - before, kMostMemory);
}

TEST(HostileNode, WithAnotherTypeUnderTheTopicsNameIsNotHeard) {
  const dds::Participant participant(own_domain());
  dds::Writer<PoseStamped> wrong(participant, "/typed/image", {.reliable = true});
  const auto camera = open_camera("ros:/typed/image");
  DepthFrame frame;
  EXPECT_TRUE(before_long([&] {
    wrong.write(PoseStamped{});
    EXPECT_EQ(camera->read(frame, 0.01), Status::waiting);
    return camera->reason().find("geometry_msgs/PoseStamped") != std::string::npos;
  })) << camera->reason();
  dds::Writer<Image> poses(participant, "/typed/pose", {.reliable = true});
  const dds::Reader<WrenchStamped> wrenches(participant, "/typed/wrench", {});
  SteadyClock clock;
  EXPECT_THAT(
      [&] {
        static_cast<void>(open_device("ros:generic,pose=/typed/pose,wrench=/typed/wrench", clock));
      },
      testing::ThrowsMessage<std::exception>(testing::HasSubstr("nobody publishes /typed/pose")));
}

// A node that owns a hand: sends what it is told to, as often as it is told, and keeps the force
// that it was sent last.
class HandNode {
 public:
  using Make = std::function<Bytes()>;

  static Bytes still() {
    return bytes_of(PoseStamped{{to_time(wall_clock()), "hand"}, {{0.01, 0.02, 0.03}, {}}});
  }

  HandNode() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

  // `rate`: Hz; 0: nothing is sent.
  void send(Make make, int rate = 500) {
    const std::lock_guard lock(mutex_);
    make_ = std::move(make);
    rate_ = rate;
  }
  [[nodiscard]] double force() const { return force_; }

 private:
  void run(const std::stop_token& stop) {
    auto due = std::chrono::steady_clock::now();
    WrenchStamped wrench;
    while (!stop.stop_requested()) {
      {
        const std::lock_guard lock(mutex_);
        if (rate_ > 0) poses_.write(make_());
        due += std::chrono::nanoseconds(1'000'000'000 / std::max(rate_, 500));
      }
      while (wrenches_.take(wrench)) force_ = eigen(wrench.wrench.force).norm();
      due = std::max(due, std::chrono::steady_clock::now() - std::chrono::milliseconds(5));
      std::this_thread::sleep_until(due);
    }
  }

  dds::Participant participant_{own_domain()};
  dds::RawWriter poses_{participant_, {"/hand/pose", PoseStamped::kName, PoseStamped::kHash}, {}};
  dds::Reader<WrenchStamped> wrenches_{participant_, "/hand/wrench", {.reliable = true}};
  std::mutex mutex_;
  Make make_ = still;
  int rate_ = 500;
  std::atomic<double> force_ = 0;
  std::jthread thread_;  // last: it uses all of the above
};

class HostileHand : public testing::Test {
 protected:
  // Asks for 1 N, as a servo does, until `done`.
  bool press_until(const std::function<bool()>& done) {
    return before_long([&] {
      state_ = device_->read();
      device_->write(state_.status == DeviceState::Status::ok ? Eigen::Vector3d(0, 0, 1)
                                                              : Eigen::Vector3d::Zero());
      return done();
    });
  }
  bool feels() {
    return press_until([&] {
      return state_.status == DeviceState::Status::ok && node_.force() > 0.99 &&
             node_.force() < 1.01;
    });
  }
  bool is_silent() {
    return press_until([&] {
      return state_.status == DeviceState::Status::silent && node_.force() == 0 &&
             !device_->reason().empty();
    });
  }

  HandNode node_;
  SteadyClock clock_;
  std::unique_ptr<Device> device_ =
      open_device("ros:generic,pose=/hand/pose,wrench=/hand/wrench,profile=omega", clock_);
  DeviceState state_;
};

PoseStamped pose_at(double stamp, double x = 0.01, double w = 1) {
  return {{to_time(stamp), "hand"}, {{x, 0.02, 0.03}, {0, 0, 0, w}}};
}

TEST_F(HostileHand, GetsNoForceWhilePosesAreNone) {
  ASSERT_TRUE(feels()) << device_->reason();
  const std::vector<std::pair<std::string, HandNode::Make>> kinds = {
      {"not a number", [] { return bytes_of(pose_at(wall_clock(), kNone)); }},
      {"no rotation", [] { return bytes_of(pose_at(wall_clock(), 0.01, 0)); }},
      {"far away", [] { return bytes_of(pose_at(wall_clock(), 1e30)); }},
      {"cut", [] { return Bytes{0, 1, 0, 0, 1, 2, 3, 4}; }},
      {"empty", [] { return Bytes{}; }},
      {"a length of 2^31",
       [] {
         Bytes bytes = HandNode::still();
         bytes[15] = 0x80;
         return bytes;
       }},
      {"a second old", [] { return bytes_of(pose_at(wall_clock() - 1)); }},
      {"of an hour later", [] { return bytes_of(pose_at(wall_clock() + 3600)); }},
      {"of the year 1970", [] { return bytes_of(pose_at(0)); }}};
  for (const auto& [name, make] : kinds) {
    node_.send(make);
    EXPECT_TRUE(is_silent()) << name << ": force " << node_.force() << ", " << device_->reason();
    node_.send(HandNode::still);
    ASSERT_TRUE(feels()) << name << ": " << device_->reason();
  }
}

TEST_F(HostileHand, GetsNoForceWhileItJumpsAbout) {
  ASSERT_TRUE(feels()) << device_->reason();
  int count = 0;
  node_.send([&count] { return bytes_of(pose_at(wall_clock(), ++count % 2 == 0 ? 0.2 : -0.2)); });
  EXPECT_TRUE(is_silent()) << node_.force() << " " << device_->reason();
  node_.send(HandNode::still);
  EXPECT_TRUE(feels()) << device_->reason();
}

TEST_F(HostileHand, ThatSendsTenThousandPosesASecondIsFeltAndFillsNoMemory) {
  ASSERT_TRUE(feels()) << device_->reason();
  const double before = memory();
  node_.send(HandNode::still, 10'000);
  const double end = clock_.now() + 3;
  press_until([&] { return clock_.now() > end; });
  EXPECT_TRUE(feels()) << device_->reason();
  EXPECT_LT(memory() - before, kMostMemory);
}

}  // namespace
}  // namespace palpate
