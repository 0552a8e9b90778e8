// Reads the description of a folder of depth images or clouds.
#include "sensor/sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/parse_number.hpp"
#include "io/file_bytes.hpp"
#include "io/input.hpp"
#include "io/time_unit.hpp"
#include "palpate/base/error.hpp"
#include "sensor/frame_files.hpp"
#include "sensor/pose_track.hpp"

namespace palpate {
namespace {

using namespace sensor;
namespace fs = std::filesystem;

constexpr double kRate = 30;  // Hz, if the sequence gives none (judgement)

std::string text_of(const fs::path& path) {
  const io::Bytes bytes = io::read_bytes(path);
  return {reinterpret_cast<const char*>(bytes.span().data()), bytes.size()};
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// Describes a sequence of TUM's benchmark: depth v / 5000 m, and the intrinsics that TUM recommends
// for all of its sequences.
SequenceDescription tum_layout(const fs::path& folder) {
  SequenceDescription sequence;
  sequence.camera.pinhole = {.fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5};
  sequence.depth_unit = 1.0 / 5000;
  for (const char* list : {"depth.txt", "associations.txt"}) {
    if (sequence.frames.empty() && is_file(folder / list)) sequence.frames = list;
  }
  if (is_file(folder / "groundtruth.txt")) sequence.poses = "groundtruth.txt";
  return sequence;
}

SequenceDescription describe(const fs::path& folder) {
  const fs::path description = folder / "sequence.json";
  if (is_file(description)) return parse_description(text_of(description), description.string());
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw Error(fmt::format("{}: no such folder. Give a sequence folder.", folder.string()));
  }
  SequenceDescription sequence = tum_layout(folder);
  if (!sequence.frames.empty()) return sequence;
  if (std::ranges::any_of(frames_in(folder, ""), is_cloud)) {
    sequence.camera = {};
    return sequence;
  }
  throw Error(fmt::format(
      "{}: contains no sequence. Add a sequence.json (docs/sequences.md), the depth.txt "
      "or associations.txt of a TUM RGB-D sequence, or clouds (PCD, PLY, NPY, BIN).",
      folder.string()));
}

// Reads the file that the description names in `field`.
std::string text_named(const fs::path& folder, const std::string& file, std::string_view field) {
  const fs::path path = folder / file;
  if (is_file(path)) return text_of(path);
  throw Error(
      fmt::format("{}: no such file, but \"{}\" in {} names it. Add it, or correct the name.",
                  path.string(), field, (folder / "sequence.json").string()));
}

std::vector<SequenceFrame> listed_frames(const fs::path& folder, const std::string& list) {
  const fs::path path = folder / list;
  std::vector<SequenceFrame> frames;
  for (ListedFrame& frame : parse_frame_list(text_named(folder, list, "frames"), path.string())) {
    frames.push_back({.image = path.parent_path() / frame.image, .stamp = frame.stamp});
  }
  return frames;
}

void check_stamps(const fs::path& folder, const std::vector<double>& stamps, std::size_t images) {
  if (const auto wrong = io::not_in_seconds(stamps.empty() ? 0 : stamps.back())) {
    throw Error(fmt::format("{}: in \"stamps\", {}. {}.", (folder / "sequence.json").string(),
                            wrong->what, wrong->remedy));
  }
  const bool good =
      stamps.empty() || (stamps.size() == images &&
                         std::ranges::adjacent_find(stamps, std::greater_equal{}) == stamps.end());
  if (good) return;
  throw Error(
      fmt::format("{}: \"stamps\" has {} times for {} images, or they do not increase. Give one "
                  "increasing time in seconds per image.",
                  (folder / "sequence.json").string(), stamps.size(), images));
}

// s, of a cloud that is named after its time, as PCL's and ROS's tools name what they write: in s
// with a point, or since 1970 in us or ns, which of a time in this century have 16 and 19 digits.
std::optional<double> time_in_name(const fs::path& frame) {
  const std::string name = frame.stem().string();
  const bool digits = name.find_first_not_of("0123456789.-e") == std::string::npos;
  const std::optional<double> time = parse_number(name);
  if (!is_cloud(frame) || !digits || !time || !std::isfinite(*time)) return std::nullopt;
  if (name.find('.') != std::string::npos) return time;
  const bool since_1970 = name.size() == 16 || name.size() == 19;
  return since_1970 ? std::optional(*time / io::unit_of_time(*time).per_second) : std::nullopt;
}

// False: not all names are times, and nothing has changed.
bool stamp_by_name(std::vector<SequenceFrame>& frames) {
  std::vector<SequenceFrame> stamped = frames;
  for (SequenceFrame& frame : stamped) {
    const std::optional<double> time = time_in_name(frame.image);
    if (!time) return false;
    frame.stamp = *time;
  }
  std::ranges::sort(stamped, {}, &SequenceFrame::stamp);
  const auto same = std::ranges::adjacent_find(stamped, {}, &SequenceFrame::stamp);
  if (same != stamped.end()) return false;
  frames = std::move(stamped);
  return true;
}

std::vector<SequenceFrame> frames_of(const fs::path& folder, const SequenceDescription& sequence) {
  if (!sequence.frames.empty()) return listed_frames(folder, sequence.frames);
  std::vector<SequenceFrame> frames;
  for (fs::path& image : frames_in(folder, sequence.images)) {
    const double stamp = static_cast<double>(frames.size()) / sequence.rate.value_or(kRate);
    frames.push_back({.image = std::move(image), .stamp = stamp});
  }
  if (!sequence.rate && sequence.stamps.empty() && stamp_by_name(frames)) return frames;
  check_stamps(folder, sequence.stamps, frames.size());
  for (std::size_t i = 0; i < sequence.stamps.size(); ++i) frames[i].stamp = sequence.stamps[i];
  return frames;
}

// The digits at the end of a file's name.
std::optional<std::size_t> number_of(const fs::path& image) {
  std::string stem = image.stem().string();
  while (!stem.empty() && (stem.back() < '0' || stem.back() > '9')) stem.pop_back();
  std::size_t begin = stem.size();
  while (begin > 0 && stem[begin - 1] >= '0' && stem[begin - 1] <= '9') --begin;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(stem.data() + begin, stem.data() + stem.size(), number);
  return error == std::errc() && begin < stem.size() ? std::optional(number) : std::nullopt;
}

std::optional<Eigen::Isometry3d> look_up(const std::map<std::size_t, Eigen::Isometry3d>& poses,
                                         std::optional<std::size_t> number) {
  const auto found = number ? poses.find(*number) : poses.end();
  return found == poses.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Eigen::Isometry3d> pose_of(const Poses& poses, const SequenceFrame& frame,
                                         std::size_t i) {
  if (const auto* track = std::get_if<PoseTrack>(&poses)) return pose_at(*track, frame.stamp);
  if (const auto* ordered = std::get_if<PosesByOrder>(&poses)) return look_up(ordered->poses, i);
  return look_up(std::get<PosesByNumber>(poses).poses, number_of(frame.image));
}

void add_poses(const fs::path& folder, const SequenceDescription& description,
               std::vector<SequenceFrame>& frames) {
  const fs::path path = folder / description.poses;
  const Poses poses = parse_poses(text_named(folder, description.poses, "pose"), path.string());
  Eigen::Isometry3d T_posed_sensor = description.T_posed_sensor;
  if (const auto* numbered = std::get_if<PosesByNumber>(&poses)) {
    T_posed_sensor = numbered->T_posed_sensor * T_posed_sensor;
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto pose = pose_of(poses, frames[i], i);
    if (!pose) continue;
    frames[i].T_world_sensor =
        (description.world_to_camera ? pose->inverse() : *pose) * T_posed_sensor;
  }
}

// Frames a second: by the median interval if each frame has its own stamp, else as described.
double rate_of(const SequenceDescription& description, const std::vector<SequenceFrame>& frames) {
  const bool given = description.rate && description.frames.empty() && description.stamps.empty();
  if (given || frames.size() < 2) return description.rate.value_or(kRate);
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    intervals.push_back(frames[i].stamp - frames[i - 1].stamp);
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return 1 / *middle;
}

}  // namespace

bool is_cloud(const fs::path& frame) {
  const std::string ending = io::extension(frame.string());
  return ending == ".pcd" || ending == ".ply" || ending == ".npy" || ending == ".bin";
}

Sequence read_sequence(const fs::path& folder) {
  const SequenceDescription description = describe(folder);
  Sequence sequence{.name = folder.string(),
                    .camera = description.camera,
                    .depth_unit = description.depth_unit,
                    .invalid = description.invalid,
                    .swapped = description.swapped,
                    .frames = frames_of(folder, description)};
  sequence.posed = !description.poses.empty();
  if (sequence.posed) add_poses(folder, description, sequence.frames);
  sequence.rate = rate_of(description, sequence.frames);
  const bool images = std::ranges::any_of(
      sequence.frames, [](const SequenceFrame& frame) { return !is_cloud(frame.image); });
  if (images && sequence.camera.pinhole.fx == 0) {
    throw Error(fmt::format("{}: \"fx\" is missing. Give the focal length in pixels.",
                            (folder / "sequence.json").string()));
  }
  if (images && !is_file(folder / "sequence.json")) {
    sequence.assumed =
        "no sequence.json, so TUM's values: 5000 units of depth a metre, focal length 525 px; if "
        "depths are in mm, say so in a sequence.json";
  }
  return sequence;
}

}  // namespace palpate
