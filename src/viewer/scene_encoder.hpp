#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "viewer/cloud_encoder.hpp"
#include "viewer/session.hpp"

namespace palpate::viewer {

/// What is around one tool.
struct EncodedSurface {
  double radius = 0;  ///< R, m; 0: not known
  SharedBytes bytes;  ///< the newest; null: the servo made no step yet
};

class SurfaceEncoder;

/// All that takes more than some microseconds to make.
struct EncodedScene {
  std::vector<EncodedCloud> clouds;      ///< of every source, for every budget above 0
  std::vector<EncodedSurface> surfaces;  ///< of every device
  SharedBytes sources;                   ///< the message `sources`; null: not now
  std::string complaint;                 ///< why there is no more; empty: nothing is new
};

struct SceneEncoderOptions {
  std::vector<Servo*> servos;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::function<std::vector<ViewerStream>()> streams = {};
  std::function<void(EncodedScene)> show;  ///< called on the encoder's thread
};

/// A thread that makes pictures while somebody looks: no more than 10 a second, and no more than a
/// quarter of its time. Where nobody looks, it waits and holds no field.
class SceneEncoder {
 public:
  SceneEncoder(Scene& scene, SceneEncoderOptions options);
  /// Waits for the picture that is under way.
  ~SceneEncoder();
  SceneEncoder(const SceneEncoder&) = delete;
  SceneEncoder& operator=(const SceneEncoder&) = delete;

  /// How many points those who look draw, 0: they draw nothing now; empty: nobody looks. Any
  /// thread.
  void set_budgets(std::set<std::size_t> budgets);

 private:
  void run(const std::stop_token& stop);
  void work(const std::stop_token& stop, const std::set<std::size_t>& budgets);
  [[nodiscard]] EncodedScene encode(const std::set<std::size_t>& budgets);
  void encode_surfaces(EncodedScene& encoded);
  void join_scene();
  void report(EncodedScene& encoded);
  [[nodiscard]] std::string news(std::string complaint);
  [[nodiscard]] double now() const;

  Scene& scene_;
  SceneEncoderOptions options_;
  std::mutex mutex_;  // of the budgets; no servo takes it
  std::condition_variable_any changed_;
  std::set<std::size_t> budgets_;

  // The thread's.
  CloudEncoder clouds_;
  std::vector<std::unique_ptr<SurfaceEncoder>> surfaces_;
  std::string told_;          // the last complaint
  double reported_ = -1e300;  // s, of the host

  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate::viewer
