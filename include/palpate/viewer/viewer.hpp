#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer_options.hpp"

namespace palpate {

enum class NoticeLevel { info, warning, fault };

/// What came of those who connected, since construction.
struct ViewerCounts {
  std::size_t connections = 0;      ///< open now, clients among them
  std::size_t clients = 0;          ///< that said hello, now
  std::uint64_t accepted = 0;       ///< connections
  std::uint64_t turned_away = 0;    ///< connections and hellos beyond the limits
  std::uint64_t forbidden = 0;      ///< requests with a foreign Host or Origin, and wrong tokens
  std::uint64_t refused = 0;        ///< messages
  std::uint64_t closed_silent = 0;  ///< clients that took nothing for too long
};

/// Shows a scene and its servos on a page in browsers, and lets the page act on the program.
///
/// Serves the page and its socket on one port (docs/viewer_protocol.md) from two threads of its
/// own: one for the network, one that thins clouds and meshes the surface around the tools. No
/// servo ever waits for either. While somebody looks, each servo's scene has one more SceneField.
class Viewer {
 public:
  /// Listens when it returns. Scene and servos outlive it; sources are added before.
  /// @throws Error when the address, the port or the token cannot be had, or there are too many
  /// servos.
  explicit Viewer(Scene& scene, std::vector<Servo*> servos = {}, const ViewerOptions& options = {},
                  ViewerControls controls = {});
  /// Tells pages that it ends, closes every connection and waits for both threads: 0.2 s and a
  /// picture at most.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// What a person opens: "http://127.0.0.1:8420/#token".
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const noexcept;
  [[nodiscard]] ViewerCounts counts() const;

  /// Tells every page something that a person should know now. Any thread but a servo's.
  void notice(NoticeLevel level, std::string text);
  /// The program itself changed a setting: tells every page. Any thread but a servo's.
  void settings_changed();
  /// What a page began to record has ended by itself: tells every page. Any thread but a servo's.
  void record_ended();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
