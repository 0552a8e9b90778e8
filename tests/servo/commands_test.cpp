// Everything that a loop or a page may command while something is touched: no force leaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string>

#include "servo/allowed_step.hpp"
#include "servo/servo_rig.hpp"
#include "support/effort.hpp"
#include "support/random_hand.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kMostForce = 0.3;    // N in a step of a hand at rest
constexpr double kMostTorque = 3e-3;  // N m, the same
constexpr double kDeep = 12e-3;       // m, of the point in the sheet
constexpr double kWorthFading = 0.5;  // N
constexpr int kClutch = 1;            // the button

enum class Order { reset, pause, go_on, clutch, stiffness, friction, field, added_force };
constexpr int kOrders = 8;

// A hand at a sheet, and somebody who presses all buttons.
class Commanded {
 public:
  Commanded(const ServoOptions& options, double torque)
      : servo_(rated(device_, torque), with_sheet(scene_), with_clutch(options)) {}

  void go_to(const Vector3d& position, double turn = 0) {
    DeviceState& state = device_.state();
    state.velocity = (position - state.position) / kTick;
    state.position = position;
    state.orientation = Eigen::AngleAxisd(turn, Vector3d::UnitY());
  }

  const ServoState& step() { return servo_.tick(now_ += kTick); }

  void order(Order order) {
    std::uniform_real_distribution<double> share(0, 1);
    switch (order) {
      case Order::reset:
        servo_.reset();
        break;
      case Order::pause:
        servo_.pause(true);
        break;
      case Order::go_on:
        servo_.pause(false);
        break;
      case Order::clutch:
        device_.state().buttons ^= 1u << kClutch;
        break;
      case Order::stiffness:
        contact_.stiffness = 500 * share(random_);
        servo_.set_contact(contact_);
        break;
      case Order::friction:
        contact_.friction.static_coefficient = share(random_);
        contact_.friction.dynamic_coefficient = 0.5 * contact_.friction.static_coefficient;
        servo_.set_contact(contact_);
        break;
      case Order::field:
        if (!servo_.options().tool) {
          servo_.set_field({.kind = static_cast<FieldOptions::Kind>(random_() % 3)});
        }
        break;
      case Order::added_force:
        servo_.add_force({share(random_), 0, share(random_)});
        break;
    }
  }

  [[nodiscard]] Servo& servo() { return servo_; }
  [[nodiscard]] const DeviceState& hand() { return device_.state(); }
  [[nodiscard]] std::mt19937& random() { return random_; }
  [[nodiscard]] double stiffness() const { return contact_.stiffness; }

 private:
  static Scene& with_sheet(Scene& scene) {
    add_sheet(scene);
    return scene;
  }
  static FreeDevice& rated(FreeDevice& device, double torque) {
    device.info().maximum_force = 20;
    device.info().maximum_torque = torque;
    device.info().has_orientation = torque > 0;
    return device;
  }
  static ServoOptions with_clutch(ServoOptions options) {
    options.clutch_button = kClutch;
    return options;
  }

  std::mt19937 random_{1};
  FreeDevice device_{{0, 0, 0.02}};
  Scene scene_;
  Servo servo_;
  ContactSettings contact_{.stiffness = 500};
  double now_ = 0;
};

void press(Commanded& hand, double deep, double turn) {
  for (int i = 0; i < 600; ++i) {
    hand.go_to({0, 0, 0.02}, turn);
    hand.step();
  }
  const int steps = 400;
  for (int i = 0; i <= steps; ++i) {
    hand.go_to({0, 0, 0.02 - (0.02 + deep) * i / steps}, turn);
    hand.step();
  }
  for (int i = 0; i < 200; ++i) {
    hand.go_to({0, 0, -deep}, turn);
    hand.step();
  }
}

// Whoever gives an order now and then: in contact soon, elsewhere rarely. What takes a force away
// is undone before the next order.
class Whims {
 public:
  // Was an order given for this step, and which?
  [[nodiscard]] bool strike(Commanded& hand, double force) {
    const bool soon = undoes_ || force >= kWorthFading;
    if (--rest_ > (soon ? 0 : -400)) return false;
    if (!undoes_) order_ = static_cast<Order>(hand.random()() % kOrders);
    if (undoes_ && order_ == Order::pause) order_ = Order::go_on;
    undoes_ = !undoes_ && (order_ == Order::pause || order_ == Order::clutch);
    hand.order(order_);
    rest_ = 10 + static_cast<int>(hand.random()() % 100);
    return true;
  }
  [[nodiscard]] std::size_t order() const { return static_cast<std::size_t>(order_); }

 private:
  Order order_ = Order::reset;
  bool undoes_ = false;
  int rest_ = 0;
};

class EachOrder : public testing::TestWithParam<int> {};

TEST_P(EachOrder, LeavesAHandAtRestItsForceOrFadesIt) {
  for (const bool tool : {false, true}) {
    ServoOptions options;
    if (tool) options.tool = std::make_shared<const Tool>(Tool::from_text("box:20x30x10", 4e-3));
    Commanded hand(options, tool ? 0.3 : 0);
    press(hand, kDeep, tool ? 0.3 : 0);
    ServoState before = hand.servo().state();
    ASSERT_GT(before.force.norm(), 3);
    if (tool) {
      ASSERT_GT(before.torque.norm(), 5e-3);
    }
    if (GetParam() == static_cast<int>(Order::go_on)) hand.order(Order::pause);
    double most = 0;
    double most_torque = 0;
    for (int i = 0; i < 400; ++i) {
      if (i == 20 || i == 200) hand.order(static_cast<Order>(GetParam()));
      const ServoState& state = hand.step();
      most = std::max(most, (state.force - before.force).norm());
      most_torque = std::max(most_torque, (state.torque - before.torque).norm());
      before = state;
    }
    const std::string of = tool ? "_tool" : "";
    RecordProperty("step_N" + of, std::to_string(most));
    RecordProperty("step_Nm" + of, std::to_string(most_torque));
    EXPECT_LE(most, kMostForce + 1e-9) << (tool ? "a tool" : "a point");
    EXPECT_LE(most_torque, kMostTorque + 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, EachOrder, testing::Range(0, kOrders));

// The same at random moments of a hand that moves: a step is what its motion explains, and the
// slew's.
TEST(Orders, AtAnyMomentMakeNoStepThatTheHandDoesNotExplain) {
  Commanded hand({}, 0);
  RandomHand way(3, 0.015);
  AllowedStep allowed(hand.servo().options().guard);
  Vector3d before = Vector3d::Zero();
  std::array<int, kOrders> felt{};
  Whims whims;
  for (int i = 0; i < effort(200'000); ++i) {
    const bool ordered = whims.strike(hand, before.norm());
    hand.go_to(way.next());
    const ServoState& state = hand.step();
    Guard::Input told;
    told.hip = hand.hand().position;
    told.velocity = hand.hand().velocity;
    told.dt = state.dt;
    told.stiffness = std::min(hand.stiffness(), hand.servo().stiffness_limit());
    if (!state.clutched) {
      told.normal = state.contact.normal;
      told.drift = state.contact.drift;
      told.stiffness = state.contact.stiffness;
    }
    const double most = allowed(told, state.guard.notes);
    ASSERT_LE((state.force - before).norm(), most + 1e-9) << "step " << i;
    if (ordered && before.norm() >= kWorthFading) ++felt[whims.order()];
    before = state.force;
  }
  EXPECT_GT(*std::ranges::min_element(felt), 0) << "an order was never given in contact";
}

}  // namespace
}  // namespace palpate::test
