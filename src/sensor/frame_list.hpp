#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::sensor {

struct ListedFrame {
  double stamp = 0;   // s
  std::string image;  // path relative to the list's folder
};

/// Reads a depth.txt ("time file" a line) or an associations.txt ("time file time file" a line, one
/// of them under depth/) of the TUM RGB-D benchmark.
/// @throws Error that names the line, also when times do not grow from line to line.
[[nodiscard]] std::vector<ListedFrame> parse_frame_list(std::string_view text,
                                                        const std::string& name);

}  // namespace palpate::sensor
