#include "apps/palpate/report/source_report.hpp"

#include <gtest/gtest.h>

#include <array>

namespace palpate::app {
namespace {

LoadedSource fed(double rate, double prepare_ms, bool simulated) {
  LoadedSource source;
  source.feed.state.rate = rate;
  source.feed.prepare_ms = {prepare_ms, prepare_ms};
  source.feed.simulated = simulated;
  return source;
}

std::string printed(Report report) {
  std::FILE* file = std::tmpfile();
  report.print(file);
  std::rewind(file);
  std::array<char, 4096> text{};
  const std::size_t size = std::fread(text.data(), 1, text.size(), file);
  std::fclose(file);
  return {text.data(), size};
}

TEST(SourceReport, SimulatedTimeSaysWhatLiveWouldBeDropped) {
  const LoadedSource slow = fed(30, 570, true);
  const std::string text = printed(camera_report(slow));
  EXPECT_NE(text.find("preparing a frame takes 570 ms, but frames arrive every 33.3 ms: live, 95 % "
                      "would be dropped"),
            std::string::npos)
      << text;
  EXPECT_NEAR(camera_report(slow).data["would_drop_live"].get<double>(), 1 - 1 / (30 * 0.57),
              1e-12);
  const auto expect_silence = [](const LoadedSource& quick) {
    EXPECT_EQ(printed(camera_report(quick)).find("would be dropped"), std::string::npos);
    EXPECT_EQ(camera_report(quick).data["would_drop_live"], 0.0);
  };
  expect_silence(fed(30, 12, true));
  expect_silence(fed(30, 570, false));
  expect_silence(fed(0, 570, true));
  expect_silence(fed(30, 0, true));
}

TEST(SourceReport, CloudsThatComeLateAreSaidToBeClipped) {
  LoadedSource slow = fed(10, 570, true);
  slow.plan.as_cloud = true;
  const std::string text = printed(camera_report(slow));
  EXPECT_NE(
      text.find("preparing a frame takes 570 ms: live, only what tools can reach is prepared"),
      std::string::npos)
      << text;
  EXPECT_EQ(camera_report(slow).data["would_drop_live"], 0.0);
  LoadedSource live = fed(10, 20, false);
  EXPECT_EQ(printed(camera_report(live)).find("clipped"), std::string::npos);
  live.state.clipped = true;
  EXPECT_NE(printed(camera_report(live)).find("came 100 ms late"), std::string::npos);
}

TEST(SourceReport, AMeshIsToldWithWhatItIsFeltAs) {
  LoadedSource source;
  source.prepared.points_in = 400000;
  source.mesh = MeshFacts{.triangles = 12, .dropped = 3, .spacing = 4e-4};
  const Report sampled = source_report(source);
  EXPECT_NE(printed(sampled).find("mesh       of 12 triangles: felt as 400 000 points sampled from "
                                  "it, 400 um apart, 3 without an area\n"),
            std::string::npos)
      << printed(sampled);
  EXPECT_EQ(sampled.data["mesh"]["triangles"], 12);
  source.mesh->spacing = 0;
  EXPECT_NE(printed(source_report(source)).find("points, its vertices, 3 without"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::app
