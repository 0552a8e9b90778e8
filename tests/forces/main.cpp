// forces CLOUD: every force of a hand that goes along a cloud 2 mm below its surface, as the bits
// of its numbers. forces frames: what the depth filter makes of some frames. forces sequence
// IMAGE...: every force of a hand on the surface of depth images that follow one another, 30 a
// second. Two builds that print the same compute the same. How long a step took goes to the error
// output. Nothing but + - * / and square roots makes the path, since C libraries differ in the
// others.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/palpate.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

double now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::micro>(now).count();
}

std::string bits(const Vector3d& v) {
  const auto of = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return fmt::format("{:016x} {:016x} {:016x}", of(v[0]), of(v[1]), of(v[2]));
}

// xorshift64 (Marsaglia 2003): the same numbers everywhere.
class Random {
 public:
  std::uint64_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    return state_ ^= state_ << 17;
  }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_ = 88172645463325252u;
};

class Hash {
 public:
  void add(double value) {
    hash_ = (hash_ ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
    hash_ ^= hash_ >> 29;
  }
  std::uint64_t get() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

std::vector<std::byte> bytes_of(const std::string& name) {
  std::FILE* const file = std::fopen(name.c_str(), "rb");
  if (file == nullptr) throw Error(name + ": cannot be opened");
  std::vector<std::byte> bytes;
  std::byte block[65536];
  while (const std::size_t got = std::fread(block, 1, sizeof block, file)) {
    bytes.insert(bytes.end(), block, block + got);
  }
  std::fclose(file);
  return bytes;
}

PointCloud cloud_of(const std::string& name) {
  if (name.find('.') == std::string::npos) return synthetic_cloud(name);
  return read_cloud_bytes(bytes_of(name), name).cloud;
}

// From point to near point of the cloud and towards its middle; of a cloud as large as a bunny,
// 0.15 m, 0.1 mm a step and 2 mm deep.
class Path {
 public:
  explicit Path(const PointCloud& cloud) : cloud_(cloud) {
    Eigen::AlignedBox3f box;
    for (const auto& p : cloud.positions) {
      middle_ += p.cast<double>();
      box.extend(p);
    }
    middle_ /= static_cast<double>(cloud.positions.size());
    unit_ = static_cast<double>(box.sizes().maxCoeff()) / 150;
    at_ = to_ = draw();
  }

  Vector3d next(int step) {
    double left = (to_ - at_).norm();
    if (left < 0.1 * unit_) {
      choose();
      left = (to_ - at_).norm();
    }
    if (left > 0) at_ += (to_ - at_) * (std::min(0.1 * unit_, left) / left);
    const double depth = unit_ * (step < 500 ? -20 + 22. * step / 500 : 2.);
    const Vector3d inward = middle_ - at_;
    return cloud_.origin + at_ + inward * (depth / inward.norm());
  }

 private:
  Vector3d draw() {
    return cloud_.positions[static_cast<std::size_t>(random_.next() % cloud_.positions.size())]
        .cast<double>();
  }
  void choose() {
    double nearest = 1e9 * unit_;
    for (int i = 0; i < 400; ++i) {
      const Vector3d other = draw();
      const double distance = (other - at_).norm();
      if (distance < 5 * unit_ || distance > nearest) continue;
      nearest = distance;
      to_ = other;
    }
  }

  const PointCloud& cloud_;
  Random random_;
  double unit_ = 0;  // m; 1 mm of a cloud that is 150 mm long
  Vector3d middle_ = Vector3d::Zero();
  Vector3d at_, to_;
};

constexpr int kSteps = 3000;  // on a cloud

// Steps a proxy, prints its force and keeps how long that took.
class Felt {
 public:
  explicit Felt(Scene& scene) : field_(scene) {}

  void step(double time, const Vector3d& hand) {
    const double before = now_us();
    field_.update(time, hand, proxy_);
    const Contact contact = proxy_.step(field_, hand, 1e-3);
    took_.push_back(now_us() - before);
    fmt::print("{} {} {}\n", bits(contact.force), contact.touching ? 1 : 0, contact.evaluations);
  }
  // Three thirds, since what runs WebAssembly compiles it better while it runs.
  void report(const std::string& name, double prepared_us) {
    fmt::print(stderr, "{}: prepared in {:.0f} ms; a step took", name, prepared_us / 1e3);
    const std::size_t third = took_.size() / 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::span part = std::span(took_).subspan(i * third, third);
      std::ranges::sort(part);
      fmt::print(stderr, "{} {:.2f}, 99 % at most {:.2f} us", i == 0 ? "" : ";", part[third / 2],
                 part[third * 99 / 100]);
    }
    fmt::print(stderr, "\n");
  }

 private:
  SceneField field_;
  Proxy proxy_{{.stiffness = 500, .friction = {0.3, 0.2, 0}}};
  std::vector<double> took_;
};

void touch(const std::string& name) {
  const PointCloud cloud = cloud_of(name);
  Hash input;
  for (const auto& p : cloud.positions) {
    for (const float x : p) input.add(static_cast<double>(x));
  }
  fmt::print("{}: {} points, {:016x}\n", name, cloud.positions.size(), input.get());
  const double begin = now_us();
  Scene scene;
  scene.add("it", cloud);
  const double prepared = now_us();
  Felt felt(scene);
  Path path(cloud);
  for (int i = 0; i < kSteps; ++i) felt.step(i * 1e-3, path.next(i));
  felt.report(name, prepared - begin);
}

// What lies in the middle of the image, or beside that, on the optical axis; m.
double depth_of_middle(const DepthFrame& frame) {
  const auto [width, height] = std::pair(frame.camera.width, frame.camera.height);
  for (int column = width / 2; column < width; ++column) {
    const float z = frame.depth[static_cast<std::size_t>(height / 2 * width + column)];
    if (z > 0) return static_cast<double>(z);
  }
  throw Error("forces: the middle of the first image shows nothing");
}

// The hand stands 5 mm behind what the first image shows in its middle, and moves 1 mm a frame to
// the right.
void touch_sequence(const std::vector<std::string>& images) {
  ReadDepthOptions options;
  options.camera = {0, 0, {525, 525, 319.5, 239.5}, {}};
  Scene scene;
  Source& source = scene.add("it");
  Felt felt(scene);
  Vector3d hand(0, 0, 0);
  double preparing = 0;
  for (std::size_t k = 0; k < images.size(); ++k) {
    DepthFrame frame = read_depth_frame_bytes(bytes_of(images[k]), images[k], options);
    frame.stamp = static_cast<double>(k) / 30;
    if (k == 0) hand.z() = depth_of_middle(frame) + 5e-3;
    const double begin = now_us();
    source.push(frame, [&] { return frame.stamp; });
    preparing += now_us() - begin;
    for (int i = 0; i < 33; ++i) {
      hand.x() += 1e-3 / 33;
      felt.step(frame.stamp + i * 1e-3, hand);
    }
  }
  felt.report(fmt::format("{} images", images.size()), preparing);
}

// A tilted wall and a ball before it, in whole millimetres with a noise of about 1 mm.
std::vector<std::uint16_t> frame_of(Random& random) {
  std::vector<std::uint16_t> depth(640 * 480);
  for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
    const double x = (static_cast<double>(pixel % 640) - 319.5) / 525;
    const double y = (static_cast<double>(pixel / 640) - 239.5) / 525;
    double z = 1.2 + 0.3 * x;
    const double inside = 0.04 - 0.81 * (x * x + y * y);
    if (inside > 0) z = 0.9 - 0.5 * std::sqrt(inside);
    const double noise = random.unit() + random.unit() + random.unit() + random.unit() - 2;
    depth[pixel] = static_cast<std::uint16_t>(std::lround(1000 * (z + 1.7e-3 * noise)));
  }
  return depth;
}

void filter_frames() {
  DepthFilter filter;
  DepthFrame frame;
  frame.camera = {640, 480, {525, 525, 319.5, 239.5}, {}};
  Random random;
  std::vector<double> took;
  for (int k = 0; k < 12; ++k) {
    const std::vector<std::uint16_t> depth = frame_of(random);
    frame.depth.resize(depth.size());
    to_metres(depth, 1e-3, frame.depth);
    frame.stamp = k / 30.;
    const double before = now_us();
    const FilteredDepth& filtered = filter.filter(frame, Eigen::Isometry3d::Identity());
    took.push_back((now_us() - before) / 1e3);
    Hash hash;
    for (std::size_t i = 0; i < filtered.size(); ++i) {
      if (filtered.states[i] == FilteredDepth::State::empty) continue;
      for (int axis = 0; axis < 3; ++axis) {
        hash.add(static_cast<double>(filtered.positions[i][axis]));
        hash.add(static_cast<double>(filtered.normals[i][axis]));
      }
    }
    fmt::print("frame {}: {:016x}\n", k, hash.get());
  }
  std::ranges::sort(took);
  fmt::print(stderr, "frames: one took {:.1f} ms\n", took[took.size() / 2]);
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) throw Error("forces: name a cloud, as in: forces torus");
  if (arguments[0] == "frames") {
    filter_frames();
  } else if (arguments[0] == "sequence") {
    touch_sequence({arguments.begin() + 1, arguments.end()});
  } else {
    touch(arguments[0]);
  }
  return 0;
}

}  // namespace
}  // namespace palpate

int main(int count, char** arguments) {
  try {
    return palpate::run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
