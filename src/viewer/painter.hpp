#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <cstddef>
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
#include "viewer/cloud_painter.hpp"
#include "viewer/surface_painter.hpp"

namespace palpate::viewer {

/// All that takes more than some microseconds to make.
struct Picture {
  std::vector<PaintedCloud> clouds;      ///< of every source, for every budget above 0
  std::vector<PaintedSurface> surfaces;  ///< of every device
  SharedBytes sources;                   ///< the message `sources`; null: not now
  std::string complaint;                 ///< why there is no more; empty: nothing is new
};

struct PainterOptions {
  std::vector<Servo*> servos;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::function<std::vector<ViewerStream>()> streams = {};
  std::function<void(Picture)> show;  ///< called on the painter's thread
};

/// A thread that makes pictures while somebody looks: no more than 10 a second, and no more than a
/// quarter of its time. Where nobody looks, it waits and holds no field.
class Painter {
 public:
  Painter(Scene& scene, PainterOptions options);
  /// Waits for the picture that is under way.
  ~Painter() = default;
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// How many points those who look draw, 0: they draw nothing now; empty: nobody looks. Any
  /// thread.
  void look(std::set<std::size_t> budgets);

 private:
  void run(const std::stop_token& stop);
  void work(const std::stop_token& stop, const std::set<std::size_t>& budgets);
  [[nodiscard]] Picture paint(const std::set<std::size_t>& budgets);
  void paint_surfaces(Picture& picture);
  void join_scene();
  void report(Picture& picture);
  [[nodiscard]] std::string news(std::string complaint);
  [[nodiscard]] double now() const;

  Scene& scene_;
  PainterOptions options_;
  std::mutex mutex_;  // of the budgets; no servo takes it
  std::condition_variable_any changed_;
  std::set<std::size_t> budgets_;

  // The thread's.
  CloudPainter clouds_;
  std::vector<std::unique_ptr<SurfacePainter>> surfaces_;
  std::string told_;          // the last complaint
  double reported_ = -1e300;  // s, of the host

  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate::viewer
