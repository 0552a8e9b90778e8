#include "viewer/tool_names.hpp"

#include <fmt/core.h>

#include <map>

namespace palpate::viewer {

std::vector<std::string> tool_names(const std::vector<Servo*>& servos) {
  std::map<std::string, int> count;
  for (const Servo* servo : servos) ++count[servo->device().info().name];
  std::map<std::string, int> seen;
  std::vector<std::string> names;
  for (const Servo* servo : servos) {
    const std::string& name = servo->device().info().name;
    names.push_back(count[name] == 1 ? name : fmt::format("{} {}", name, ++seen[name]));
  }
  return names;
}

}  // namespace palpate::viewer
