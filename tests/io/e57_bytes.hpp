// Writes E57 files for tests: every kind of column, in packets whose columns come unevenly.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "e57_pages_of.hpp"
#include "io/reading.hpp"

namespace palpate {

/// A column of a scan: how the XML describes it, and its numbers as bits.
struct E57TestField {
  std::string name;
  std::string type;  ///< attributes of its element
  unsigned bits = 0;
  std::vector<std::uint64_t> raw;
};

inline E57TestField e57_integers(const std::string& name, std::int64_t least, std::int64_t most,
                                 const std::vector<std::int64_t>& values,
                                 const std::string& more = R"(type="Integer")") {
  const auto start = static_cast<std::uint64_t>(least);
  E57TestField field{
      name,
      fmt::format(R"({} minimum="{}" maximum="{}")", more, least, most),
      static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(most) - start)),
      {}};
  for (const std::int64_t v : values) field.raw.push_back(static_cast<std::uint64_t>(v) - start);
  return field;
}

inline E57TestField e57_scaled(const std::string& name, std::int64_t least, std::int64_t most,
                               double scale, double offset,
                               const std::vector<std::int64_t>& values) {
  return e57_integers(name, least, most, values,
                      fmt::format(R"(type="ScaledInteger" scale="{}" offset="{}")", scale, offset));
}

inline E57TestField e57_doubles(const std::string& name, const std::vector<double>& values) {
  E57TestField field{name, R"(type="Float")", 64, {}};
  for (const double v : values) field.raw.push_back(std::bit_cast<std::uint64_t>(v));
  return field;
}

inline E57TestField e57_singles(const std::string& name, const std::vector<double>& values) {
  E57TestField field{name, R"(type="Float" precision="single")", 32, {}};
  for (const double v : values) {
    field.raw.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(v)));
  }
  return field;
}

struct E57TestScan {
  std::vector<E57TestField> fields;
  std::string xml = {};  ///< more about the scan: its pose, its colours' limits
  std::string name = "a scan";
  std::size_t packet = 700;  ///< bytes of its columns in a packet, about
  /// Only data packets, each of which completes a point: web-e57 reads no others.
  bool simple = false;

  [[nodiscard]] std::size_t points() const { return fields.front().raw.size(); }
};

inline std::string e57_pose(const std::array<double, 4>& wxyz, const std::array<double, 3>& t) {
  const auto number = [](const char* name, double v) {
    return fmt::format(R"(<{0} type="Float">{1}</{0}>)", name, v);
  };
  return R"(<pose type="Structure"><rotation type="Structure">)" + number("w", wxyz[0]) +
         number("x", wxyz[1]) + number("y", wxyz[2]) + number("z", wxyz[3]) +
         R"(</rotation><translation type="Structure">)" + number("x", t[0]) + number("y", t[1]) +
         number("z", t[2]) + "</translation></pose>";
}

/// The file without the CRCs of its pages; fuzz::e57_pages_of() adds them.
class E57TestFile {
 public:
  explicit E57TestFile(const std::vector<E57TestScan>& scans, int images = 0) : data_(48, '\0') {
    for (const E57TestScan& scan : scans) add(scan);
    finish(images);
  }

  [[nodiscard]] const std::string& data() const { return data_; }
  [[nodiscard]] const std::string& xml() const { return xml_; }
  [[nodiscard]] std::string bytes() const { return paged(data_); }

  /// The file with another XML.
  [[nodiscard]] std::string with_xml(const std::string& xml) const {
    std::string data = data_.substr(0, data_.size() - xml_.size());
    close(data, xml);
    return paged(data);
  }

  static std::string paged(std::string_view data) {
    const std::vector<std::byte> pages = fuzz::e57_pages_of(std::as_bytes(std::span(data)));
    return {reinterpret_cast<const char*>(pages.data()), pages.size()};
  }

  static std::uint64_t physical(std::uint64_t place) { return io::E57Pages::byte_of(place); }

 private:
  static std::string stream(const E57TestField& field) {
    std::vector<bool> bits;
    for (const std::uint64_t raw : field.raw) {
      for (unsigned k = 0; k < field.bits; ++k) bits.push_back((raw >> k & 1U) != 0);
    }
    std::string bytes((bits.size() + 7) / 8, '\0');
    for (std::size_t k = 0; k < bits.size(); ++k) {
      if (bits[k]) bytes[k / 8] = static_cast<char>(bytes[k / 8] | 1 << k % 8);
    }
    return bytes;
  }

  void add(const E57TestScan& scan) {
    const std::size_t section = data_.size();
    data_ += std::string(32, '\0');
    std::vector<std::string> streams;
    for (const E57TestField& field : scan.fields) streams.push_back(stream(field));
    if (!scan.simple) add_skipped(24, '\0');
    for (std::size_t turn = 0; !all_empty(streams); ++turn) {
      add_packet(streams, scan, turn);
      if (turn % 4 == 1 && !scan.simple) add_skipped(8, '\2');
      if (turn % 4 == 3 && !scan.simple) add_skipped(16, '\0');
    }
    data_[section] = 1;
    overwrite<std::uint64_t>(data_, section + 8, data_.size() - section);
    overwrite<std::uint64_t>(data_, section + 16, physical(section + 32));
    describe(scan, section);
  }

  static bool all_empty(const std::vector<std::string>& streams) {
    return std::ranges::all_of(streams, &std::string::empty);
  }

  // Adds an index packet (type 0) or an empty one (2).
  void add_skipped(std::size_t size, char type) {
    data_ += {type, '\0'};
    append<std::uint16_t>(data_, static_cast<std::uint16_t>(size - 1));
    data_ += std::string(size - 4, '\0');
  }

  // In each turn other columns are ahead of the rest; unless simple, some have nothing in a packet.
  void add_packet(std::vector<std::string>& streams, const E57TestScan& scan, std::size_t turn) {
    const std::size_t least = scan.simple ? 1 : 0;
    std::string sizes;
    std::string content;
    for (std::size_t k = 0; k < streams.size(); ++k) {
      const std::size_t share =
          scan.packet * (least + (k + turn) % 3) / (2 * streams.size()) + turn % 2;
      const std::size_t size = std::min(share, streams[k].size());
      append<std::uint16_t>(sizes, static_cast<std::uint16_t>(size));
      content += streams[k].substr(0, size);
      streams[k].erase(0, size);
    }
    content = sizes + content;
    content.resize((content.size() + 6 + 3) / 4 * 4 - 6, '\0');
    data_ += {'\1', '\0'};
    append<std::uint16_t>(data_, static_cast<std::uint16_t>(content.size() + 6 - 1));
    append<std::uint16_t>(data_, static_cast<std::uint16_t>(streams.size()));
    data_ += content;
  }

  void describe(const E57TestScan& scan, std::size_t section) {
    xml_ +=
        fmt::format(R"(<vectorChild type="Structure"><guid type="String">{{{}}}</guid>)", section);
    xml_ += fmt::format(R"(<name type="String"><![CDATA[{}]]></name>{})", scan.name, scan.xml);
    xml_ += fmt::format(R"(<points type="CompressedVector" fileOffset="{}" recordCount="{}">)",
                        physical(section), scan.points());
    xml_ += R"(<prototype type="Structure">)";
    for (const E57TestField& field : scan.fields) {
      xml_ += fmt::format("<{} {}/>", field.name, field.type);
    }
    xml_ += R"(</prototype><codecs type="Vector"/></points></vectorChild>)";
  }

  void finish(int images) {
    std::string pictures;
    for (int i = 0; i < images; ++i) pictures += R"(<vectorChild type="Structure"/>)";
    xml_ = R"(<?xml version="1.0" encoding="UTF-8"?><e57Root type="Structure" )"
           R"(xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0" )"
           R"(xmlns:nor="http://www.libe57.org/E57_NOR_surface_normals.txt">)"
           R"(<formatName type="String">ASTM E57 3D Imaging Data File</formatName>)"
           R"(<guid type="String">{a test}</guid><versionMajor type="Integer">1</versionMajor>)"
           R"(<versionMinor type="Integer">0</versionMinor><data3D type="Vector" )"
           R"(allowHeterogeneousChildren="1">)" +
           xml_ + R"(</data3D><images2D type="Vector" allowHeterogeneousChildren="1">)" + pictures +
           "</images2D></e57Root>";
    close(data_, xml_);
  }

  // Adds the XML and fills in the header.
  static void close(std::string& data, const std::string& xml) {
    data.replace(0, 8, "ASTM-E57");
    overwrite<std::uint32_t>(data, 8, 1);
    overwrite<std::uint64_t>(data, 24, physical(data.size()));
    overwrite<std::uint64_t>(data, 32, xml.size());
    overwrite<std::uint64_t>(data, 40, io::kE57Page);
    data += xml;
    const std::size_t pages = (data.size() + io::kE57PageData - 1) / io::kE57PageData;
    overwrite<std::uint64_t>(data, 16, pages * io::kE57Page);
  }

  std::string data_;
  std::string xml_;
};

}  // namespace palpate
