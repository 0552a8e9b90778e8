// Reads in what a LAS file's coordinates are: its GeoTIFF keys and its well-known text (WKT).
#include "io/las_coordinates.hpp"

#include <cmath>
#include <optional>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kProjection = "LASF_Projection";

// Records, keys and values of the ASPRS and GeoTIFF specifications.
constexpr int kGeoKeys = 34735;
constexpr int kWkt = 2112;
constexpr unsigned kModelType = 1024;
constexpr unsigned kGeographic = 2;
constexpr unsigned kLinearUnits = 3076;
constexpr unsigned kMetre = 9001;
constexpr unsigned kFoot = 9002;
constexpr unsigned kSurveyFoot = 9003;

constexpr double kFootLength = 0.3048;  // m (definition)
constexpr double kSameUnit = 1e-5;      // share; the US survey foot is 2e-6 longer (definition)

// The value of a GeoTIFF key that is a whole number.
std::optional<unsigned> geo_key(const Input& input, const LasHeader& header, unsigned wanted) {
  constexpr std::size_t kEntry = 8;  // bytes of the head and of each key: four numbers (format)
  const auto record = find_record(input, header, kProjection, kGeoKeys);
  if (!record) return {};
  const std::byte* data = input.bytes.data() + record->offset;
  for (std::size_t at = kEntry; at + kEntry <= record->size; at += kEntry) {
    const bool is_value = load_as<std::uint16_t>(data + at + 2) == 0;  // not an offset
    if (is_value && load_as<std::uint16_t>(data + at) == wanted) {
      return load_as<std::uint16_t>(data + at + 6);
    }
  }
  return {};
}

std::string_view wkt_of(const Input& input, const LasHeader& header) {
  const auto record = find_record(input, header, kProjection, kWkt);
  return record ? input.text().substr(record->offset, record->size) : std::string_view();
}

bool has(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

// m, of the last unit before the heights' system, which is that of x and y: UNIT["foot",0.3048].
std::optional<double> unit_in_wkt(std::string_view wkt) {
  wkt = wkt.substr(0, wkt.find("VERT"));
  const std::size_t unit = wkt.rfind("UNIT[");
  if (unit == std::string_view::npos) return {};
  const std::size_t begin = wkt.find(',', unit);
  if (begin == std::string_view::npos) return {};
  return parse_number(trim(wkt.substr(begin + 1, wkt.find_first_of(",]", begin + 1) - begin - 1)));
}

}  // namespace

void check_no_degrees(const Input& input, const LasHeader& header) {
  // Text of a projected system names the geographic one that it is made of, too.
  const std::string_view wkt = wkt_of(input, header);
  const bool geographic = geo_key(input, header, kModelType) == kGeographic ||
                          (has(wkt, "GEOGC") && !has(wkt, "PROJC"));
  if (!geographic) return;
  fail(
      input, "its coordinates are degrees of longitude and latitude, as it says",
      "Project it to metres, for example with \"pdal translate IN.las OUT.las reprojection "
      "--filters.reprojection.out_srs=EPSG:326NN\", where NN is its UTM zone (327NN in the south)");
}

std::string_view stated_unit(const Input& input, const LasHeader& header) {
  const unsigned key = geo_key(input, header, kLinearUnits).value_or(0);
  const double length = unit_in_wkt(wkt_of(input, header)).value_or(0);
  if (key == kMetre || (key == 0 && length == 1)) return ", in metres";
  const bool feet = std::abs(length / kFootLength - 1) < kSameUnit;
  if (key == kFoot || key == kSurveyFoot || (key == 0 && feet)) return ", in feet";
  return {};
}

}  // namespace palpate::io
