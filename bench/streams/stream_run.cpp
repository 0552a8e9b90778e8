#include "streams/stream_run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "accuracy/truth_frame.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate::streams {
namespace {

using Eigen::Vector3d;

constexpr double kLead = 0.002;   // s, from publishing to the start of a surface
constexpr double kSlack = 1e-6;   // ticks
constexpr double kMargin = 0.07;  // clouds are cut to so much around the path, m

struct Feed {
  Feed(const Setup& setup, std::size_t i, Source& its)
      : camera(setup.scene, setup.cameras[i]), source(&its) {}

  SimulatedCamera camera;
  Source* source;
  DepthFrame frame;
  bool waiting = false;  // the frame has been taken and is not felt yet
};

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

void push(Feed& feed, const Contender& contender, const Ball& ball, double start) {
  const auto when = [start] { return start; };
  if (contender.clouds) {
    feed.source->set_pose(*feed.frame.T_world_sensor);
    feed.source->push(cut(feed.frame, ball), feed.frame.stamp, when);
  } else {
    feed.source->push(feed.frame, when);
  }
}

void step(Hand& hand, double now, const Vector3d& hip, StreamTrace& trace) {
  hand.field.update(now, hip, hand.proxy.position());
  const Contact contact = hand.proxy.step(hand.field, hip, kTick);
  trace.felt.proxy.push_back(contact.proxy);
  trace.felt.force.push_back(hand.proxy.options().stiffness * (contact.proxy - hip));
  const Side side = hand.proxy.side() == 0 ? Side{1} : hand.proxy.side();
  const Sample here = hand.field.sample(contact.proxy, side);
  const Vector3d slope = here.gradient;
  trace.radius.push_back(here.radius);
  trace.normal.push_back(slope.norm() > 0 ? Vector3d(slope.normalized()) : Vector3d::Zero());
}

std::vector<std::unique_ptr<Feed>> make_feeds(const Setup& setup, const Contender& contender,
                                              Scene& scene) {
  std::vector<std::unique_ptr<Feed>> feeds;
  for (std::size_t i = 0; i < setup.cameras.size(); ++i) {
    Source& source = scene.add("camera " + std::to_string(i), contender.source);
    feeds.push_back(std::make_unique<Feed>(setup, i, source));
  }
  return feeds;
}

}  // namespace

std::vector<StreamTrace> run_stream(const Setup& setup, const Contender& contender) {
  Scene scene;
  const auto feeds = make_feeds(setup, contender, scene);
  std::vector<std::unique_ptr<Hand>> hands;
  for (const Tool& tool : contender.tools) hands.push_back(std::make_unique<Hand>(scene, tool));
  std::vector<StreamTrace> traces(hands.size());
  const Ball ball = around(setup.path);
  for (std::size_t i = 0; i < setup.path.hip.size(); ++i) {
    const double now = static_cast<double>(i) * kTick;
    for (const auto& feed : feeds) {
      if (!feed->waiting) {
        feed->waiting = feed->camera.read(feed->frame, 0) == CameraStatus::frame;
      }
      const double start = feed->frame.stamp + setup.latency;
      if (!feed->waiting || start - kLead > now) continue;
      push(*feed, contender, ball, start);
      feed->waiting = false;
      const auto swap = static_cast<std::size_t>(std::max(0.0, std::ceil(start / kTick - kSlack)));
      for (StreamTrace& trace : traces) trace.swaps.push_back(swap);
    }
    for (std::size_t k = 0; k < hands.size(); ++k) {
      step(*hands[k], now, setup.path.hip[i], traces[k]);
    }
  }
  return traces;
}

}  // namespace palpate::streams
