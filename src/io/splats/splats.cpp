// Makes a cloud of the splats of a file, and reads .splat files.
#include "io/splats/splats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/cloud_builder.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

void SplatFile::add(Splat splat, double scale) {
  const auto factor = static_cast<float>(scale);
  splat.position *= factor;
  splat.sigma *= factor;
  const Eigen::Vector4d turn = splat.rotation.coeffs().cast<double>();  // squares of floats fit
  const double length = turn.norm();
  const bool fine = is_usable(splat.position.cast<double>()) &&
                    is_usable(splat.sigma.cast<double>()) && (splat.sigma.array() >= 0).all() &&
                    std::isfinite(splat.opacity) && std::isfinite(length) && length > 0;
  if (!fine) {
    ++dropped;
    return;
  }
  splat.rotation.coeffs() = (turn / length).cast<float>();
  splat.opacity = std::clamp(splat.opacity, 0.F, 1.F);
  splats.push_back(splat);
}

std::uint8_t byte_of(double share) {
  if (!(share > 0)) return 0;  // and for NaN
  return static_cast<std::uint8_t>(std::lround(255 * std::min(share, 1.)));
}

std::array<std::uint8_t, 3> color_of(const Eigen::Vector3d& coefficients) {
  constexpr double kConstantHarmonic = 0.28209479177387814;  // 1 / (2 sqrt(pi))
  std::array<std::uint8_t, 3> color{};
  for (std::size_t k = 0; k < 3; ++k) {
    color[k] = byte_of(0.5 + kConstantHarmonic * coefficients[static_cast<Eigen::Index>(k)]);
  }
  return color;
}

Eigen::Vector4f with_largest(std::size_t largest, const Eigen::Vector3f& others) {
  Eigen::Vector4f all;
  for (std::size_t k = 0, next = 0; k < 4; ++k) {
    all[static_cast<Eigen::Index>(k)] = k == largest
                                            ? std::sqrt(std::max(0.F, 1 - others.squaredNorm()))
                                            : others[static_cast<Eigen::Index>(next++)];
  }
  return all;
}

namespace {

// Puts the origin where a reader of the same points would put it.
void move_origin(PointCloud& cloud) {
  cloud.origin = choose_origin(cloud.size(), [&](std::size_t i) { return cloud.point(i); });
  for (Eigen::Vector3f& p : cloud.positions) {
    p = (p.cast<double>() - cloud.origin).cast<float>();
  }
}

}  // namespace

CloudFile shell_file(const Input& input, SplatFile (*read)(const Input&)) {
  constexpr double kReading = 0.3;  // of the time, about (measured)
  if (input.unit.plan != input.unit.height) {
    fail(input, "splats have one unit along all axes", "Give one scale for x, y and z");
  }
  ReadOptions part = input.options;
  const auto& report = input.options.progress;
  if (report) part.progress = [&](double done) { report(kReading * done); };
  SplatFile rows =
      read({.bytes = input.bytes, .name = input.name, .options = part, .unit = input.unit});
  check_not_empty(input, rows.splats.size(), rows.dropped);
  SplatShell shell = shell_of(rows.splats, [&](double done) {
    if (report) report(kReading + (1 - kReading) * done);
  });
  if (shell.cloud.empty()) {
    fail(input, "no splat of this scene is opaque, or all are too small a group for a surface",
         "Check how it was trained and exported");
  }
  CloudFile file;
  file.cloud = std::move(shell.cloud);
  move_origin(file.cloud);
  file.format = std::move(rows.format);
  file.unit = input.unit;
  file.declared = rows.splats.size() + rows.dropped;
  file.dropped = rows.dropped;
  file.splats = {.visible = shell.visible,
                 .spacing = shell.spacing,
                 .without_normal = shell.without_normal,
                 .far = shell.far,
                 .huge = shell.huge,
                 .pieces = shell.pieces};
  return file;
}

SplatFile read_dot_splat(const Input& input) {
  constexpr std::size_t kRow = 32;  // bytes (format)
  if (input.bytes.size() % kRow != 0) {
    fail(input, fmt::format("{} bytes are no whole number of 32-byte splats", input.bytes.size()),
         "Download or export it again");
  }
  SplatFile file{.format = ".splat"};
  file.splats.reserve(input.bytes.size() / kRow);
  Progress progress(input.options, input.bytes.size());
  for (std::size_t at = 0; at < input.bytes.size(); at += kRow) {
    const std::byte* row = input.bytes.data() + at;
    const auto number = [&](std::size_t k) { return load_as<float>(row + 4 * k); };
    const auto byte = [&](std::size_t k) { return std::to_integer<std::uint8_t>(row[24 + k]); };
    // Writers cut 128 + 128 x down to a whole number: half a step is added back.
    const auto turn = [&](std::size_t k) { return static_cast<float>(byte(4 + k)) - 127.5F; };
    file.add({.position = {number(0), number(1), number(2)},
              .sigma = {number(3), number(4), number(5)},
              .rotation = {turn(0), turn(1), turn(2), turn(3)},
              .opacity = static_cast<float>(byte(3)) / 255,
              .color = {byte(0), byte(1), byte(2)}},
             input.unit.plan);
    progress.at(at);
  }
  return file;
}

}  // namespace palpate::io
