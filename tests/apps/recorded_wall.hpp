#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "apps/program.hpp"

namespace palpate::app {

// A wall 0.5 m ahead, 64 x 48 pixels, with one pixel that tells the frames apart.
inline std::string wall_pgm(int number) {
  std::string text = "P5 64 48 65535\n";
  for (int i = 0; i < 64 * 48; ++i) {
    const int depth = i == 0 ? 500 + number : 500;
    text += static_cast<char>(depth / 256);
    text += static_cast<char>(depth % 256);
  }
  return text;
}

// Writes a sequence of 30 frames a second into the folder "wall".
inline void write_wall(const Shell& shell, int frames) {
  std::filesystem::create_directory(shell.path("wall"));
  for (int i = 0; i < frames; ++i) shell.write(fmt::format("wall/{:03}.pgm", i), wall_pgm(i));
  shell.write("wall/sequence.json",
              R"({"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5,
                  "depth_unit_m": 0.001, "fps": 30})");
}

// Forward until the hand is 4 mm deep in the wall, and then at rest.
inline std::string into_wall(int steps) {
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < steps; ++i) {
    way += fmt::format("{},0,0,{}\n", 1e-3 * i, std::min(0.504, 0.48 + 1e-4 * i));
  }
  return way;
}

}  // namespace palpate::app
