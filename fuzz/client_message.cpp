// Gives messages of a viewer's page to their reader: it reads them or refuses them with words.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "viewer/messages.hpp"

namespace {

using namespace palpate::viewer;

void expect(bool promise, const char* name) {
  if (!promise) throw std::logic_error(name);
}

void check(const Unreadable& unread) {
  expect(!unread.text.empty(), "a refusal without words");
}
void check(const Hello& hello) {
  expect(hello.points <= kMostPoints, "points");
}
void check(const Hand& hand) {
  const Eigen::Vector3d& place = hand.target.position;
  expect(place.allFinite(), "a place that is not finite");
  expect(place.cwiseAbs().maxCoeff() <= kFarthestHand, "a place too far");
  expect(hand.target.maximum_force > 0, "a force that is none");
  expect(hand.device < 256, "device");
}
void check(const Points& points) {
  expect(points.points <= kMostPoints, "points");
}
template <class Other>
void check(const Other&) {}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::visit([](const auto& message) { check(message); }, read_message(text));
  return 0;
}
