// Writes and reads tile.json, which says how far a store has come.
#include "io/tile/state.hpp"

#include <nlohmann/json.hpp>

#include "io/file_bytes.hpp"
#include "io/tile/out_file.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;

json json_of(const Range& range) {
  return {range.low, range.high};
}

Range range_of(const json& data) {
  return {data.at(0), data.at(1)};
}

json json_of(const Job& job) {
  json inputs = json::array();
  for (const NamedInput& each : job.inputs) {
    inputs.push_back({{"name", each.name}, {"bytes", each.bytes}, {"changed", each.changed}});
  }
  return {{"inputs", inputs},
          {"scale", job.scale},
          {"chunk_points", job.chunk_points},
          {"leaf_points", job.leaf_points}};
}

Job job_of(const json& data) {
  Job job{{}, data.at("scale"), data.at("chunk_points"), data.at("leaf_points")};
  for (const json& each : data.at("inputs")) {
    job.inputs.push_back({each.at("name"), each.at("bytes"), each.at("changed")});
  }
  return job;
}

json json_of(const Plan& plan) {
  const Eigen::Vector3d& lower = plan.frame.lower;
  json chunks = json::array();
  for (const Chunk& chunk : plan.chunks) {
    const Numbers& at = chunk.cell.at;
    chunks.push_back({chunk.cell.level, at[0], at[1], at[2], chunk.points});
  }
  return {{"step", plan.frame.step},
          {"lower", {lower.x(), lower.y(), lower.z()}},
          {"bits", plan.frame.bits},
          {"intensities", plan.layout.intensities},
          {"colors", plan.layout.colors},
          {"points", plan.points},
          {"dropped", plan.dropped},
          {"lowest", plan.lowest},
          {"highest", plan.highest},
          {"intensity", json_of(plan.intensity)},
          {"color", {json_of(plan.color[0]), json_of(plan.color[1]), json_of(plan.color[2])}},
          {"color_factors", plan.color_factors},
          {"chunks", chunks}};
}

Plan plan_of(const json& data) {
  Plan plan;
  plan.frame.step = data.at("step");
  for (int k = 0; k < 3; ++k) plan.frame.lower[k] = data.at("lower").at(static_cast<unsigned>(k));
  plan.frame.bits = data.at("bits");
  plan.layout = {data.at("intensities"), data.at("colors")};
  plan.points = data.at("points");
  plan.dropped = data.at("dropped");
  plan.lowest = data.at("lowest");
  plan.highest = data.at("highest");
  plan.intensity = range_of(data.at("intensity"));
  for (std::size_t k = 0; k < 3; ++k) plan.color[k] = range_of(data.at("color").at(k));
  plan.color_factors = data.at("color_factors").get<std::vector<std::uint16_t>>();
  for (const json& chunk : data.at("chunks")) {
    plan.chunks.push_back({{chunk.at(0), {chunk.at(1), chunk.at(2), chunk.at(3)}}, chunk.at(4)});
  }
  return plan;
}

}  // namespace

void save(const State& state, const std::filesystem::path& path) {
  const json data = {{"version", kVersion},         {"job", json_of(state.job)},
                     {"plan", json_of(state.plan)}, {"distributed", state.distributed},
                     {"chunks_done", state.chunks}, {"octree_bytes", state.octree},
                     {"nodes_bytes", state.nodes},  {"roots_bytes", state.roots},
                     {"finished", state.finished}};
  const std::string text = data.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
  write_file(path, std::as_bytes(std::span(text)));
}

std::optional<State> load_state(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const Bytes bytes = read_bytes(path);
  const auto* begin = reinterpret_cast<const char*>(bytes.span().data());
  try {
    const json data = json::parse(begin, begin + bytes.size());
    if (data.at("version") != kVersion) throw Error("of another version");
    State state{job_of(data.at("job")), plan_of(data.at("plan")),
                data.at("distributed").get<bool>()};
    state.chunks = data.at("chunks_done");
    state.octree = data.at("octree_bytes");
    state.nodes = data.at("nodes_bytes");
    state.roots = data.at("roots_bytes");
    state.finished = data.at("finished");
    return state;
  } catch (const std::exception& error) {
    throw Error(path.string() + ": is not what palpate wrote there (" + error.what() +
                "). Start anew with --force.");
  }
}

}  // namespace palpate::io::tile
