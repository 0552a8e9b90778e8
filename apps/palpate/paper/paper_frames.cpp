#include "apps/palpate/paper/paper_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

constexpr int kMiddle = 8;  // pixels to either side of the image's middle

}  // namespace

std::unique_ptr<DepthCamera> open_paper_source(const std::string& source) {
  if (!lives(source)) {
    throw UsageError(fmt::format(
        "{} is neither a camera nor a sequence; name one such as sequence:FOLDER", source));
  }
  SourcePlan chosen;
  chosen.argument = {"source", source};
  return open_stream(chosen, nullptr);
}

double depth_in_the_middle(const DepthFrame& frame) {
  std::vector<float> depths;
  const int u = frame.camera.width / 2;
  const int v = frame.camera.height / 2;
  for (int row = std::max(0, v - kMiddle); row < std::min(frame.camera.height, v + kMiddle);
       ++row) {
    for (int column = std::max(0, u - kMiddle); column < std::min(frame.camera.width, u + kMiddle);
         ++column) {
      const auto at = static_cast<std::size_t>(row * frame.camera.width + column);
      if (frame.depth[at] > 0) depths.push_back(frame.depth[at]);
    }
  }
  if (depths.empty()) throw Error("the frame shows nothing in the middle of its image");
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

}  // namespace palpate::app
