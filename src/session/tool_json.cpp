// Writes tools as JSON and reads them.
#include "session/tool_json.hpp"

#include <utility>
#include <vector>

#include "session/json_numbers.hpp"

namespace palpate::session {
namespace {

constexpr int kNoSide = 2;  // no tool has a sample of it

int side_in(double number) {
  if (number == 1 || number == -1 || number == 0) return static_cast<int>(number);
  return kNoSide;
}

Eigen::Vector3d vector_in(const Json& row) {
  return {number_in(row.at(0)), number_in(row.at(1)), number_in(row.at(2))};
}

}  // namespace

Json tool_json(const Tool& tool) {
  const Eigen::Vector3d& axis = tool.axis();
  Json samples = Json::array();
  for (const auto& [at, radius, side] : tool.samples()) {
    samples.push_back({at.x(), at.y(), at.z(), radius, side});
  }
  return {{"axis", {axis.x(), axis.y(), axis.z()}}, {"samples", std::move(samples)}};
}

std::shared_ptr<const Tool> tool_in(const Json& json) {
  if (json.is_null()) return nullptr;
  std::vector<Tool::Point> samples;
  for (const Json& row : json.at("samples")) {
    samples.push_back({vector_in(row), number_in(row.at(3)), side_in(number_in(row.at(4)))});
  }
  return std::make_shared<const Tool>(std::move(samples), vector_in(json.at("axis")));
}

}  // namespace palpate::session
