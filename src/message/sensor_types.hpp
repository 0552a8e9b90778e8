// Describes the ROS messages of sensors and of input devices.
#pragma once

#include "message/geometry_types.hpp"

namespace palpate::message {

struct PointField {
  static constexpr auto kName = "sensor_msgs/PointField";
  std::string name;
  std::uint32_t offset = 0;   // bytes
  std::uint8_t datatype = 0;  // 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
  std::uint32_t count = 1;

  static void each(auto& m, auto&& f) {
    f("name", m.name);
    f("offset", m.offset);
    f("datatype", m.datatype);
    f("count", m.count);
  }
};

struct PointCloud2 {
  static constexpr auto kName = "sensor_msgs/PointCloud2";
  static constexpr auto kHash = "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5";
  Header header;
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = false;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("height", m.height);
    f("width", m.width);
    f("fields", m.fields);
    f("is_bigendian", m.is_bigendian);
    f("point_step", m.point_step);
    f("row_step", m.row_step);
    f("data", m.data);
    f("is_dense", m.is_dense);
  }
};

struct Image {
  static constexpr auto kName = "sensor_msgs/Image";
  static constexpr auto kHash = "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47";
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;
  std::vector<std::uint8_t> data;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("height", m.height);
    f("width", m.width);
    f("encoding", m.encoding);
    f("is_bigendian", m.is_bigendian);
    f("step", m.step);
    f("data", m.data);
  }
};

struct CompressedImage {
  static constexpr auto kName = "sensor_msgs/CompressedImage";
  static constexpr auto kHash = "15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a";
  Header header;
  std::string format;
  std::vector<std::uint8_t> data;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("format", m.format);
    f("data", m.data);
  }
};

struct RegionOfInterest {
  static constexpr auto kName = "sensor_msgs/RegionOfInterest";
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;

  static void each(auto& m, auto&& f) {
    f("x_offset", m.x_offset);
    f("y_offset", m.y_offset);
    f("height", m.height);
    f("width", m.width);
    f("do_rectify", m.do_rectify);
  }
};

struct CameraInfo {
  static constexpr auto kName = "sensor_msgs/CameraInfo";
  static constexpr auto kHash = "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275";
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  RegionOfInterest roi;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("height", m.height);
    f("width", m.width);
    f("distortion_model", m.distortion_model);
    f("d", m.d);
    f("k", m.k);
    f("r", m.r);
    f("p", m.p);
    f("binning_x", m.binning_x);
    f("binning_y", m.binning_y);
    f("roi", m.roi);
  }
};

struct Joy {
  static constexpr auto kName = "sensor_msgs/Joy";
  static constexpr auto kHash = "0d356c79cad3401e35ffeb75a96a96e08be3ef896b8b83841d73e890989372c5";
  Header header;
  std::vector<float> axes;
  std::vector<std::int32_t> buttons;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("axes", m.axes);
    f("buttons", m.buttons);
  }
};

struct JointState {
  static constexpr auto kName = "sensor_msgs/JointState";
  static constexpr auto kHash = "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e";
  Header header;
  std::vector<std::string> name;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> effort;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("name", m.name);
    f("position", m.position);
    f("velocity", m.velocity);
    f("effort", m.effort);
  }
};

struct OmniFeedback {
  static constexpr auto kName = "omni_msgs/OmniFeedback";
  static constexpr auto kHash = "ba84a6b698946ddb497c4d4b2062955836546f699b10724f3357b0a82c41dfff";
  Vector3 force;
  Vector3 position;

  static void each(auto& m, auto&& f) {
    f("force", m.force);
    f("position", m.position);
  }
};

struct OmniButtonEvent {
  static constexpr auto kName = "omni_msgs/OmniButtonEvent";
  static constexpr auto kHash = "3d8e3c256b4d68ef6679f98b28e039d4dc1a01fe243d8b286137c73157937d78";
  std::int32_t grey_button = 0;
  std::int32_t white_button = 0;

  static void each(auto& m, auto&& f) {
    f("grey_button", m.grey_button);
    f("white_button", m.white_button);
  }
};

}  // namespace palpate::message
