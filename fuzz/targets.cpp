// Gives bytes to each reader and checks its promises.
#include "targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bag/mcap_check.hpp"
#include "bag/mcap_reader.hpp"
#include "e57_pages_of.hpp"
#include "io/copc.hpp"
#include "io/depth_image.hpp"
#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/splats/splats.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/trajectory.hpp"
#include "sensor/pose_track.hpp"
#include "sensor/sequence.hpp"

namespace palpate::fuzz {
namespace {

constexpr auto kNames = std::to_array<std::string_view>(
    {"any",        "array",  "cdr",          "copc",         "depth",    "e57",
     "frame_list", "gltf",   "gzip",         "haply_frame",  "las",      "laz",
     "mcap",       "obj",    "pcd",          "pgm",          "ply",      "png",
     "poses",      "potree", "remote_frame", "remote_state", "sequence", "splat",
     "splat_ply",  "spz",    "stl",          "trajectory",   "xyz"});

void check_promises(const CloudFile& file) {
  const PointCloud& cloud = file.cloud;
  const std::size_t n = cloud.size();
  const auto fits = [n](const auto& column) { return column.empty() || column.size() == n; };
  expect(n > 0, "a cloud without points");
  expect(fits(cloud.normals) && fits(cloud.colors) && fits(cloud.intensities), "column lengths");
  const bool sampled = file.splats || (file.mesh && file.mesh->spacing > 0);
  expect(sampled || file.declared == n + file.dropped, "counts that do not add up");
  expect(cloud.origin.allFinite(), "origin");
  expect(!cloud.viewpoint || cloud.viewpoint->allFinite(), "viewpoint");
  for (const auto& p : cloud.positions) expect(p.allFinite(), "a position that is not finite");
  for (const float v : cloud.intensities) expect(std::isfinite(v), "intensity");
  for (const auto& normal : cloud.normals) {
    const float length = normal.norm();
    expect(length == 0 || std::abs(length - 1) < 1e-5F, "a normal that is not unit");
  }
}

void check_rewriting(const CloudFile& file) {
  if (file.cloud.size() > 1000) return;
  for (const CloudFormat format : {CloudFormat::ply, CloudFormat::pcd}) {
    for (const bool ascii : {false, true}) {
      const std::string text = encode_cloud(file.cloud, format, {.ascii = ascii});
      const auto again = read_cloud_bytes(std::as_bytes(std::span(text)), "written");
      expect(again.cloud.size() == file.cloud.size(), "points lost in writing");
    }
  }
}

void check_depth(std::span<const std::byte> bytes) {
  const ReadDepthOptions options{.camera = {0, 0, {100, 100, 2, 2}, {}}};
  const DepthFrame frame = read_depth_frame_bytes(bytes, "input", options);
  expect(frame.camera.width > 0 && frame.camera.height > 0, "a frame without pixels");
  const auto pixels =
      static_cast<std::size_t>(frame.camera.width) * static_cast<std::size_t>(frame.camera.height);
  expect(frame.depth.size() == pixels, "depths that are not one a pixel");
  for (const float z : frame.depth) expect(std::isfinite(z) && z >= 0, "a depth");
}

void check_poses(std::string_view text) {
  const sensor::Poses poses = sensor::parse_poses(text, "input");
  const auto check = [](const Eigen::Isometry3d& pose) {
    expect(pose.matrix().allFinite(), "a pose that is not finite");
    const Eigen::Matrix3d square = pose.linear() * pose.linear().transpose();
    expect(square.isIdentity(1e-9), "a rotation that is none");
  };
  if (const auto* track = std::get_if<sensor::PoseTrack>(&poses)) {
    for (const auto& known : *track) {
      if (known.pose) check(*known.pose);
      if (const auto pose = sensor::pose_at(*track, known.stamp)) check(*pose);
    }
  } else if (const auto* ordered = std::get_if<sensor::PosesByOrder>(&poses)) {
    for (const auto& [number, pose] : ordered->poses) check(pose);
  } else {
    for (const auto& [number, pose] : std::get<sensor::PosesByNumber>(poses).poses) check(pose);
  }
}

void check_frame_list(std::string_view text) {
  double last = -std::numeric_limits<double>::infinity();
  for (const sensor::ListedFrame& frame : sensor::parse_frame_list(text, "input")) {
    expect(frame.stamp > last && !frame.image.empty(), "a list out of order");
    last = frame.stamp;
  }
}

void check_mcap(std::span<const std::byte> bytes) {
  // In memory, as a tab has it; of a path only what opens it differs.
  const std::shared_ptr<std::byte[]> copy(new std::byte[bytes.size()]);
  std::ranges::copy(bytes, copy.get());
  const bag::RandomFile file("input", copy, bytes.size());
  bag::McapReader reader(file);
  const bag::Contents& contents = reader.contents();
  std::size_t zeros = 0;  // so that every byte is read
  for (bag::Message message; reader.next(message);) {
    (void)reader.channel_of(message);  // it is known
    zeros += static_cast<std::size_t>(std::ranges::count(message.data, 0));
  }
  expect(std::uint64_t{zeros} >> 40 == 0, "messages without end");
  expect(contents.closed || !contents.losses.empty(), "a loss that is not told");
  bag::Contents checked = contents;
  bag::check(file, checked);
  for (std::size_t i = 0; i < contents.attachments.size(); ++i) {
    try {
      expect(reader.attachment(i).data.size() <= bytes.size(), "an attachment");
    } catch (const Error&) {
      continue;
    }
  }
}

void check_copc(const io::Input& input) {
  const io::LasHeader header = io::read_las_header(input);
  const io::Parts file = io::parts_of(input.bytes);
  const std::optional<io::Copc> copc = io::read_copc(input, header, file);
  if (!copc) return;
  std::size_t points = 0;
  for (const io::StoredNode& node : copc->nodes) {
    points += node.node.points;
    if (node.node.points == 0 || node.node.points > 10'000) continue;  // correct, but slow
    try {
      const auto bytes = input.bytes.subspan(node.offset, node.bytes);
      expect(io::decode_node(input, header, bytes, node).size() == node.node.points, "its points");
    } catch (const Error&) {
      continue;
    }
  }
  expect(points == header.points, "nodes that are not all of the file");
}

// Without their shell, which takes a second however few they are: "any" and "splat" have it.
void check_splats(const io::SplatFile& file) {
  for (const Splat& splat : file.splats) {
    expect(splat.position.allFinite() && splat.sigma.allFinite(), "a splat that is not finite");
    expect(splat.sigma.minCoeff() >= 0, "a negative extent");
    expect(std::abs(splat.rotation.norm() - 1) < 1e-5F, "a rotation that is none");
    expect(splat.opacity >= 0 && splat.opacity <= 1, "an opacity");
  }
}

// The bytes lack the CRCs of their pages: hardly any that a fuzzer makes would be right.
void check_e57(const io::Input& input) {
  const std::vector<std::byte> pages = e57_pages_of(input.bytes);
  const io::Input paged{pages, input.name, input.options};
  check_promises(io::read_e57(paged));
  for (const std::size_t number : io::e57_scans_with_points(paged)) {
    expect(number > 0, "a scan without a number");
  }
}

// True when `name` is one of the parts of a sequence.
bool run_sequence_target(std::string_view name, const io::Input& input) {
  if (name == "depth") {
    check_depth(input.bytes);
  } else if (name == "poses") {
    check_poses(input.text());
  } else if (name == "frame_list") {
    check_frame_list(input.text());
  } else if (name == "sequence") {
    const auto sequence = sensor::parse_description(input.text(), "input");
    expect(sequence.camera.pinhole.fx >= 0 && sequence.depth_unit > 0, "a camera that is none");
  } else {
    return false;
  }
  return true;
}

CloudFile read_as(std::string_view name, const io::Input& input) {
  if (name == "array") return io::read_array(input);
  if (name == "gltf") return io::read_gltf(input);
  if (name == "las" || name == "laz") {
    check_pieces(input.bytes);
    return io::read_las(input);
  }
  if (name == "obj") return io::read_obj(input);
  if (name == "pcd") return io::read_pcd(input);
  if (name == "pgm") return io::cloud_of(input, io::read_pgm(input));
  if (name == "ply") return io::read_ply(input);
  if (name == "png") return io::cloud_of(input, io::read_png(input));
  if (name == "potree") return read_potree(input.bytes);
  if (name == "splat") return io::shell_file(input, io::read_dot_splat);
  if (name == "stl") return io::read_stl(input);
  if (name == "xyz") return io::read_xyz(input);
  return read_cloud_bytes(input.bytes, input.name, input.options);
}

}  // namespace

std::span<const std::string_view> target_names() {
  return kNames;
}

void run_target(std::string_view name, std::span<const std::byte> bytes) {
  ReadOptions options;
  options.intrinsics = Pinhole{.fx = 100, .fy = 100, .cx = 2, .cy = 2};
  // m; more than any mesh is long. Faces that are felt take a second each: "any" has them.
  if (name == "obj" || name == "stl") options.mesh_spacing = 1e100;
  const io::Input input{bytes, "input", options};
  try {
    if (name == "cdr") {
      check_messages(bytes);
    } else if (name == "copc") {
      check_copc(input);
    } else if (name == "mcap") {
      check_mcap(bytes);
    } else if (name == "e57") {
      check_e57(input);
    } else if (name == "gzip") {
      (void)io::gunzip(input);
    } else if (name == "splat_ply") {
      check_splats(io::read_splat_ply(input));
    } else if (name == "spz") {
      check_splats(io::read_spz(input));
    } else if (name == "trajectory") {
      TrajectoryOptions columns{.forces = true};
      if (input.text().starts_with('%')) columns.columns = {"t", "-", "hip_x", "hip_y", "hip_z"};
      std::istringstream stream{std::string(input.text())};
      (void)read_trajectory(stream, "input", columns);
    } else if (!run_device_target(name, bytes) && !run_sequence_target(name, input)) {
      const CloudFile file = read_as(name, input);
      check_promises(file);
      check_rewriting(file);
    }
  } catch (const Error&) {
    return;  // what a reader says to bytes that it cannot use
  }
}

}  // namespace palpate::fuzz
