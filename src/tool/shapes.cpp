// The samples of shapes that a formula gives, and shapes by their names.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parse_number.hpp"
#include "base/requirement.hpp"
#include "palpate/tool/tool.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Samples = std::vector<Tool::Point>;

constexpr Requirement kRequireTool{"tool"};  // the name that errors begin with
constexpr double kDense = 0.28;  // radii between a stylus's balls: sqrt(1 - 0.14^2) is 0.99
// Spacings of half of R: balls of more than 0.3 R sink in where only their middle is within R.
constexpr double kSmallBall = 0.6;
constexpr int kLeastAround = 12;      // samples around a ball: flat to 3 % of its radius
constexpr int kLeastRing = 8;         // samples around a thin cylinder (judgement)
constexpr double kRounded = 1e-9;     // of a step: 0.03 / 0.01 is three steps
constexpr double kMillimetre = 1e-3;  // m, the unit of texts

void require_length(const char* name, double value) {
  kRequireTool.positive(name, value, "give a length above 0, in metres");
}

void require_size(const char* name, const Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis) require_length(name, size[axis]);
}

// How many steps of at most this spacing a length takes.
int steps(double length, double spacing) {
  const double count = std::ceil(length / spacing - kRounded);
  kRequireTool(count < static_cast<double>(Tool::kMostSamples), "spacing", spacing,
               "give a larger one, in metres");
  return std::max(1, static_cast<int>(count));
}

// Where the i-th of so many steps ends, from -1/2 to 1/2.
double share(int i, int count) {
  return static_cast<double>(i) / count - 0.5;
}

void require_few(double count, double spacing) {
  kRequireTool(count < static_cast<double>(Tool::kMostSamples), "spacing", spacing,
               "give a larger one, in metres");
}

void add_box(Samples& samples, const Vector3d& size, double spacing, const Vector3d& center,
             int side) {
  const int x = steps(size.x(), spacing);
  const int y = steps(size.y(), spacing);
  const int z = steps(size.z(), spacing);
  const double count = 2. * x * y + 2. * y * z + 2. * z * x;
  require_few(count, spacing);
  for (int i = 0; i <= x; ++i) {
    for (int j = 0; j <= y; ++j) {
      const bool rim = i == 0 || i == x || j == 0 || j == y;
      for (int k = 0; k <= z; k += rim ? 1 : z) {
        const Vector3d at(share(i, x), share(j, y), share(k, z));
        samples.push_back({center + size.cwiseProduct(at), 0, side});
      }
    }
  }
}

void add_ring(Samples& samples, double radius, double spacing, const Vector3d& center) {
  const double around = 2 * std::numbers::pi;
  const int count = radius > 0 ? std::max(kLeastRing, steps(around * radius, spacing)) : 1;
  for (int i = 0; i < count; ++i) {
    const double angle = around * i / count;
    samples.push_back({center + radius * Vector3d(std::cos(angle), std::sin(angle), 0), 0, 0});
  }
}

// The surface of a ball (length 0) or a stylus: rings from pole to pole.
Tool round_tool(double length, double radius, double spacing) {
  const double step = std::min(spacing, 2 * std::numbers::pi / kLeastAround * radius);
  const double quarter = std::numbers::pi / 2;
  const int rings = steps(quarter * radius, step);
  const int along = steps(length, step);
  // Rings of at most so many samples: 8 or more, twice as many as rings on average.
  require_few((2. * rings + along) * (kLeastRing + 4. * rings), spacing);
  Samples samples;
  for (int i = 0; i < rings; ++i) {
    const double angle = quarter * i / rings;
    const Vector3d up(0, 0, radius * std::cos(angle));
    add_ring(samples, radius * std::sin(angle), step, up);
    add_ring(samples, radius * std::sin(angle), step, -up - length * Vector3d::UnitZ());
  }
  for (int i = 0; i <= (length > 0 ? along : 0); ++i) {
    add_ring(samples, radius, step, -length * i / along * Vector3d::UnitZ());
  }
  return Tool(std::move(samples));
}

// A name, how many sizes follow it, and how errors write them.
struct Shape {
  std::string_view name;
  std::size_t sizes;
  const char* form;
};
// In the order in which errors list them.
constexpr std::array<Shape, 5> kShapes = {{{"ball", 1, "ball:R"},
                                           {"capsule", 2, "capsule:LxR"},
                                           {"cylinder", 2, "cylinder:LxR"},
                                           {"box", 3, "box:XxYxZ"},
                                           {"gripper", 3, "gripper:XxYxZ"}}};

const Shape& shape_of(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  std::string forms;
  for (const Shape& each : kShapes) {
    if (each.name == name) return each;
    forms += fmt::format("{}{}", forms.empty() ? "" : ", ", each.form);
  }
  throw Error(fmt::format("tool: \"{}\" is no shape; give one of {}, in millimetres", text, forms));
}

// The sizes behind the colon, m.
std::vector<double> sizes_of(std::string_view text, const Shape& shape) {
  std::vector<double> sizes;
  std::size_t begin = shape.name.size();
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('x', ++begin), text.size());
    const double size = kMillimetre * parse_number(text.substr(begin, end - begin)).value_or(0);
    if (!(size > 0 && size <= Tool::kLongest)) sizes.resize(shape.sizes);  // one too many follows
    sizes.push_back(size);
    begin = end;
  }
  if (sizes.size() != shape.sizes) {
    throw Error(fmt::format(
        "tool: \"{}\" has no such sizes; give {} in millimetres, {} above 0 and "
        "at most {:.0f}",
        text, shape.form, shape.sizes == 1 ? "a number" : "numbers", Tool::kLongest / kMillimetre));
  }
  return sizes;
}

}  // namespace

Tool Tool::ball(double radius) {
  require_length("radius", radius);
  return Tool({{Vector3d::Zero(), radius, 0}});
}

Tool Tool::capsule(double length, double radius, double spacing) {
  require_length("length", length);
  require_length("radius", radius);
  require_length("spacing", spacing);
  Samples samples;
  kRequireTool(length < kDense * radius * static_cast<double>(kMostSamples), "radius", radius,
               "give a larger one, or a shorter stylus");
  const int count = steps(length, std::min(spacing, kDense * radius));
  for (int i = 0; i <= count; ++i) {
    samples.push_back({{0, 0, -length * i / count}, radius, 0});
  }
  return Tool(std::move(samples));
}

Tool Tool::box(const Vector3d& size, double spacing, const Vector3d& center) {
  require_size("edge length", size);
  require_length("spacing", spacing);
  Samples samples;
  add_box(samples, size, spacing, center, 0);
  return Tool(std::move(samples));
}

Tool Tool::cylinder(double length, double radius, double spacing, const Vector3d& center) {
  require_length("length", length);
  require_length("radius", radius);
  require_length("spacing", spacing);
  Samples samples;
  const int along = steps(length, spacing);
  const int across = steps(radius, spacing);
  const double around = kLeastRing + 2 * std::numbers::pi * radius / spacing;
  require_few((static_cast<double>(along) + across) * around, spacing);
  for (int i = 0; i <= along; ++i) {
    const Vector3d middle = center + share(i, along) * length * Vector3d::UnitZ();
    add_ring(samples, radius, spacing, middle);
    const bool end = i == 0 || i == along;
    for (int k = 0; end && k < across; ++k) add_ring(samples, radius * k / across, spacing, middle);
  }
  return Tool(std::move(samples));
}

Tool Tool::gripper(const Vector3d& finger, double spacing) {
  require_size("finger's edge length", finger);
  require_length("spacing", spacing);
  Samples samples;
  for (const int side : {-1, 1}) {
    const Vector3d center(0.5 * side * finger.x(), 0, -0.5 * finger.z());
    add_box(samples, finger, spacing, center, side);
  }
  return Tool(std::move(samples));
}

Tool Tool::from_text(std::string_view text, double spacing) {
  require_length("spacing", spacing);
  const Shape& shape = shape_of(text);
  const std::vector<double> sizes = sizes_of(text, shape);
  const bool is_round = shape.name == "ball" || shape.name == "capsule";
  if (is_round && sizes.back() > kSmallBall * spacing) {
    return round_tool(shape.name == "ball" ? 0 : sizes[0], sizes.back(), spacing);
  }
  if (shape.name == "ball") return ball(sizes[0]);
  if (shape.name == "capsule") return capsule(sizes[0], sizes[1], spacing);
  if (shape.name == "cylinder") return cylinder(sizes[0], sizes[1], spacing);
  const Vector3d size(sizes[0], sizes[1], sizes[2]);
  return shape.name == "box" ? box(size, spacing) : gripper(size, spacing);
}

}  // namespace palpate
