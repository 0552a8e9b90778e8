// The command align: solves for poses, reports them, writes the set-up file and the picture.
#include "apps/palpate/align/align_command.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/report/report.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/align/align.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

// Draws sources before and after they were aligned, into `picture` (`path` in messages).
void draw_alignment(const LoadedScene& loaded, const std::vector<AlignedSource>& aligned,
                    const std::string& path, OutputFile& picture) {
  constexpr std::size_t kShown = 60'000;  // points of a source
  const Waiting waiting("drawing the picture");
  nlohmann::json facts = {{"sources", nlohmann::json::array()}};
  std::vector<float> rows;  // position before and after, normal after, source
  for (std::size_t s = 0; s < aligned.size(); ++s) {
    const SurfacePoints& points = *loaded.scene.source(s).points();
    const Eigen::Isometry3f moved = aligned[s].T_aligned_rough.cast<float>();
    const std::size_t stride = 1 + points.size() / kShown;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const Eigen::Vector3f p = points.origin.cast<float>() + points.grid.points()[i];
      const Eigen::Vector3f q = moved * p;
      const Eigen::Vector3f n = moved.linear() * points.normals[i];
      rows.insert(rows.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), n.x(), n.y(), n.z(),
                               static_cast<float>(s)});
    }
    facts["sources"].push_back({{"name", loaded.sources[s].plan.argument.name},
                                {"before_m", aligned[s].before.residual},
                                {"after_m", aligned[s].after.residual},
                                {"radius_m", points.radius}});
  }
  draw_by_python(align_script(), {{"cloud.f32", float_bytes(rows)}, {"facts.json", facts.dump()}},
                 path, picture);
}

constexpr double kDegrees = 180 / std::numbers::pi;

constexpr const char* kAlignFooter = R"(Examples:
  palpate align camera:simulated:left camera:simulated:right,error=0.05 --output desk.toml
  palpate align --setup rough.toml --output desk.toml --picture desk.png
  palpate align a.ply b.ply --pose b=0.1,0,0,0,0,0,1
  palpate touch --setup desk.toml

The first source stays fixed. Each other source must overlap those before it, and its pose must be
right to about 10 cm and 10 degrees: from --pose, from the set-up file or, if the cameras are close
together, from neither. The overlap must fix the pose; a bare table-top can slide along itself.
docs/cameras.md has details.

Exit codes: 0 done, 1 the input is bad or gives no reliable answer, 2 the command line is wrong.)";

std::vector<double> numbers_of(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

toml::array list_of(const std::string& text) {
  toml::array list;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) list.push_back(std::stod(part));
  return list;
}

void insert(toml::table& part, const Registration& option, const std::string& text) {
  const bool is_list = text.find(',') != std::string::npos;
  if (option.kind == KeyKind::number) {
    part.insert_or_assign(option.key(), std::stod(text));
  } else if (option.kind == KeyKind::integer) {
    part.insert_or_assign(option.key(), std::stoll(text));
  } else if (option.kind == KeyKind::flag) {
    part.insert_or_assign(option.key(), true);
  } else if (option.kind == KeyKind::numbers ||
             (option.kind == KeyKind::numbers_or_text && is_list)) {
    part.insert_or_assign(option.key(), list_of(text));
  } else {
    part.insert_or_assign(option.key(), text);
  }
}

// Options for sources on the command line override those in the file.
void insert_given(toml::table& file, toml::array& sources, const CLI::App& command) {
  CLI::App unused;
  OptionTable table(unused);
  SourcePlan any;
  add_source_options(table, any);
  for (const Registration& each : table.all()) {
    const CLI::Option* option = command.get_option_no_throw(each.name);
    if (option == nullptr || option->count() == 0) continue;
    toml::table& part = *file.insert(each.section, toml::table{}).first->second.as_table();
    insert(part, each, option->results().back());
    for (toml::node& source : sources) source.as_table()->erase(each.key());
  }
}

// The path relative to the folder of `output`, where the set-up file will be.
std::string path_from(const std::string& output, const std::string& path) {
  std::string kind;
  for (const std::string_view recorded : {kSequence, kBag}) {
    if (path.starts_with(recorded)) kind = recorded;
  }
  const std::string file = path.substr(kind.size());
  const bool is_file = path != "-" && !path.starts_with(kCamera) && !path.starts_with(kRos) &&
                       !path.starts_with(kSynthetic);
  if (!is_file) return path;
  if (fs::path(file).is_absolute()) return path;
  const fs::path folder = fs::absolute(output).parent_path();
  return kind + fs::proximate(file, folder).string();
}

// The set-up file that was read, if any, with these sources and their poses.
std::string setup_text(const CLI::App& command, const AlignOptions& options,
                       const std::vector<SourcePlan>& chosen) {
  const std::string& setup = options.touch.setup;
  toml::table file = setup.empty() ? toml::table{} : toml::parse_file(setup);
  toml::array sources;
  if (const toml::array* list = file["source"].as_array()) sources = *list;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (i >= sources.size()) sources.push_back(toml::table{});
    toml::table& source = *sources[i].as_table();
    source.insert_or_assign("name", chosen[i].argument.name);
    source.insert_or_assign("from", path_from(options.output, chosen[i].argument.path));
    toml::array pose;
    for (const double number : numbers_of(chosen[i].options.T_world_sensor)) pose.push_back(number);
    source.insert_or_assign("pose", pose);
  }
  insert_given(file, sources, command);
  file.insert_or_assign("source", sources);
  std::ostringstream text;
  text << "# Poses found by palpate align.\n" << file << "\n";
  return text.str();
}

Report report_of(const SourcePlan& source, const AlignedSource& aligned) {
  const std::string& name = source.argument.name;
  const std::vector<double> pose = numbers_of(source.options.T_world_sensor);
  Report report(name, source.argument.path);
  report.data = {{"name", name}, {"source", source.argument.path}, {"pose", pose}};
  report.row("before", "residual {before/residual_m}, {before/overlap} overlap with the others",
             aligned.before.residual, aligned.before.overlap);
  report.row("after", "residual {after/residual_m}, {after/overlap} overlap with the others",
             aligned.after.residual, aligned.after.overlap);
  const bool moves = aligned.position_deviation > 0;
  const double turned = Eigen::AngleAxisd(aligned.T_aligned_rough.linear()).angle();
  report.row("rotated", "[{?}{} degrees]", moves, fmt::format("{:.2f}", kDegrees * turned));
  report.row("sigma", "[{sigma/place_m} and {} degrees]", aligned.position_deviation,
             fmt::format("{:.3f}", kDegrees * aligned.turn_deviation));
  report.data["sigma"]["turn_rad"] = aligned.turn_deviation;
  report.row("pose", "--pose {}={}", name, fmt::format("{:.6g}", fmt::join(pose, ",")));
  return report;
}

void check_outputs(const std::string& output, const OutputPlan& others) {
  if (output.empty()) return;
  check_distinct({},
                 {{"--output", output}, {"--json", others.json}, {"--picture", others.picture}});
  std::error_code unknown;
  if (output == "-" || !fs::exists(output, unknown)) return;
  throw UsageError(fmt::format(
      "--output {} already exists and is not overwritten; name another file or remove it", output));
}

std::vector<AlignedSource> solve(const LoadedScene& loaded) {
  std::vector<RoughSource> rough;
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    rough.push_back({loaded.sources[i].plan.argument.name, loaded.scene.source(i).points()});
  }
  const Waiting waiting("aligning");
  return align(rough);
}

}  // namespace

void add_align_options(CLI::App& command, AlignOptions& options) {
  OptionTable table(command);
  OutputPlan& outputs = options.touch.plan.outputs;
  add_placed_sources(table, options.touch);
  table.under("Output");
  table.add("--output", options.output, "FILE.toml",
            "write the poses to a set-up file for 'palpate touch --setup', with all other settings "
            "of --setup and the command line; never overwrites a file");
  add_json_option(command, outputs.json)->group("Output");
  table.add("--picture", outputs.picture, "FILE.png",
            "the sources before and after alignment as PNG (needs python3-matplotlib)");
  command.footer(kAlignFooter);
  options.touch.every_source.options.policy.fit_everywhere = true;
}

void align_sources(const CLI::App& command, const AlignOptions& options) {
  const TouchPlan plan = plan_touch(command, options.touch);
  check_outputs(options.output, plan.outputs);
  std::optional<OutputFile> output = output_at(options.output);
  std::optional<OutputFile> json = output_at(plan.outputs.json);
  std::optional<OutputFile> picture = output_at(plan.outputs.picture);
  std::vector<SourcePlan> sources = plan.sources;
  require(sources.size() > 1, "align needs at least two sources; name another one");
  const LoadedScene loaded = load_sources(sources, {.explored = true});
  const std::vector<AlignedSource> aligned = solve(loaded);
  Json report = Json::array();
  std::FILE* out = options.output == "-" || plan.outputs.json == "-" ? stderr : stdout;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    Eigen::Isometry3d& pose = sources[i].options.T_world_sensor;
    pose = aligned[i].T_aligned_rough * pose;
    Report part = report_of(sources[i], aligned[i]);
    part.print(out);
    report.push_back(part.data);
  }
  write_whole(json, text_of(report));
  if (output) write_whole(output, setup_text(command, options, sources));
  if (picture) draw_alignment(loaded, aligned, plan.outputs.picture, *picture);
}

}  // namespace palpate::app
