// Reads in what a LAS file's coordinates are: its GeoTIFF keys and its well-known text (WKT).
#include "io/las_coordinates.hpp"

#include <optional>
#include <string>

#include "io/text_scanner.hpp"
#include "io/units/epsg.hpp"
#include "io/units/file_unit.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kProjection = "LASF_Projection";

// Records, keys and values of the ASPRS and GeoTIFF specifications.
constexpr int kGeoKeys = 34735;
constexpr int kGeoDoubles = 34736;
constexpr int kWkt = 2112;
constexpr unsigned kModelType = 1024;
constexpr unsigned kGeographic = 2;
constexpr unsigned kGeocentric = 3;
constexpr unsigned kGeographicUnit = 2052;  // of length
constexpr unsigned kProjectedSystem = 3072;
constexpr unsigned kProjectedUnit = 3076;
constexpr unsigned kProjectedUnitSize = 3077;  // m, where the unit is a user's own
constexpr unsigned kVerticalSystem = 4096;
constexpr unsigned kVerticalUnit = 4099;

struct GeoKey {
  unsigned place = 0;  // 0: the value is here; else the record that holds it
  unsigned value = 0;  // or its index there
};

std::optional<GeoKey> geo_key(const Input& input, const LasHeader& header, unsigned wanted) {
  constexpr std::size_t kEntry = 8;  // bytes of the head and of each key: four numbers (format)
  const auto record = find_record(input, header, kProjection, kGeoKeys);
  if (!record) return {};
  const std::byte* data = input.bytes.data() + record->offset;
  for (std::size_t at = kEntry; at + kEntry <= record->size; at += kEntry) {
    if (load_as<std::uint16_t>(data + at) != wanted) continue;
    return GeoKey{load_as<std::uint16_t>(data + at + 2), load_as<std::uint16_t>(data + at + 6)};
  }
  return {};
}

// The value of a key that is a whole number; 0: there is none.
unsigned whole_key(const Input& input, const LasHeader& header, unsigned wanted) {
  const GeoKey key = geo_key(input, header, wanted).value_or(GeoKey());
  return key.place == 0 ? key.value : 0;
}

std::optional<double> real_key(const Input& input, const LasHeader& header, unsigned wanted) {
  const auto key = geo_key(input, header, wanted);
  const auto record = find_record(input, header, kProjection, kGeoDoubles);
  if (!key || key->place != kGeoDoubles || !record) return {};
  const std::size_t at = key->value * sizeof(double);
  if (at + sizeof(double) > record->size) return {};
  return load_as<double>(input.bytes.data() + record->offset + at);
}

StatedUnits units_in_keys(const Input& input, const LasHeader& header) {
  const auto key = [&](unsigned wanted) { return whole_key(input, header, wanted); };
  if (key(kModelType) == kGeographic) return {.degrees = true};
  StatedUnits found;
  found.plan = metres_of_epsg_unit(key(kProjectedUnit));
  if (!found.plan) found.plan = real_key(input, header, kProjectedUnitSize);
  if (key(kModelType) == kGeocentric) found.plan = metres_of_epsg_unit(key(kGeographicUnit));
  if (!found.plan) found.plan = metres_of_epsg_system(key(kProjectedSystem));
  found.height = metres_of_epsg_unit(key(kVerticalUnit));
  const unsigned vertical = key(kVerticalSystem);
  // GeoTIFF's own numbers of heights, 5001 to 5192, state no unit.
  const bool own = vertical > 5000 && vertical <= 5192;
  if (!found.height && !own) found.height = metres_of_epsg_system(vertical);
  return found;
}

StatedUnits units_in_text(const Input& input, const LasHeader& header) {
  const auto record = find_record(input, header, kProjection, kWkt);
  if (!record) return {};
  return units_in_projection(input.text().substr(record->offset, record->size));
}

// Does the header say that its well-known text holds, and not its keys?
bool prefers_text(const Input& input) {
  constexpr std::size_t kEncoding = 6;  // bytes into the header (format)
  constexpr unsigned kText = 16;
  return (load_as<std::uint16_t>(input.bytes.data() + kEncoding) & kText) != 0;
}

}  // namespace

void fail_as_degrees(const Input& input) {
  fail(
      input, "its coordinates are degrees of longitude and latitude, as it says",
      "Project it to metres, for example with \"pdal translate IN.las OUT.las reprojection "
      "--filters.reprojection.out_srs=EPSG:326NN\", where NN is its UTM zone (327NN in the south)");
}

Input in_las_unit(const Input& input, const LasHeader& header) {
  const StatedUnits keys = units_in_keys(input, header);
  const StatedUnits text = units_in_text(input, header);
  StatedUnits found = prefers_text(input) ? text : keys;
  const StatedUnits& other = prefers_text(input) ? keys : text;
  if (found.degrees || (other.degrees && !found.plan)) fail_as_degrees(input);
  const bool first = found.plan || (!other.plan && found.height);
  const bool by_text = first == prefers_text(input);
  if (!found.plan) found.plan = other.plan;
  if (!found.height) found.height = other.height;
  return in_stated_unit(input, found, by_text ? "its well-known text (WKT)" : "its GeoTIFF keys");
}

}  // namespace palpate::io
