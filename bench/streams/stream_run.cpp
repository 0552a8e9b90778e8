// Runs hands on a simulated stream.
#include "streams/stream_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <string>

#include "accuracy/truth_frame.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::streams {
namespace {

using Eigen::Vector3d;

constexpr double kLead = 0.002;   // s, from publishing to the start of a surface
constexpr double kSlack = 1e-6;   // ticks
constexpr double kMargin = 0.07;  // clouds are cut to so much around the path, m

struct Hand {
  Hand(Scene& scene, const Tool& tool) : field(scene, tool.field, tool.name), proxy(tool.proxy) {}

  SceneField field;
  Proxy proxy;
};

Ball around(const accuracy::Path& path) {
  Ball ball;
  for (const Vector3d& hip : path.hip) ball.center += hip / static_cast<double>(path.hip.size());
  for (const Vector3d& hip : path.hip) {
    ball.radius = std::max(ball.radius, (hip - ball.center).norm() + kMargin);
  }
  return ball;
}

PointCloud cut(const DepthFrame& frame, const Ball& ball) {
  PointCloud cloud = accuracy::back_project(frame);
  const Vector3d center = frame.T_world_sensor->inverse() * ball.center;
  const auto radius = static_cast<float>(ball.radius);
  const Eigen::Vector3f middle = center.cast<float>();
  std::erase_if(cloud.positions,
                [&](const Eigen::Vector3f& p) { return (p - middle).norm() > radius; });
  return cloud;
}

void push(Source& source, const DepthFrame& frame, const Source::StartTime& start, bool as_cloud,
          const Ball& ball) {
  if (as_cloud) {
    source.set_pose(*frame.T_world_sensor);
    source.push(cut(frame, ball), frame.stamp, start);
  } else {
    source.push(frame, start);
  }
}

// The tick at which what starts at a time (s) is felt first.
std::size_t tick_of(double start) {
  return static_cast<std::size_t>(std::max(0.0, std::ceil(start / kTick - kSlack)));
}

void step(Hand& hand, double now, const Vector3d& hip, StreamTrace& trace) {
  hand.field.update(now, hip, hand.proxy);
  const Contact contact = hand.proxy.step(hand.field, hip, kTick);
  trace.felt.proxy.push_back(contact.proxy);
  trace.felt.force.push_back(hand.proxy.options().stiffness * (contact.proxy - hip));
  const Sample here = hand.field.sample(contact.proxy);
  const Vector3d slope = here.gradient;
  trace.radius.push_back(here.radius);
  trace.normal.push_back(slope.norm() > 0 ? Vector3d(slope.normalized()) : Vector3d::Zero());
}

// A camera and what it shows to a source of the scene; ticks at which that is felt go to `swaps`.
struct Feed {
  Feed(const Setup& setup, std::size_t i, const Contender& contender, Scene& scene,
       std::vector<std::size_t>& swaps)
      : ball(around(setup.path)),
        camera(setup.scene, setup.cameras[i]),
        source(scene.add("camera " + std::to_string(i), contender.source)),
        stream(camera, source.name(),
               [&, as_cloud = contender.clouds](const DepthFrame& frame,
                                                const Source::StartTime& start) {
                 push(source, frame, start, as_cloud, ball);
                 swaps.push_back(tick_of(start()));
               },
               {.latency = setup.latency, .lead = kLead}) {}

  Ball ball;
  SimulatedCamera camera;
  Source& source;
  SimulatedStream stream;
};

}  // namespace

std::vector<StreamTrace> run_stream(const Setup& setup, const Contender& contender) {
  Scene scene;
  std::vector<std::size_t> swaps;
  std::deque<Feed> feeds;
  for (std::size_t i = 0; i < setup.cameras.size(); ++i) {
    feeds.emplace_back(setup, i, contender, scene, swaps);
  }
  std::vector<std::unique_ptr<Hand>> hands;
  for (const Tool& tool : contender.tools) hands.push_back(std::make_unique<Hand>(scene, tool));
  std::vector<StreamTrace> traces(hands.size());
  for (std::size_t i = 0; i < setup.path.hip.size(); ++i) {
    const double now = static_cast<double>(i) * kTick;
    for (Feed& feed : feeds) feed.stream.advance(now);
    for (std::size_t k = 0; k < hands.size(); ++k) {
      step(*hands[k], now, setup.path.hip[i], traces[k]);
    }
  }
  for (StreamTrace& trace : traces) trace.swaps = swaps;
  return traces;
}

}  // namespace palpate::streams
