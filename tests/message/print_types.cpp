// Every type of topic as a line "NAME HASH HEX" of a message whose fields are all different, and
// below it, indented, its definition: what type_hashes.py and others' decoders are compared with.
#include <fmt/format.h>

#include "message/display_types.hpp"
#include "message/schema.hpp"

namespace {

using namespace palpate::message;

// Fills a message with values that differ.
class Filler {
 public:
  template <Number T>
  void put(T& value) {
    value = static_cast<T>(++count_ % 100);
  }
  void put(bool& value) { value = ++count_ % 2 == 0; }
  void put(std::string& text) { text = "text" + std::to_string(++count_); }
  template <class T>
  void put(std::vector<T>& values) {
    values.resize(1 + ++count_ % 3);
    for (T& value : values) put(value);
  }
  template <class T, std::size_t N>
  void put(std::array<T, N>& values) {
    for (T& value : values) put(value);
  }
  template <Message T>
  void put(T& message) {
    T::each(message, [&](const char*, auto& member) { put(member); });
  }

 private:
  int count_ = 0;
};

template <Message T>
void print() {
  T message;
  Filler().put(message);
  std::vector<std::uint8_t> bytes;
  encode(message, bytes);
  fmt::print("{} {} ", ros_name(T::kName), T::kHash);
  for (const std::uint8_t byte : bytes) fmt::print("{:02x}", byte);
  std::string schema = schema_of<T>();
  for (std::size_t at = 0; (at = schema.find('\n', at)) + 1 < schema.size(); at += 3)
    schema.replace(at, 1, "\n  ");
  fmt::print("\n  {}", schema);
}

template <Message... T>
void print_all() {
  (print<T>(), ...);
}

}  // namespace

int main() {
  print_all<Bool, Int32, Float64, Float32MultiArray, Float64MultiArray, Point, Vector3, PoseStamped,
            WrenchStamped, TwistStamped, TFMessage, PointCloud2, Image, CompressedImage, CameraInfo,
            Joy, JointState, DiagnosticArray, Marker, MarkerArray, OmniFeedback, OmniButtonEvent>();
}
