// Reads the header and the XML of E57 files: which scans there are, and how their points are
// stored.
#include "io/e57/contents.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <pugixml.hpp>
#include <string_view>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kExportAgain = "The file is damaged or no E57 file: export it again";

class E57XmlParser {
 public:
  explicit E57XmlParser(const Input& input) : input_(input) {}

  E57Contents run(const pugi::xml_node& root) const {
    E57Contents contents;
    for (const pugi::xml_node& node : root.child("data3D").children()) {
      if (node.type() == pugi::node_element) contents.scans.push_back(scan(node));
    }
    for (const pugi::xml_node& node : root.child("images2D").children()) {
      if (node.type() == pugi::node_element) ++contents.images;
    }
    return contents;
  }

 private:
  [[noreturn]] void wrong(std::string_view what, std::string_view value) const {
    fail(input_, fmt::format("its XML gives '{}' for {}", excerpt(value), what), kExportAgain);
  }

  [[nodiscard]] double real(std::string_view text, std::string_view what, double absent) const {
    text = trim(text);
    if (text.empty()) return absent;
    const std::optional<double> value = parse_number(text);
    if (!value || !std::isfinite(*value)) wrong(what, text);
    return *value;
  }

  [[nodiscard]] std::int64_t whole(std::string_view text, std::string_view what,
                                   std::int64_t absent) const {
    text = trim(text);
    if (text.empty()) return absent;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) wrong(what, text);
    return value;
  }

  [[nodiscard]] std::uint64_t count(const pugi::xml_node& node, const char* attribute) const {
    const std::string_view text = trim(node.attribute(attribute).value());
    const std::optional<std::size_t> value = parse_count(text);
    if (!value) wrong(attribute, text);
    return *value;
  }

  [[nodiscard]] E57Scan scan(const pugi::xml_node& node) const {
    E57Scan result;
    result.name = node.child("name").child_value();
    result.T_file_scan = pose(node.child("pose"));
    const pugi::xml_node points = node.child("points");
    if (!points) return result;
    result.points = count(points, "recordCount");
    result.section = E57Pages::logical_of(count(points, "fileOffset"));
    for (const pugi::xml_node& column : points.child("prototype").children()) {
      if (column.type() == pugi::node_element) result.fields.push_back(field(column));
    }
    limit_colors(result, node.child("colorLimits"));
    return result;
  }

  // An element that is there without a number is 0.
  [[nodiscard]] Eigen::Isometry3d pose(const pugi::xml_node& node) const {
    const auto number = [&](const char* part, const char* name) {
      return real(node.child(part).child(name).child_value(), name, 0);
    };
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    if (node.child("rotation")) {
      const Eigen::Quaterniond turn(number("rotation", "w"), number("rotation", "x"),
                                    number("rotation", "y"), number("rotation", "z"));
      const double length = turn.norm();
      if (!(length > 1e-6 && length < 1e6))
        wrong("the length of a quaternion", fmt::to_string(length));
      result.linear() = turn.normalized().toRotationMatrix();
    }
    result.translation() << number("translation", "x"), number("translation", "y"),
        number("translation", "z");
    return result;
  }

  [[nodiscard]] E57Field field(const pugi::xml_node& node) const {
    E57Field result;
    const std::string_view name = node.name();
    result.name = name.substr(name.find(':') + 1);  // npos + 1 is 0
    const std::string_view type = node.attribute("type").value();
    if (type == "Integer" || type == "ScaledInteger") {
      set_integer(node, result);
    } else if (type == "Float") {
      const bool single = std::string_view(node.attribute("precision").value()) == "single";
      result.kind = single ? E57Field::Kind::float32 : E57Field::Kind::float64;
      result.bits = single ? 32 : 64;
      result.black = real(node.attribute("minimum").value(), "minimum", 0);
      result.white = real(node.attribute("maximum").value(), "maximum", 1);
    }
    return result;
  }

  void set_integer(const pugi::xml_node& node, E57Field& result) const {
    using Limits = std::numeric_limits<std::int64_t>;
    result.kind = E57Field::Kind::integer;
    result.minimum = whole(node.attribute("minimum").value(), "minimum", Limits::min());
    const std::int64_t maximum = whole(node.attribute("maximum").value(), "maximum", Limits::max());
    if (maximum < result.minimum) wrong("maximum", node.attribute("maximum").value());
    result.bits = static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(maximum) -
                                                       static_cast<std::uint64_t>(result.minimum)));
    result.scale = real(node.attribute("scale").value(), "scale", 1);
    result.offset = real(node.attribute("offset").value(), "offset", 0);
    result.black = static_cast<double>(result.minimum) * result.scale + result.offset;
    result.white = static_cast<double>(maximum) * result.scale + result.offset;
  }

  // The scan's own limits of a colour replace those of the column's type. They are looked up once a
  // colour, not once a column: an XML may list a million of either.
  void limit_colors(E57Scan& scan, const pugi::xml_node& limits) const {
    for (const char* name : {"colorRed", "colorGreen", "colorBlue"}) {
      const std::string color(name);
      const pugi::xml_node least = limits.child((color + "Minimum").c_str());
      const pugi::xml_node most = limits.child((color + "Maximum").c_str());
      if (!least || !most) continue;
      const double black = real(least.child_value(), least.name(), 0);
      const double white = real(most.child_value(), most.name(), 0);
      for (E57Field& field : scan.fields) {
        if (field.name != color) continue;
        field.black = black;
        field.white = white;
      }
    }
  }

  const Input& input_;
};

// Reads the XML's bytes, whose offset and size the header states (ASTM E2807).
std::vector<std::byte> read_e57_xml(const Input& input, E57Pages& pages) {
  constexpr std::uint64_t kHeaderSize = 48;
  constexpr std::uint64_t kLongest = std::uint64_t{64}
                                     << 20U;  // bytes; a scan takes 4 kB (judgement)
  std::vector<std::byte> bytes;
  pages.read(0, kHeaderSize, bytes, "its header");
  const auto at = [&](std::size_t offset) { return load_as<std::uint64_t>(bytes.data() + offset); };
  if (const auto version = load_as<std::uint32_t>(bytes.data() + 8); version != 1) {
    fail_at_byte(input, 8, fmt::format("E57 version {} is not supported", version), kExportAgain);
  }
  if (at(40) != kE57Page) {
    fail_at_byte(input, 40, fmt::format("pages of {} bytes instead of 1024", at(40)), kExportAgain);
  }
  if (at(16) > input.bytes.size()) {
    fail_at_byte(input, input.bytes.size(),
                 fmt::format("the file ends, but should have {} bytes", at(16)),
                 "Download or copy it again");
  }
  const std::uint64_t size = at(32);
  if (size > kLongest) {
    fail_at_byte(input, 32, fmt::format("XML of {} bytes, more than 64 MiB", size), kExportAgain);
  }
  pages.read(E57Pages::logical_of(at(24)), size, bytes, "its XML");
  return bytes;
}

}  // namespace

E57Contents read_e57_contents(const Input& input, E57Pages& pages) {
  std::vector<std::byte> xml = read_e57_xml(input, pages);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(
      xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    fail(input,
         fmt::format("its XML is damaged at byte {} ({})", parsed.offset, parsed.description()),
         kExportAgain);
  }
  const pugi::xml_node root = document.child("e57Root");
  if (!root) fail(input, "its XML has no e57Root", kExportAgain);
  return E57XmlParser(input).run(root);
}

}  // namespace palpate::io
