// Describes the ROS messages that show a run: diagnostics, markers, meshes.
#pragma once

#include "message/sensor_types.hpp"

namespace palpate::message {

struct KeyValue {
  static constexpr auto kName = "diagnostic_msgs/KeyValue";
  std::string key;
  std::string value;

  static void each(auto& m, auto&& f) {
    f("key", m.key);
    f("value", m.value);
  }
};

struct DiagnosticStatus {
  static constexpr auto kName = "diagnostic_msgs/DiagnosticStatus";
  std::byte level{};  // 0 ok, 1 warning, 2 error, 3 stale
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValue> values;

  static void each(auto& m, auto&& f) {
    f("level", m.level);
    f("name", m.name);
    f("message", m.message);
    f("hardware_id", m.hardware_id);
    f("values", m.values);
  }
};

struct DiagnosticArray {
  static constexpr auto kName = "diagnostic_msgs/DiagnosticArray";
  static constexpr auto kHash = "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e";
  Header header;
  std::vector<DiagnosticStatus> status;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("status", m.status);
  }
};

struct UVCoordinate {
  static constexpr auto kName = "visualization_msgs/UVCoordinate";
  float u = 0;
  float v = 0;

  static void each(auto& m, auto&& f) {
    f("u", m.u);
    f("v", m.v);
  }
};

struct MeshFile {
  static constexpr auto kName = "visualization_msgs/MeshFile";
  std::string filename;
  std::vector<std::uint8_t> data;

  static void each(auto& m, auto&& f) {
    f("filename", m.filename);
    f("data", m.data);
  }
};

struct Marker {
  static constexpr auto kName = "visualization_msgs/Marker";
  static constexpr auto kHash = "45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0";
  Header header;
  std::string ns;
  std::int32_t id = 0;
  std::int32_t type = 0;  // 0 arrow, 2 sphere, 3 cylinder
  std::int32_t action = 0;
  Pose pose;
  Vector3 scale;  // m
  ColorRGBA color;
  Duration lifetime;
  bool frame_locked = false;
  std::vector<Point> points;
  std::vector<ColorRGBA> colors;
  std::string texture_resource;
  CompressedImage texture;
  std::vector<UVCoordinate> uv_coordinates;
  std::string text;
  std::string mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("ns", m.ns);
    f("id", m.id);
    f("type", m.type);
    f("action", m.action);
    f("pose", m.pose);
    f("scale", m.scale);
    f("color", m.color);
    f("lifetime", m.lifetime);
    f("frame_locked", m.frame_locked);
    f("points", m.points);
    f("colors", m.colors);
    f("texture_resource", m.texture_resource);
    f("texture", m.texture);
    f("uv_coordinates", m.uv_coordinates);
    f("text", m.text);
    f("mesh_resource", m.mesh_resource);
    f("mesh_file", m.mesh_file);
    f("mesh_use_embedded_materials", m.mesh_use_embedded_materials);
  }
};

struct MarkerArray {
  static constexpr auto kName = "visualization_msgs/MarkerArray";
  static constexpr auto kHash = "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf";
  std::vector<Marker> markers;

  static void each(auto& m, auto&& f) { f("markers", m.markers); }
};

}  // namespace palpate::message
