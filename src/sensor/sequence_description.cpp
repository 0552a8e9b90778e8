// Parses sequence.json, which describes a folder of depth images.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palpate/base/error.hpp"
#include "sensor/pose_track.hpp"
#include "sensor/sequence.hpp"

namespace palpate::sensor {
namespace {

using nlohmann::json;

constexpr int kWidest = 65536;      // pixels (judgement)
constexpr double kLargestUnit = 1;  // m a step (judgement)
constexpr double kFastest = 1e5;    // Hz (judgement)

constexpr std::array<std::string_view, 18> kFields{"width",
                                                   "height",
                                                   "fx",
                                                   "fy",
                                                   "cx",
                                                   "cy",
                                                   "distortion",
                                                   "depth_unit_m",
                                                   "fps",
                                                   "invalid",
                                                   "images",
                                                   "frames",
                                                   "stamps",
                                                   "pose",
                                                   "pose_direction",
                                                   "T_pose_camera",
                                                   "byte_order",
                                                   "static_camera"};

constexpr std::array<const char*, 5> kLens{"fx", "fy", "cx", "cy", "distortion"};

// The fields of one JSON object, by name.
class Fields {
 public:
  Fields(const json& object, std::string name) : object_(object), name_(std::move(name)) {}

  [[noreturn]] void fail(std::string_view field, std::string_view wanted) const {
    const auto found = object_.find(field);
    throw Error(fmt::format("{}: \"{}\" {}. Give {}.", name_, field,
                            found == object_.end() ? "is missing" : "is " + excerpt_of(*found),
                            wanted));
  }

  [[nodiscard]] const json* find(std::string_view field) const {
    const auto found = object_.find(field);
    return found == object_.end() ? nullptr : &*found;
  }

  [[nodiscard]] double number(std::string_view field, double least, double most,
                              std::string_view wanted) const {
    const json* value = find(field);
    const double number = value != nullptr && value->is_number() ? value->get<double>() : NAN;
    if (!(number >= least && number <= most)) fail(field, wanted);
    return number;
  }
  [[nodiscard]] double number(std::string_view field, double least, double most,
                              std::string_view wanted, double otherwise) const {
    return find(field) == nullptr ? otherwise : number(field, least, most, wanted);
  }

  [[nodiscard]] std::string text(std::string_view field, std::string_view wanted) const {
    const json* value = find(field);
    if (value == nullptr) return {};
    if (!value->is_string()) fail(field, wanted);
    return value->get<std::string>();
  }

  [[nodiscard]] std::vector<double> numbers(std::string_view field, std::string_view wanted) const {
    const json* value = find(field);
    if (value == nullptr) return {};
    if (!value->is_array()) fail(field, wanted);
    std::vector<double> numbers;
    for (const json& element : *value) {
      if (!element.is_number() || !std::isfinite(element.get<double>())) fail(field, wanted);
      numbers.push_back(element.get<double>());
    }
    return numbers;
  }

 private:
  static std::string excerpt_of(const json& value) {
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    constexpr std::size_t kLongest = 60;
    if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
    return text;
  }

  const json& object_;
  std::string name_;
};

json parse(std::string_view text, const std::string& name) {
  json document;
  try {
    document = json::parse(text.begin(), text.end());
  } catch (const json::exception& error) {
    throw Error(fmt::format("{}: not valid JSON ({}). Correct it there.", name, error.what()));
  }
  if (!document.is_object()) {
    throw Error(fmt::format("{}: not an object. Give {{\"fx\": ..., \"fy\": ..., ...}}.", name));
  }
  return document;
}

// An unknown field is a slip of the pen more often than not.
void check_names(const json& document, const std::string& name) {
  for (const auto& [field, value] : document.items()) {
    if (std::ranges::find(kFields, field) != kFields.end() || field.ends_with("note")) continue;
    throw Error(fmt::format(
        "{}: unknown field \"{:.40}\". Fields are {}, and any whose name ends in \"note\".", name,
        field, fmt::join(kFields, ", ")));
  }
}

CameraModel camera_of(const Fields& fields) {
  constexpr double kFar = 1e6;  // pixels
  CameraModel camera;
  camera.width = static_cast<int>(fields.number("width", 1, kWidest, "pixels", 0));
  camera.height = static_cast<int>(fields.number("height", 1, kWidest, "pixels", 0));
  const auto given = [&](const char* field) { return fields.find(field) != nullptr; };
  if (std::ranges::none_of(kLens, given)) return camera;
  constexpr std::string_view kFocal = "the focal length in pixels";
  constexpr std::string_view kCentre = "the principal point in pixels";
  camera.pinhole.fx = fields.number("fx", 1e-3, kFar, kFocal);
  camera.pinhole.fy = fields.number("fy", 1e-3, kFar, kFocal);
  camera.pinhole.cx = fields.number("cx", -kFar, kFar, kCentre);
  camera.pinhole.cy = fields.number("cy", -kFar, kFar, kCentre);
  constexpr std::string_view kWanted =
      "[k1, k2, p1, p2, k3] (Brown-Conrady); trailing zeros are optional";
  std::vector<double> k = fields.numbers("distortion", kWanted);
  if (k.size() > 5) fields.fail("distortion", kWanted);
  k.resize(5);
  camera.distortion = {.k1 = k[0], .k2 = k[1], .p1 = k[2], .p2 = k[3], .k3 = k[4]};
  return camera;
}

std::vector<std::uint16_t> invalid_of(const Fields& fields) {
  constexpr std::string_view kWanted = "a list of values from 0 to 65535";
  std::vector<std::uint16_t> invalid;
  for (const double value : fields.numbers("invalid", kWanted)) {
    if (!(value >= 0 && value <= 65535 && value == std::floor(value))) {
      fields.fail("invalid", kWanted);
    }
    if (value != 0 && value != 65535) invalid.push_back(static_cast<std::uint16_t>(value));
  }
  return invalid;
}

// Reads one of two words: true for the second, false for the first or if absent.
bool second_of(const Fields& fields, std::string_view field, std::string_view first,
               std::string_view second) {
  const std::string wanted = fmt::format("\"{}\" or \"{}\"", first, second);
  const std::string word = fields.text(field, wanted);
  if (!word.empty() && word != first && word != second) fields.fail(field, wanted);
  return word == second;
}

// The name of a file, up to the remark that may follow behind a blank or a colon.
std::string file_of(const Fields& fields, std::string_view field) {
  const std::string text = fields.text(field, "the name of a file in the same folder");
  return text.substr(0, text.find_first_of(" :\t\n"));
}

Eigen::Isometry3d mounting_of(const Fields& fields) {
  constexpr std::string_view kWanted =
      "[x, y, z, qx, qy, qz, qw] with metres and a unit quaternion";
  const std::vector<double> v = fields.numbers("T_pose_camera", kWanted);
  if (v.empty() && fields.find("T_pose_camera") == nullptr) return Eigen::Isometry3d::Identity();
  if (v.size() != 7) fields.fail("T_pose_camera", kWanted);
  const auto pose = rigid({v[0], v[1], v[2]}, Eigen::Quaterniond(v[6], v[3], v[4], v[5]));
  if (!pose) fields.fail("T_pose_camera", kWanted);
  return *pose;
}

}  // namespace

SequenceDescription parse_description(std::string_view text, const std::string& name) {
  const json document = parse(text, name);
  check_names(document, name);
  const Fields fields(document, name);
  SequenceDescription sequence;
  sequence.camera = camera_of(fields);
  sequence.depth_unit = fields.number("depth_unit_m", 1e-9, kLargestUnit,
                                      "the metres per depth unit, e.g. 0.001", 1e-3);
  sequence.invalid = invalid_of(fields);
  sequence.swapped = second_of(fields, "byte_order", "big", "little");
  if (fields.find("fps") != nullptr) {
    sequence.rate = fields.number("fps", 1e-3, kFastest, "frames per second");
  }
  sequence.images = fields.text("images", "the name of a folder in the same folder");
  sequence.frames = file_of(fields, "frames");
  sequence.stamps = fields.numbers("stamps", "a list of times in seconds, one per image");
  sequence.poses = file_of(fields, "pose");
  sequence.world_to_camera =
      second_of(fields, "pose_direction", "camera_to_world", "world_to_camera");
  sequence.T_posed_sensor = mounting_of(fields);
  return sequence;
}

}  // namespace palpate::sensor
