#include <fmt/format.h>

#include <iterator>
#include <numbers>
#include <thread>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/paper/paper_command.hpp"

namespace palpate::app {

namespace {

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

std::string label(const Press& press) {
  return press.clouds == 0 ? press.name : fmt::format("{} N = {}", press.name, press.clouds);
}

// Of a column of the log.
std::string key(const Press& press) {
  return press.clouds == 0 ? press.name : fmt::format("{}_{}", press.name, press.clouds);
}

const char* radius_text(const Fig7& figure) {
  return figure.radius_given ? "R given" : "R = 2.5 s";
}

}  // namespace

void print_figure(const Fig5& figure, const std::string& source, std::FILE* out) {
  const Style style(out);
  fmt::print(out,
             "{} preparation of clouds in ms: paper (Core i7-950, 2012) and here ({} cores, "
             "fastest run)\n",
             style.heading("fig 5"), std::thread::hardware_concurrency());
  fmt::print(out, "{:>8} {:>8} {:>8}   {:^15}   {:^15}   {:^15}   {:^17}\n", "points", "here",
             "voxel", "index", "normals", "spacing", "sum");
  fmt::print(out, "{:>8} {:>8} {:>8}   {:>7} {:>7}   {:>7} {:>7}   {:>7} {:>7}   {:>7} {:>9}\n", "",
             "", "", "paper", "here", "paper", "here", "paper", "here", "paper", "here");
  for (const Fig5Row& row : figure.rows) {
    fmt::print(out,
               "{:>8} {:>8} {:>8}   {:>7.4g} {:>7.3g}   {:>7.4g} {:>7.3g}   {:>7.4g} {:>7.3g}   "
               "{:>7.4g} {:>7.3g} x{:<.0f}\n",
               row.points, row.points_here, length(row.voxel), row.paper.index, row.here.index,
               row.paper.normals, row.here.normals, row.paper.spacing, row.here.spacing,
               row.paper.sum(), row.here.sum(), row.paper.sum() / row.here.sum());
  }
  fmt::print(
      out,
      "points from {} ({} pixels with depth), reduced to the paper's sizes by a voxel filter\n",
      source, grouped(figure.pixels));
  fmt::print(out,
             "the whole frame as a depth stream, filtered and touchable everywhere: {:.3g} ms of "
             "computation\n",
             figure.everywhere);
}

void print_figure(const Fig7& figure, const std::string& source, std::FILE* out) {
  const Style style(out);
  fmt::print(
      out, "{} hand pressed into {}: {} from the camera, viewing angle {:.0f} degrees; {} frames\n",
      style.heading("fig 7"), source, length(figure.depth), degrees(figure.angle), figure.frames);
  fmt::print(out, "{:<18} {:>9} {:>11} {:>9} {:>9} {:>12} {:>8}\n", "", "R", "height, sd",
             "n_x, sd", "n_y, sd", "force step", "contact");
  for (const Press& press : figure.presses) {
    fmt::print(out, "{:<18} {:>9} {:>11} {:>7.2f} ° {:>7.2f} ° {:>10.3f} N {:>6.0f} %\n",
               label(press), length(press.radius), length(press.height_sd), degrees(press.nx_sd),
               degrees(press.ny_sd), press.jump, 100 * press.touching);
  }
  fmt::print(out,
             "metaball and point-set as in the paper: T = 0.5, {}, voxels of {}, N clouds, hard "
             "swap\nnormals of the field at the proxy: n_x along the view, n_y across; force step: "
             "largest change per servo step\n",
             radius_text(figure), length(figure.voxel));
}

std::string csv(const Fig5& figure) {
  std::string text =
      "points,points_here,voxel_m,paper_index_ms,index_ms,paper_normals_ms,normals_ms,"
      "paper_spacing_ms,spacing_ms,weights_ms\n";
  for (const Fig5Row& row : figure.rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", row.points, row.points_here, row.voxel,
                        row.paper.index, row.here.index, row.paper.normals, row.here.normals,
                        row.paper.spacing, row.here.spacing, row.weights);
  }
  return text;
}

std::string csv(const Fig7& figure) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "t");
  for (const Press& press : figure.presses) {
    fmt::format_to(out, ",{0}_height,{0}_nx,{0}_ny,{0}_force", key(press));
  }
  fmt::format_to(out, "\n");
  for (std::size_t i = 0; i < figure.times.size(); ++i) {
    fmt::format_to(out, "{:.3f}", figure.times[i]);
    for (const Press& press : figure.presses) {
      const PressSample& s = press.samples[i];
      fmt::format_to(out, ",{:.7g},{:.6g},{:.6g},{:.5g}", s.height, s.nx, s.ny, s.force);
    }
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

std::string facts(const Fig5& figure, const std::string& source) {
  Json rows = Json::array();
  for (const Fig5Row& row : figure.rows) {
    const auto times = [](const PrepareTimes& t) { return Json{t.index, t.normals, t.spacing}; };
    rows.push_back({{"points", row.points},
                    {"points_here", row.points_here},
                    {"paper_ms", times(row.paper)},
                    {"here_ms", times(row.here)}});
  }
  return Json{{"figure", "fig5"},
              {"source", source},
              {"cores", std::thread::hardware_concurrency()},
              {"everywhere_ms", figure.everywhere},
              {"rows", rows}}
      .dump();
}

std::string facts(const Fig7& figure, const std::string& source) {
  Json presses = Json::array();
  for (const Press& press : figure.presses) {
    presses.push_back({{"name", press.name},
                       {"clouds", press.clouds},
                       {"key", key(press)},
                       {"radius_m", press.radius},
                       {"height_sd_m", press.height_sd},
                       {"nx_sd_degrees", degrees(press.nx_sd)},
                       {"ny_sd_degrees", degrees(press.ny_sd)},
                       {"jump_N", press.jump}});
  }
  return Json{{"figure", "fig7"},        {"source", source},
              {"depth_m", figure.depth}, {"angle_degrees", degrees(figure.angle)},
              {"voxel_m", figure.voxel}, {"radius", radius_text(figure)},
              {"presses", presses}}
      .dump();
}

}  // namespace palpate::app
