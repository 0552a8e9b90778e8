#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "support/effort.hpp"

// A real depth camera before a flat cabinet side, whose frames jump by 9 mm and back.

namespace palpate::app {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

// The panel by least squares over all frames, in the camera's frame.
const Vector3d kPoint(-0.18719, -0.30590, 0.79629);
const Vector3d kNormal(-0.2206, 0.4419, -0.8695);

fs::path recording() {
  const char* const data = std::getenv("PALPATE_DATA");
  const fs::path folder = data == nullptr ? "" : fs::path(data) / "cases/depth/panel_d435";
  return fs::exists(folder / "frames.json") ? folder : "";
}

// Its twelve different frames in the order in which they came.
void write_sequence(const fs::path& from, Shell& shell) {
  std::ifstream file(from / "frames.json");
  Json description = Json::parse(file);
  const fs::path to = shell.path("panel");
  fs::create_directories(to / "depth");
  int number = 0;
  for (const int frame : description["order"]) {
    fs::copy_file(from / "frames" / fmt::format("{:02d}.png", frame),
                  to / "depth" / fmt::format("{:05d}.png", number++));
  }
  description.erase("order");
  shell.write("panel/sequence.json", description.dump());
}

TEST(RealPanel, HoldsThePressedHandAndNoneInFreeAir) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  const fs::path from = recording();
  if (from.empty()) GTEST_SKIP() << "PALPATE_DATA has no cases/depth/panel_d435";
  Shell shell;
  write_sequence(from, shell);
  const Outcome outcome =
      shell.run("touch sequence:panel --loop --simulated-time --log log.csv --trajectory " +
                (from / "hand.csv").string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto log = columns(shell.read("log.csv"));
  const auto vector = [&](const std::array<const char*, 3>& names, std::size_t row) {
    Vector3d v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = number(log.at(names[axis])[row]);
    return v;
  };
  int pressed = 0;
  int lost = 0;
  double most = 0;
  for (std::size_t row = 0; row < log.at("t").size(); ++row) {
    const double force = vector({"fx", "fy", "fz"}, row).norm();
    const double height = (vector({"hip_x", "hip_y", "hip_z"}, row) - kPoint).dot(kNormal);
    if (height > 6e-3) most = std::max(most, force);
    if (height > -1.5e-3) continue;
    ++pressed;
    if (force < 0.2 * 1.5) ++lost;
  }
  EXPECT_LT(most, 0.05) << "N, in front";
  EXPECT_GT(pressed, 4000);
  EXPECT_LT(lost, 0.005 * pressed);
}

}  // namespace
}  // namespace palpate::app
