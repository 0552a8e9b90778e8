// The proxy graph: a proxy that stays on the edges of a depth image's triangles; of a depth video
// (Cha et al. 2006-09) these move from frame to frame.
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "rivals/frame_mesh.hpp"
#include "rivals/make.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr int kMostMoves = 200;      // a step; judgement: a quarter of a metre of pixels
constexpr double kNearer = 1e-12;    // m^2; judgement: rounding
constexpr double kTick = 1e-3;       // s: the servo at 1 kHz
constexpr double kFrame = 1.0 / 30;  // s: a camera at 30 Hz
constexpr double kJump = 5;          // pixel footprints; judgement, as the terrain's

// A vertex, where `end` is -1, or a point of the edge between two.
struct Place {
  int begin = -1;
  int end = -1;
  double share = 0;  // of the way to the edge's end
  Vector3d at = Vector3d::Zero();
};

class Graph final : public Rival {
 public:
  Graph(bool video, double scale) : video_(video), jump_(kJump * scale) {}

  void show(const Shown& shown) override {
    around_.reserve(8);
    change([&] {
      FrameMesh next(*shown.frame, jump_);
      if (video_) next.come_from(mesh_);
      mesh_ = std::move(next);
      age_ = 0;
      T_world_sensor_ = *shown.frame->T_world_sensor;
    });
    if (touching_) keep_edge();
  }

  void reset(const Vector3d& hip) override {
    last_hip_ = hip;
    touching_ = false;
  }

  Step step(const Vector3d& hip) override {
    age_ += kTick;
    if (video_) change([&] { mesh_.go_on(std::min(age_ / kFrame, 1.0)); });
    if (touching_) keep_pixel();
    const Eigen::Isometry3d T_sensor_world = T_world_sensor_.inverse();
    const Vector3d hand = T_sensor_world * hip;
    if (!touching_) begin(mesh_.first_met(T_sensor_world * last_hip_, hand, {}), hand);
    if (touching_) descend(hand);
    last_hip_ = hip;
    return touching_ ? spring(T_world_sensor_ * place_.at, hip) : spring(hip, hip);
  }

 private:
  // Changes the surface, which may come over a hand in free air.
  template <class Change>
  void change(const Change& make) {
    const bool was_seen =
        mesh_.vertices() > 0 && !mesh_.before(T_world_sensor_.inverse() * last_hip_);
    make();
    const Vector3d hand = T_world_sensor_.inverse() * last_hip_;
    if (!touching_ && was_seen) begin(mesh_.before(hand), hand);
  }

  // A diagonal that the new frame divides no square by becomes the nearer of its ends.
  void keep_edge() {
    mesh_.triangles_at(place_.begin, around_);
    if (std::ranges::any_of(around_, [&](const auto& t) { return has(t); })) return;
    if (place_.share > 0.5) place_.begin = place_.end;
    place_.end = -1;
  }

  // The same share of the same edge, wherever its pixels are now.
  void keep_pixel() {
    touching_ = mesh_.measured(place_.begin) && (place_.end < 0 || mesh_.measured(place_.end));
    if (!touching_) return;
    place_.at = mesh_.at(place_.begin);
    if (place_.end >= 0) place_.at += place_.share * (mesh_.at(place_.end) - place_.at);
  }

  void begin(const std::optional<Met<FrameMesh::Triangle>>& met, const Vector3d& hand) {
    if (!met) return;
    const FrameMesh::Triangle& t = met->part;
    touching_ = true;
    place_ = {t[0], -1, 0, mesh_.at(t[0])};
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) offer(t[i], t[(i + 1) % 3], hand, place_, nearest);
  }

  // Takes the edge's closest point to the hand for `best` if that is nearer.
  void offer(int a, int b, const Vector3d& hand, Place& best, double& nearest) const {
    const Vector3d edge = mesh_.at(b) - mesh_.at(a);
    const double share = std::clamp(edge.dot(hand - mesh_.at(a)) / edge.squaredNorm(), 0.0, 1.0);
    const Vector3d at = mesh_.at(a) + share * edge;
    const double way = (hand - at).squaredNorm();
    if (way >= nearest - kNearer) return;
    nearest = way;
    best = share == 0   ? Place{a, -1, 0, at}
           : share == 1 ? Place{b, -1, 0, at}
                        : Place{a, b, share, at};
  }

  // At a vertex the edges that meet there, on an edge all edges of its two triangles.
  void offer_edges(const FrameMesh::Triangle& t, const Vector3d& hand, const Place& here,
                   Place& best, double& nearest) const {
    for (int i = 0; i < 3; ++i) {
      const int a = t[i];
      const int b = t[(i + 1) % 3];
      if (here.end >= 0 || a == here.begin || b == here.begin) offer(a, b, hand, best, nearest);
    }
  }

  [[nodiscard]] bool has(const FrameMesh::Triangle& t) const {
    return place_.end < 0 || std::ranges::count(t, place_.end) > 0;
  }

  // Goes on while an edge has a nearer point; contact ends above the planes of all triangles there.
  void descend(const Vector3d& hand) {
    for (int i = 0; i < kMostMoves; ++i) {
      mesh_.triangles_at(place_.begin, around_);
      Place best = place_;
      double nearest = (hand - place_.at).squaredNorm();
      for (const FrameMesh::Triangle& t : around_) {
        if (has(t)) offer_edges(t, hand, place_, best, nearest);
      }
      if (best.begin == place_.begin && best.end == place_.end && best.at == place_.at) break;
      place_ = best;
    }
    mesh_.triangles_at(place_.begin, around_);
    touching_ = std::ranges::any_of(around_, [&](const FrameMesh::Triangle& t) {
      return has(t) && mesh_.normal(t).dot(hand - place_.at) < 0;
    });
  }

  bool video_;
  double jump_;
  double age_ = 0;  // of the frame, s
  FrameMesh mesh_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
  Vector3d last_hip_ = Vector3d::Zero();
  bool touching_ = false;
  Place place_;
  std::vector<FrameMesh::Triangle> around_;
};

}  // namespace

std::unique_ptr<Rival> make_graph(double scale) {
  return std::make_unique<Graph>(false, scale);
}
std::unique_ptr<Rival> make_video(double scale) {
  return std::make_unique<Graph>(true, scale);
}

}  // namespace palpate::rivals
