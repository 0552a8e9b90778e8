// Rows of closed bodies: hands wander on them, and circle above them and in a fold.
#include <array>
#include <cmath>
#include <numbers>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

struct ClosedShape {
  const char* name;
  Shape shape;
  Vector3d reach;      // it lies within
  double depth = 1.5;  // hands go so deep
};

std::array<ClosedShape, 6> closed_shapes() {
  const Vector3d end(12, 0, 0);
  return {ClosedShape{"box", box(Vector3d::Zero(), {30, 25, 20}), {16, 14, 11}},
          ClosedShape{"sphere", ball(15), Vector3d::Constant(16)},
          ClosedShape{"torus", torus(15, 6), {22, 22, 7}},
          ClosedShape{"capsule", rod(-end, end, 6), {19, 7, 7}},
          ClosedShape{"slab", box(Vector3d::Zero(), {30, 25, 2.5}), {16, 14, 3}, 1},
          ClosedShape{"dumbbell",
                      unite(rod(end, end + Vector3d::UnitX(), 8),
                            unite(rod(-end, Vector3d::UnitX() - end, 8), rod(-end, end, 3))),
                      {22, 9, 9}}};
}

void make_closed(Draft& draft, const ClosedShape& closed) {
  draft.truth = closed.shape;
  draft.surface(closed.shape, -closed.reach, closed.reach);
}

// A hand that wanders about the surface, 40 spacings a second, now in and now out.
void wander(Draft& draft, double depth) {
  constexpr int kTicks = 8000;       // 8 s
  constexpr double kStep = 0.04;     // spacings a tick
  constexpr double kAway = 4;        // spacings
  constexpr double kSameFace = 0.7;  // cosine
  Vector3d hand = draft.points.front() + kAway * draft.normals.front();
  Vector3d heading = -draft.normals.front();
  draft.hand.start(hand);
  for (int i = 0; i < kTicks; ++i) {
    for (int axis = 0; axis < 3; ++axis) heading[axis] += 0.08 * draft.random.normal();
    const Distance here = draft.truth(hand);
    const double out = heading.dot(here.gradient);
    if (here.value < -depth) heading += (0.15 + 0.5 * std::max(0.0, -out)) * here.gradient;
    if (here.value > kAway) heading -= (0.15 + 0.5 * std::max(0.0, out)) * here.gradient;
    heading.normalize();
    const Vector3d next = hand + kStep * heading;
    // Not from under one face of an edge to under the next: that would stretch the ideal.
    if (here.value < 0 && draft.truth(next).gradient.dot(here.gradient) < kSameFace) {
      heading = here.gradient;
    } else {
      hand = next;
    }
    draft.hand.tick(hand);
  }
}

// Round and round a place on the surface, from free air and back there: no energy may be won.
void circle(Draft& draft, const Vector3d& from, const Vector3d& middle) {
  constexpr int kTurns = 4;
  constexpr int kTicks = 400;  // a turn
  const double radius = draft.between(0.5, 2.5);
  const Vector3d u = radius * draft.direction();
  const Vector3d v = radius * u.cross(draft.direction()).normalized();
  draft.hand.start(from).to(middle + u, kPush);
  for (int i = 1; i <= kTurns * kTicks; ++i) {
    const double angle = 2 * std::numbers::pi * i / kTicks;
    draft.hand.tick(middle + std::cos(angle) * u + std::sin(angle) * v, Wanted::either);
  }
  draft.hand.to(from, kPush);
}

void circle_on_closed(Draft& draft) {
  for (int i = 0; i < 6; ++i) {
    const std::size_t at = draft.random.bits() % draft.points.size();
    circle(draft, draft.points[at] + 8 * draft.normals[at], draft.points[at]);
  }
}

void circle_in_fold(Draft& draft) {
  make_fold(draft, 80);
  for (int i = 0; i < 6; ++i) {
    const Vector3d middle = draft.within({0, -12, -1}, {3, 12, 1});
    circle(draft, {25, middle.y(), 0}, middle);
  }
}

}  // namespace

void add_closed_rows(std::vector<Row>& rows) {
  for (const ClosedShape& closed : closed_shapes()) {
    rows.push_back({"closed", std::string("closed ") + closed.name, [=](Draft& draft) {
                      make_closed(draft, closed);
                      wander(draft, closed.depth);
                    }});
  }
  for (const ClosedShape& closed : closed_shapes()) {
    rows.push_back({"loop", std::string("loop ") + closed.name, [=](Draft& draft) {
                      make_closed(draft, closed);
                      circle_on_closed(draft);
                    }});
  }
  rows.push_back({"loop", "loop fold", circle_in_fold});
}

}  // namespace palpate::any_cloud
