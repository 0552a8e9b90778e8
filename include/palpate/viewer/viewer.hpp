#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "palpate/device/simulated.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate {

/// Callbacks for actions of a viewer's page. All are called on the viewer's network thread, one at
/// a time, and should return within a millisecond or so. An Error that they throw is reported to
/// the page and changes nothing. An empty callback means that the action is refused, unless its
/// comment states otherwise.
struct ViewerControls {
  /// Something that a viewer's page may change. The viewer has no setting of its own: a program
  /// offers them.
  struct Setting {
    /// A number, a choice or a switch.
    using Value = std::variant<double, std::string, bool>;

    enum class Kind {
      number,  ///< from `least` to `most`
      choice,  ///< one of `choices`
      on_off,  ///< a switch
    };

    std::string key;    ///< "stiffness"; unique
    std::string label;  ///< for people
    std::string unit = {};
    Kind kind = Kind::number;
    double least = 0;  ///< of a number
    double most = 1;
    double step = 0;  ///< that its slider and keys take; 0: any
    std::vector<std::string> choices = {};
    Value value = 0.0;          ///< the present one, of the kind
    bool restarts = false;      ///< another value begins the run anew
    std::string question = {};  ///< that a person is asked, whose answer is a choice; empty: none
  };

  /// Settings with their present values.
  std::function<std::vector<Setting>()> settings = {};
  /// `value` is of the setting's kind and in its range already.
  std::function<void(const std::string& key, const Setting::Value& value)> set = {};

  /// Names of several settings at once.
  std::vector<std::string> presets = {};
  std::function<void(const std::string& name)> preset = {};

  std::function<void(bool on)> pause = {};  ///< empty: Servo::pause of every servo
  /// Resets one servo by its index or, unset, all; empty: Servo::reset.
  std::function<void(std::optional<std::size_t> hand)> reset = {};

  /// Begins or ends a recording. Returns the file's name.
  std::function<std::string(bool on)> record = {};
  /// Recording that runs already when the viewer begins; empty: none.
  std::string recording = {};

  /// Takes a file that a person gave a page; its name has 1 to 250 bytes, no '/' and no control
  /// character, and does not begin with a dot. Empty: pages do not offer it.
  std::function<void(const std::string& name, std::string bytes)> open = {};

  /// A recording that is shown instead of a run: servos show its states, and nobody steps them.
  struct TimeLine {
    /// Moment of the recording that is shown.
    struct Moment {
      double time = 0;  ///< from 0 to `length`, s
      bool playing = false;
      double speed = 1;  ///< s of the recording a second

      bool operator==(const Moment&) const = default;
    };
    struct Force {
      double time = 0;                                  ///< of the step, on the servos' clock, s
      Eigen::Vector3f force = Eigen::Vector3f::Zero();  ///< N
    };

    double length = 0;  ///< s
    std::function<Moment()> moment = {};
    std::function<void(double time)> seek = {};
    std::function<void(bool on, double speed)> play = {};
    /// The largest force in each of equal parts of the length, N; 0 where it is unknown yet.
    std::function<std::vector<float>()> envelope = {};
    /// The forces before the moment that was sought last, oldest first.
    std::function<std::vector<Force>(std::size_t device)> past = {};
  };
  /// Unset: a run is shown. Where it is set, `pause` and `reset` that are empty are refused, too.
  std::optional<TimeLine> time_line = {};

  /// Can a page move this device's hand? Empty: where `hand` is there, all.
  std::function<bool(std::size_t device)> takeable = {};
  /// World metres of a metre that its hand moves; empty: 1.
  std::function<double(std::size_t device)> scale = {};
  /// Gives a tool the target of a page's hand, world frame. `eye`: from where the page sees that
  /// place, if the hand is to go there through free space or, with a limited force, to come down
  /// on it.
  std::function<void(std::size_t device, const TargetSource::Target& target,
                     const std::optional<Eigen::Vector3d>& eye)>
      hand = {};
  /// The page let go of the tool, or went away.
  std::function<void(std::size_t device)> release = {};
};

/// A port that a viewer listens on. While one of these is held, who comes between the end of that
/// viewer and the next one waits for it, and is not refused.
class ListeningPort;

struct ViewerOptions {
  /// A stream as the page shows it.
  struct Stream {
    /// Field of view of a camera: a pyramid along +z of its pose.
    struct Frustum {
      double tan_half_width = 0;
      double tan_half_height = 0;
      double far = 0;  ///< m
    };

    StreamState state;                                     ///< `state.source` names the source
    std::optional<Frustum> frustum = {};                   ///< unset: no camera
    std::optional<Eigen::Isometry3d> T_world_sensor = {};  ///< unset: Source::pose()
  };

  /// Limits on connections and their messages (docs/viewer_protocol.md). Times in s.
  struct Limits {
    std::size_t clients = 8;
    std::size_t connections = 64;     ///< open at a time, of clients and of others; more are closed
    std::size_t message = 64 * 1024;  ///< bytes of a client's message
    std::size_t file = 1 << 30;       ///< bytes of a file to open
    int messages = 250;               ///< a second and client
    std::uint32_t header = 8 * 1024;  ///< bytes of a request's header
    double header_time = 10;          ///< for a request to come, and for its answer to go
    double hello_time = 5;
    double silence = 10;      ///< a client that reads nothing for this long is closed
    double hand_silence = 5;  ///< a client that sends nothing for this long releases its tool
    int refusals = 20;        ///< after so many in `refusal_time` a client is closed
    double refusal_time = 10;
  };

  /// An address of this machine, v4 or v6. 0.0.0.0 and :: listen to every network: anyone who knows
  /// the token may then move the hand, and nothing is encrypted.
  std::string address = "127.0.0.1";
  /// 0: any that is free. Unset: the first free one of kFirstPort and the nine after it.
  std::optional<std::uint16_t> port = {};
  /// Viewer::listening() of a viewer that has ended: goes on there, instead of `address` and
  /// `port`.
  std::shared_ptr<const ListeningPort> listening = {};
  /// 1 to 256 letters, digits and any of -._~; empty: 128 random bits of the system.
  std::string token = {};
  std::string scene = "palpate";  ///< the scene's name, for people
  /// m, world; unset: the middle of all points, or of where the sensors stand. What is shown is
  /// sent in single precision relative to it.
  std::optional<Eigen::Vector3d> origin = {};
  /// Unit; unset: +z, or +y or -y where the points stand on a flat base along it.
  std::optional<Eigen::Vector3d> up = {};
  /// Position from which the scene is shown first if no stream has a sensor's pose, m, world;
  /// unset: any.
  std::optional<Eigen::Vector3d> eye = {};
  /// States of the streams; two threads of the viewer call it about four times a second, perhaps at
  /// the same time.
  std::function<std::vector<Stream>()> streams = {};
  /// State of a robot that follows a tool, in words; called as often. Empty: there is none.
  std::function<std::string()> robot = {};
  Limits limits = {};

  static constexpr std::uint16_t kFirstPort = 8420;
};

/// Shows a scene and its servos on a page in browsers, and lets the page act on the program.
///
/// Serves the page and its socket on one port (docs/viewer_protocol.md) from two threads of its
/// own: one for the network, one that thins clouds and meshes the surface around the tools. No
/// servo ever waits for either. While somebody looks, each servo's scene has one more SceneField.
class Viewer {
 public:
  enum class NoticeLevel { info, warning, fault };

  /// Counts of connections since construction.
  struct Counts {
    std::size_t connections = 0;      ///< open now, clients among them
    std::size_t clients = 0;          ///< that said hello, now
    std::uint64_t accepted = 0;       ///< connections
    std::uint64_t turned_away = 0;    ///< connections and hellos beyond the limits
    std::uint64_t forbidden = 0;      ///< requests with a foreign Host or Origin, and wrong tokens
    std::uint64_t refused = 0;        ///< messages
    std::uint64_t closed_silent = 0;  ///< clients that took nothing for too long
  };

  /// Listens when it returns. Scene and servos outlive it; sources are added before.
  /// @throws Error when the address, the port or the token cannot be had, or there are too many
  /// servos.
  explicit Viewer(Scene& scene, std::vector<Servo*> servos = {}, const ViewerOptions& options = {},
                  ViewerControls controls = {});
  /// Notifies pages that it ends, closes every connection and waits for both threads: 0.2 s and a
  /// picture at most.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Address to open in a browser: "http://127.0.0.1:8420/#token".
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const noexcept;
  /// For the viewer that follows. @throws Error if the system has no file descriptor left.
  [[nodiscard]] std::shared_ptr<const ListeningPort> listening() const;
  [[nodiscard]] Counts counts() const;

  /// At its end, pages are notified that another viewer follows here, and why. Any thread but a
  /// servo's.
  void restarts(std::string why);
  /// Sends every page a notice for the person at it. Any thread but a servo's.
  void notice(NoticeLevel level, std::string text);
  /// Sends every page the progress of long work, 0 to 1; 0: unknown. One such notice stays on
  /// pages until it is 1. Any thread but a servo's.
  void progress(std::string what, double share);
  /// The program itself changed a setting: notifies every page. Any thread but a servo's.
  void settings_changed();
  /// There is another envelope or another past: notifies every page. Any thread but a servo's.
  void time_line_changed();
  /// There is another envelope: notifies every page, whose past stays as it is. Any thread but a
  /// servo's.
  void envelope_changed();
  /// Notifies every page that the recording ended by itself. Any thread but a servo's.
  void record_ended();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
