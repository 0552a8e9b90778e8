// Checks and orders the samples of a tool, and builds the trees of balls around them.
#include "palpate/tool/tool.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "palpate/base/error.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {
namespace {

constexpr std::uint32_t kLeaf = 4;  // samples in a ball that is not divided (judgement)

void check_sample(const Tool::Point& sample) {
  if (!sample.position.allFinite() || !std::isfinite(sample.radius) || sample.radius < 0) {
    throw Error(
        "tool: a sample is not finite or has a radius below 0; give positions and radii in metres");
  }
  const double out = std::max(sample.position.cwiseAbs().maxCoeff(), sample.radius);
  if (out > Tool::kLongest) {
    throw Error(
        fmt::format("tool: a sample is {} m out; give metres, {} at most", out, Tool::kLongest));
  }
  if (std::abs(sample.side) > 1) {
    throw Error(fmt::format("tool: the side of a sample is {}; give -1, 0 or 1", sample.side));
  }
}

// A unit vector stays as it is: normalising it once more may round it.
Eigen::Vector3d direction_of(const Eigen::Vector3d& axis) {
  // of the length of what was normalised, squared (derived: a few roundings)
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  return std::abs(axis.squaredNorm() - 1) <= kRounding ? axis : axis.stableNormalized();
}

// Puts the lower half of the positions along an axis first. What is in such an order stays in it,
// so that a tool's samples make the same tool again.
void halve(std::span<Tool::Point> part, Eigen::Index axis) {
  const auto lower = [axis](const Tool::Point& a, const Tool::Point& b) {
    return a.position[axis] < b.position[axis];
  };
  const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
  const auto least = std::min_element(middle, part.end(), lower);
  if (std::none_of(part.begin(), middle, [&](const Tool::Point& a) { return lower(*least, a); })) {
    return;
  }
  std::nth_element(part.begin(), middle, part.end(), lower);
}

}  // namespace

Tool::Tool(std::vector<Point> samples, const Eigen::Vector3d& axis)
    : samples_(std::move(samples)), axis_(direction_of(axis)) {
  if (samples_.empty()) throw Error("tool: it has no samples; give at least one");
  if (samples_.size() > kMostSamples) {
    throw Error(fmt::format("tool: it has {} samples; give a larger spacing, for {} at most",
                            samples_.size(), kMostSamples));
  }
  if (!axis_.allFinite() || axis_.isZero(0)) {
    throw Error("tool: the axis has no direction; give the one in which the fingers open");
  }
  for (const Point& sample : samples_) {
    check_sample(sample);
    extent_ = std::max(extent_, sample.position.norm() + sample.radius);
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Point& a, const Point& b) { return a.side < b.side; });
  const auto count = static_cast<std::uint32_t>(samples_.size());
  for (std::uint32_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && samples_[end].side == samples_[begin].side) ++end;
    roots_.push_back(add_node(begin, end));
  }
  double squares = 0;
  for (const Point& sample : samples_) squares += sample.position.squaredNorm();
  gyration_ = std::sqrt(squares / static_cast<double>(samples_.size()));
}

std::int32_t Tool::add_node(std::uint32_t begin, std::uint32_t end) {
  const std::span part = std::span(samples_).subspan(begin, end - begin);
  Box box;
  for (const Point& sample : part) box.extend(sample.position);
  Node node{.center = box.center(), .side = part[0].side, .begin = begin, .end = end};
  for (const Point& sample : part) {
    node.radius = std::max(node.radius, (sample.position - node.center).norm() + sample.radius);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back(node);
  if (part.size() <= kLeaf) return static_cast<std::int32_t>(index);
  Eigen::Index longest = 0;
  box.size().maxCoeff(&longest);
  const std::uint32_t middle = begin + (end - begin) / 2;
  halve(part, longest);
  nodes_[index].left = add_node(begin, middle);
  nodes_[index].right = add_node(middle, end);
  return static_cast<std::int32_t>(index);
}

}  // namespace palpate
