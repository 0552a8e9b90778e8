// Parses lists of frames and camera poses, and finds the pose at a time.
#include "sensor/pose_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "io/input.hpp"
#include "io/text_scanner.hpp"
#include "io/time_unit.hpp"

namespace palpate::sensor {
namespace {

constexpr double kOff = 0.01;
constexpr double kFarthestOrigin = 1e6;  // m (judgement)

bool is_position(const Eigen::Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= kFarthestOrigin;
}

Eigen::Isometry3d joined(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

}  // namespace

std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& position,
                                       const Eigen::Quaterniond& rotation) {
  const bool good = rotation.coeffs().allFinite() && std::abs(rotation.norm() - 1) <= kOff;
  if (!good || !is_position(position)) return {};
  return joined(position, rotation);
}

std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& position,
                                       const Eigen::Matrix3d& rotation) {
  if (!rotation.allFinite() || !is_position(position)) return {};
  const Eigen::Matrix3d error = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  if (error.cwiseAbs().maxCoeff() > 2 * kOff || rotation.determinant() < 0) return {};
  return joined(position, Eigen::Quaterniond(rotation));
}

namespace {

constexpr std::string_view kRemedy = "Correct this line, or write the list again";

std::optional<ListedFrame> take_frame(std::string_view& line) {
  const std::optional<double> stamp = parse_number(io::take_word(line));
  const std::string_view image = io::take_word(line);
  if (!stamp || !std::isfinite(*stamp) || image.empty()) return {};
  return ListedFrame{*stamp, std::string(image)};
}

bool is_depth(const ListedFrame& frame) {
  return frame.image.find("depth") != std::string::npos;
}

// The frame of a line; of two, the one of depth.
std::optional<ListedFrame> frame_of(std::string_view line) {
  std::optional<ListedFrame> first = take_frame(line);
  if (!first || io::trim(line).empty()) return first;
  std::optional<ListedFrame> second = take_frame(line);
  if (!second || !io::trim(line).empty() || is_depth(*first) == is_depth(*second)) return {};
  return is_depth(*first) ? first : second;
}

void check_seconds(const io::Input& input, std::size_t offset, double stamp) {
  const auto wrong = io::not_in_seconds(stamp);
  if (wrong) io::fail_at_line(input, offset, wrong->what, wrong->remedy);
}

}  // namespace

std::vector<ListedFrame> parse_frame_list(std::string_view text, const std::string& name) {
  const ReadOptions unused;
  const io::Input input{std::as_bytes(std::span(text)), name, unused};
  std::vector<ListedFrame> frames;
  io::TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::size_t offset = scanner.offset();
    const std::string_view line = io::trim(scanner.next_line());
    if (line.empty() || line.front() == '#') continue;
    std::optional<ListedFrame> frame = frame_of(line);
    if (!frame) {
      io::fail_at_line(
          input, offset,
          "this is neither \"time file\" nor \"time file time file\" with one file under depth/",
          kRemedy);
    }
    check_seconds(input, offset, frame->stamp);
    if (!frames.empty() && frame->stamp <= frames.back().stamp) {
      io::fail_at_line(input, offset, "this time is not later than that of the previous line",
                       kRemedy);
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

namespace {

using io::Input;
using io::take_word;
using io::TextScanner;

constexpr double kWidestGap = 0.25;  // s; a hand moves a decimetre in it (judgement)
constexpr double kSame = 1e-3;       // s between a frame's stamp and its pose (judgement)
constexpr std::string_view kPoseRemedy = "Correct this line, or export the poses again";

bool is_comment(std::string_view line) {
  line = io::trim(line);
  return line.empty() || line.front() == '#';
}

// Exactly N numbers; infinite ones and "nan" are among what a lost pose is written as.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(std::string_view line) {
  std::array<double, N> values{};
  for (double& value : values) {
    const std::optional<double> number = parse_number(take_word(line));
    if (!number) return {};
    value = *number;
  }
  return io::trim(line).empty() ? std::optional(values) : std::nullopt;
}

// The four lines of a matrix. Nothing when they state that tracking was lost.
std::optional<Eigen::Isometry3d> read_matrix(const Input& input, TextScanner& scanner) {
  const std::size_t begin = scanner.offset();
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    const std::size_t offset = scanner.offset();
    const auto values = numbers<4>(scanner.next_line());
    if (!values) {
      io::fail_at_line(input, offset, "four numbers of a 4 x 4 matrix are missing", kPoseRemedy);
    }
    matrix.row(row) = Eigen::Map<const Eigen::RowVector4d>(values->data());
  }
  if (!matrix.allFinite()) return {};
  const auto pose = rigid(matrix.block<3, 1>(0, 3), Eigen::Matrix3d(matrix.block<3, 3>(0, 0)));
  if (!pose)
    io::fail_at_line(input, begin, "this matrix is not a rotation and translation", kPoseRemedy);
  return pose;
}

// The pose of a line of a track, without its time; nothing where tracking was lost.
std::optional<Eigen::Isometry3d> pose_in(const Input& input, std::size_t offset,
                                         const std::array<double, 8>& line) {
  if (!std::ranges::all_of(line, [](double v) { return std::isfinite(v); })) return {};
  const auto [t, x, y, z, qx, qy, qz, qw] = line;
  auto pose = rigid({x, y, z}, Eigen::Quaterniond(qw, qx, qy, qz));
  if (pose) return pose;
  io::fail_at_line(input, offset,
                   "this quaternion's length is not 1, or the position is beyond 10^6 m",
                   kPoseRemedy);
}

PoseTrack read_track(const Input& input) {
  PoseTrack track;
  TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::size_t offset = scanner.offset();
    const std::string_view line = scanner.next_line();
    if (is_comment(line)) continue;
    const auto values = numbers<8>(line);
    if (!values || !std::isfinite(values->front())) {
      io::fail_at_line(input, offset, "this is not \"time x y z qx qy qz qw\"", kPoseRemedy);
    }
    const double stamp = values->front();
    check_seconds(input, offset, stamp);
    if (!track.empty() && stamp <= track.back().stamp) {
      io::fail_at_line(input, offset, "this time is not later than that of the previous line",
                       kPoseRemedy);
    }
    track.push_back({stamp, pose_in(input, offset, *values)});
  }
  return track;
}

PosesByOrder read_by_order(const Input& input) {
  PosesByOrder result;
  TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::size_t offset = scanner.offset();
    std::string_view line = scanner.next_line();
    if (is_comment(line)) continue;
    const auto number = io::parse_count(take_word(line));
    if (!number) io::fail_at_line(input, offset, "a frame number is missing", kPoseRemedy);
    if (const auto pose = read_matrix(input, scanner)) result.poses[*number] = *pose;
  }
  return result;
}

std::optional<std::size_t> frame_number(std::string_view comment) {
  constexpr std::string_view kFrame = "frame-";
  const std::size_t found = comment.rfind(kFrame);
  if (found == std::string_view::npos) return {};
  std::string_view rest = comment.substr(found + kFrame.size());
  return io::parse_count(take_word(rest));
}

bool names_mounting(std::string_view comment) {
  std::string lower(comment);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lower.find("depth-to-color") != std::string::npos &&
         lower.find("extrinsic") != std::string::npos;
}

PosesByNumber read_by_number(const Input& input) {
  PosesByNumber result;
  TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::string_view line = io::trim(scanner.next_line());
    if (line.empty() || line.front() != '#') continue;
    if (const auto number = frame_number(line)) {
      if (const auto pose = read_matrix(input, scanner)) result.poses[*number] = *pose;
    } else if (names_mounting(line)) {
      const std::size_t offset = scanner.offset();
      const auto mounting = read_matrix(input, scanner);
      if (!mounting) io::fail_at_line(input, offset, "this matrix is not finite", kPoseRemedy);
      result.T_posed_sensor = *mounting;
    }
  }
  return result;
}

std::string_view first_line(const Input& input) {
  TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::string_view line = scanner.next_line();
    if (!is_comment(line)) return line;
  }
  return {};
}

}  // namespace

Poses parse_poses(std::string_view text, const std::string& name) {
  const ReadOptions unused;
  const Input input{std::as_bytes(std::span(text)), name, unused};
  const std::string_view first = first_line(input);
  if (numbers<8>(first)) return read_track(input);
  if (text.find("frame-") != std::string_view::npos) return read_by_number(input);
  if (numbers<3>(first)) return read_by_order(input);
  io::fail(input, "unknown pose format",
           "Give lines \"time x y z qx qy qz qw\", or 4 x 4 matrices as in docs/sequences.md");
}

std::optional<Eigen::Isometry3d> pose_at(const PoseTrack& track, double stamp) {
  const auto next = std::ranges::lower_bound(track, stamp, {}, &StampedPose::stamp);
  if (next != track.end() && next->stamp - stamp <= kSame) return next->pose;
  if (next == track.begin()) return {};
  const StampedPose& before = *std::prev(next);
  if (stamp - before.stamp <= kSame) return before.pose;
  if (next == track.end() || next->stamp - before.stamp > kWidestGap) return {};
  if (!before.pose || !next->pose) return {};
  const double u = (stamp - before.stamp) / (next->stamp - before.stamp);
  const Eigen::Quaterniond from(before.pose->linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = from.slerp(u, Eigen::Quaterniond(next->pose->linear())).toRotationMatrix();
  pose.translation() = (1 - u) * before.pose->translation() + u * next->pose->translation();
  return pose;
}

}  // namespace palpate::sensor
