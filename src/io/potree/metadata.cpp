// Reads the metadata.json of a Potree store.
#include "io/potree/metadata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace palpate::io::potree {
namespace {

using nlohmann::json;

constexpr std::string_view kMakeAgain = "Make the store again, for example with PotreeConverter 2";

// Names of the types, in the order of NumberType (format).
constexpr std::array<std::string_view, 10> kTypes{"int8",   "uint8", "int16",  "uint16", "int32",
                                                  "uint32", "int64", "uint64", "float",  "double"};

// Bytes of an attribute of a packed point (format): interleaved bits in words of 64.
constexpr std::size_t kPackedPosition = 16;
constexpr std::size_t kPackedColor = 8;

// Bytes of a point; a LAS file, from which most stores are made, has no larger ones.
constexpr std::size_t kLargestPoint = 65535;

class MetadataReader {
 public:
  explicit MetadataReader(const Input& input) : input_(input) {
    try {
      root_ = json::parse(input.text());
    } catch (const json::exception&) {
      fail(input, "its JSON is broken", "Copy it again");
    }
  }

  Metadata run() {
    check_version();
    metadata_.points = whole("points");
    metadata_.first_chunk = whole("hierarchy/firstChunkSize");
    metadata_.offset = vector("offset");
    metadata_.scale = vector("scale");
    metadata_.spacing = number("spacing");
    const json* projection = find("projection");
    if (projection != nullptr && projection->is_string())
      metadata_.projection = projection->get<std::string>();
    if (!(metadata_.scale.minCoeff() > 0)) wrong("scale must be above zero");
    read_cube();
    read_encoding();
    read_attributes();
    return metadata_;
  }

 private:
  void check_version() const {
    const std::string version = text("version");
    if (version == "2.0") return;
    fail(input_, fmt::format("version \"{}\" of Potree is not read, only 2.0", excerpt(version)),
         "Convert the original cloud with PotreeConverter 2");
  }

  void read_cube() {
    constexpr double kLeastShare = 1e-9;  // spacing: 2^30 points side by side (judgement)
    constexpr double kTolerance = 1e-3;   // of an edge, for writers that round (judgement)
    metadata_.lower = vector("boundingBox/min");
    const Eigen::Vector3d size = vector("boundingBox/max") - metadata_.lower;
    metadata_.edge = size.maxCoeff();
    const bool possible = std::isfinite(metadata_.edge) && metadata_.edge > 0;
    if (!possible || size.minCoeff() < (1 - kTolerance) * metadata_.edge) {
      wrong("the boundingBox is no cube");
    }
    const double share = metadata_.spacing / metadata_.edge;
    if (!(share >= kLeastShare && share <= 1)) {
      wrong(fmt::format("a spacing of {} in a cube of {}", metadata_.spacing, metadata_.edge));
    }
  }

  void read_encoding() {
    const std::string encoding = find("encoding") == nullptr ? "DEFAULT" : text("encoding");
    metadata_.packed = encoding == "BROTLI";
    if (metadata_.packed || encoding == "DEFAULT") return;
    fail(input_, fmt::format("encoding \"{}\" is not known (DEFAULT, BROTLI)", excerpt(encoding)),
         "Convert the original cloud with PotreeConverter 2");
  }

  void read_attributes() {
    const json* list = find("attributes");
    const std::size_t count = list != nullptr && list->is_array() ? list->size() : 0;
    bool has_position = false;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string path = fmt::format("attributes/{}/", i);
      const std::string name = lower_case(text(path + "name"));
      const std::size_t numbers = whole(path + "numElements");
      Attribute attribute = read_attribute(path, numbers);
      if (name == "position") {
        expect(name, attribute, numbers, NumberType::int32);
        if (metadata_.packed) attribute.bytes = kPackedPosition;
        metadata_.position = attribute;
        has_position = true;
      } else if (name == "rgb") {
        expect(name, attribute, numbers, NumberType::uint16);
        if (metadata_.packed) attribute.bytes = kPackedColor;
        metadata_.color = attribute;
      } else if (name == "intensity" && numbers == 1) {
        metadata_.intensity = attribute;
      }
      metadata_.point_size += attribute.bytes;
      if (metadata_.point_size > kLargestPoint) wrong("a point takes more than 65535 bytes");
    }
    if (!has_position) wrong("no attribute \"position\"");
  }

  Attribute read_attribute(const std::string& path, std::size_t numbers) const {
    const std::string type = text(path + "type");
    const auto found_type = std::ranges::find(kTypes, type);
    if (found_type == kTypes.end()) wrong(fmt::format("type \"{}\" is not known", excerpt(type)));
    Attribute attribute;
    attribute.type = static_cast<NumberType>(found_type - kTypes.begin());
    attribute.offset = metadata_.point_size;
    attribute.bytes = whole(path + "size");
    if (numbers > kLargestPoint || attribute.bytes != numbers * size_of(attribute.type)) {
      wrong(fmt::format("{}size does not fit numElements and type", path));
    }
    for (std::size_t k = 0; k < std::min<std::size_t>(numbers, 3); ++k) {
      const json* most = find(fmt::format("{}max/{}", path, k));
      if (most == nullptr || !most->is_number()) continue;
      attribute.largest = std::max(attribute.largest, most->get<double>());
    }
    return attribute;
  }

  // Positions and colours are three numbers of one type; the packing supports no other.
  void expect(const std::string& name, const Attribute& attribute, std::size_t numbers,
              NumberType type) const {
    if (attribute.type == type && numbers == 3) return;
    const auto called = [](NumberType each) { return kTypes[static_cast<std::size_t>(each)]; };
    wrong(fmt::format("\"{}\" has {} numbers of type {} in place of 3 of type {}", name, numbers,
                      called(attribute.type), called(type)));
  }

  // Null: nothing is at this path, such as "boundingBox/min/0".
  [[nodiscard]] const json* find(const std::string& path) const {
    const json::json_pointer pointer("/" + path);
    return root_.contains(pointer) ? &root_.at(pointer) : nullptr;
  }

  [[nodiscard]] std::string text(const std::string& path) const {
    const json* found = find(path);
    if (found == nullptr || !found->is_string()) wrong(fmt::format("no text at {}", path));
    return found->get<std::string>();
  }

  [[nodiscard]] double number(const std::string& path) const {
    const json* found = find(path);
    if (found == nullptr || !found->is_number()) wrong(fmt::format("no number at {}", path));
    return found->get<double>();
  }

  [[nodiscard]] std::size_t whole(const std::string& path) const {
    constexpr double kMost = 9007199254740992.0;  // 2^53: a double counts up to there
    const double value = number(path);
    if (!(value >= 0 && value <= kMost && value == std::floor(value))) {
      wrong(fmt::format("{} at {} is no count", value, path));
    }
    return static_cast<std::size_t>(value);
  }

  [[nodiscard]] Eigen::Vector3d vector(const std::string& path) const {
    return {number(path + "/0"), number(path + "/1"), number(path + "/2")};
  }

  [[noreturn]] void wrong(std::string_view what) const { fail(input_, what, kMakeAgain); }

  const Input& input_;
  json root_;
  Metadata metadata_;
};

}  // namespace

Metadata read_metadata(const Input& input) {
  return MetadataReader(input).run();
}

}  // namespace palpate::io::potree
