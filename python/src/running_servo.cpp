// Runs a servo with its device in the background of a Python program.
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/device/remote.hpp"
#include "servo.hpp"

namespace palpate::python {
namespace {

constexpr const char* kRemote = "remote";
constexpr double kForever = 1e9;  // s: a hand that was moved stays until it is moved again

bool is_remote(const std::string& name) {
  return name == kRemote || name.starts_with(std::string(kRemote) + ":");
}

// A trajectory of the world as the device in that workspace sees it, from time 0 on.
Trajectory at_device(Trajectory hand, const Workspace& workspace) {
  const double start = hand.empty() ? 0 : hand.front().time;
  for (TrajectoryRow& row : hand) {
    row = {row.time - start, workspace.position_to_device(row.position)};
  }
  return hand;
}

}  // namespace

RunningServo::RunningServo(std::shared_ptr<SharedScene> scene, const ServoPlan& plan)
    : scene_(std::move(scene)), workspace_(plan.servo.workspace) {
  open(plan);
  ServoOptions options = plan.servo;
  options.steps = &queue_;
  {
    const std::lock_guard lock(scene_->mutex);
    servo_ = std::make_unique<Servo>(*device_, scene_->scene, options);
  }
  thread_ = std::make_unique<ServoThread>(*servo_, clock_, plan.realtime, plan.rate);
  realtime_ = thread_->realtime();
  rate_ = thread_->rate();
}

void RunningServo::open(const ServoPlan& plan) {
  if (plan.device == "simulated") return simulate(plan);
  if (!plan.hand.empty())
    throw Error("a hand can be given to the simulated device alone; remove it");
  if (!is_remote(plan.device)) {
    RealtimeOptions asked = plan.realtime;
    asked.processor.reset();  // that of the servo is the servo's alone
    ThreadedDeviceOptions options;
    options.begin = [asked] { (void)make_realtime(asked); };
    device_ = open_device(plan.device, clock_, options);
    return;
  }
  RemoteDeviceOptions options;
  const std::string prefix = std::string(kRemote) + ":";
  if (plan.device.starts_with(prefix)) options.path = plan.device.substr(prefix.size());
  options.rate = plan.rate.value_or(options.rate);
  device_ = std::make_unique<RemoteDevice>(clock_, options);
}

// A hand that plays its trajectory, or waits for move().
void RunningServo::simulate(const ServoPlan& plan) {
  SimulatedDeviceOptions options;
  options.rate = plan.rate.value_or(options.rate);
  Trajectory hand = at_device(plan.hand, workspace_);
  if (hand.empty()) {
    options.position = workspace_.position_to_device(Eigen::Vector3d::Zero());
    hand = {{0, options.position}};
  }
  hand_ = std::make_unique<TeleoperatedHand>(target_, std::move(hand),
                                             TeleoperatedHandOptions{.command_timeout = kForever});
  simulated_ = std::make_unique<SimulatedDevice>(options, *hand_);
  device_ = std::make_unique<PacedDevice>(*simulated_, clock_);
}

void RunningServo::stop() {
  const std::lock_guard lock(mutex_);
  thread_.reset();
}

bool RunningServo::running() const {
  const std::lock_guard lock(mutex_);
  return thread_ && thread_->running();
}

std::string RunningServo::problem() const {
  const ServoState state = servo_->state();
  if (state.device != DeviceState::Status::ok) return device_->reason();
  return std::string(in_words(state.guard.fault));
}

std::vector<Tick> RunningServo::ticks() {
  const std::lock_guard lock(mutex_);
  std::vector<Tick> found;
  while (const std::optional<ServoState> step = queue_.pop()) found.push_back(tick_of(*step));
  return found;
}

void RunningServo::move(const Eigen::Vector3d& position) {
  if (!hand_) throw Error("only a simulated device's hand can be moved; a person holds this one");
  if (!target_.move({workspace_.position_to_device(position)}, clock_.now())) {
    throw Error("a hand cannot be moved to a place that is not finite");
  }
}

}  // namespace palpate::python
