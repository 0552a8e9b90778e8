// Declares the bridge that publishes a run to ROS 2 and sends targets to robots.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/geometry/shapes.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate {

struct RosBridgeOptions {
  /// Options of a robot that follows the first hand's proxy (docs/ros2.md).
  struct Robot {
    /// "crisp", "cartesian", "servo", "crtk" or "generic": which topic takes the target.
    std::string preset;
    std::string ns = {};          ///< its namespace; empty: the preset's usual one
    std::string topic = {};       ///< instead of the preset's
    std::string frame = "world";  ///< frame of reference of the targets
    /// The hand's own position instead of the proxy's: it enters what the camera sees.
    bool hand = false;
    double rate = 250;  ///< targets a second, Hz; 1 to 1000
    /// From the world to the robot's frame of reference: T * (scale * position).
    Eigen::Isometry3d T_robot_world = Eigen::Isometry3d::Identity();
    double scale = 1;
    std::optional<int> dead_man =
        {};  ///< targets are sent only while this button of the hand is down, 0 to 31
    /// Names of the sources whose cameras show which positions are free; empty: all.
    std::vector<std::string> sources = {};
    /// The surface of the first hand's tool (ServoOptions::tool) as it is looked at: balls around
    /// its handle, m, in its axes; what is smaller may pass between them. Empty: the tool's
    /// samples, which are as far apart as the touch needs, up to R / 2: a finger fits between
    /// them. Samples of Tool 2.5 mm apart leave none that is wider.
    std::vector<Ball> shape = {};
    /// Speed at which it goes back from a surface that came over it, m/s, 0 to 1; 0: it stays.
    double retreat = 0.05;
  };

  std::string ns = "/palpate";  ///< of all topics below
  std::string frame = "world";  ///< what palpate's world frame is called
  double rate = 250;            ///< poses, twists, wrenches of each hand a second, Hz; 1 to 1000
  /// Other names for topics, by their whole usual name.
  std::map<std::string, std::string> remap = {};
  std::optional<Robot> robot = {};  ///< what the first hand drives
};

/// Publishes hands and their forces to ROS 2, and takes contact forces from robots, on a thread of
/// its own that no servo waits for. docs/ros2.md lists the topics of each hand.
///
/// In palpate::ros; where the build has no DDS, construction throws Error.
class RosBridge {
 public:
  struct Hand {
    std::string name;  ///< letters, digits and '_'
    Servo* servo = nullptr;
  };

  /// Scene and servos outlive it. `streams` returns the cameras' states; it is called on the
  /// bridge's thread, and may be empty.
  /// @throws Error when an option is out of range, or DDS fails.
  RosBridge(const std::vector<Hand>& hands, const Scene& scene,
            std::function<std::vector<StreamState>()> streams,
            const RosBridgeOptions& options = {});
  ~RosBridge();
  RosBridge(const RosBridge&) = delete;
  RosBridge& operator=(const RosBridge&) = delete;

  /// Targets sent to the robot so far, and why others were withheld.
  struct RobotState {
    std::string topic;
    std::uint64_t told = 0;   ///< targets sent
    std::uint64_t held = 0;   ///< targets that were due and not sent
    std::string why = {};     ///< why the last that was due was held back; empty: it was sent
    std::string reason = {};  ///< the same without numbers
    bool retreats = false;    ///< targets lead back from a surface that came over it
    double age = 0;           ///< of the frame that shows the last target that it follows, s
    std::map<std::string, double> waits = {};  ///< s of it by reason
    std::size_t readers = 0;                   ///< controllers that read the topic
  };

  /// Last problem while it ran, in words; empty if none. Any thread but a servo's.
  [[nodiscard]] std::string problem() const;

  /// State of the robot, if there is one. Any thread but a servo's.
  [[nodiscard]] std::optional<RobotState> robot() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
