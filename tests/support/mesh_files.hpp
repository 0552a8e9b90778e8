// Writes small meshes as files of each format that is read.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/put.hpp"

namespace palpate::test {

struct TestMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<std::uint32_t>> faces;  // anticlockwise from outside
};

/// A box around zero, of two triangles a side.
inline TestMesh box_mesh(const Eigen::Vector3d& half) {
  TestMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 4) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 1) != 0 ? 1 : -1);
    mesh.vertices.push_back(sign.cwiseProduct(half));
  }
  const std::array<std::array<std::uint32_t, 4>, 6> sides{
      {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
  for (const auto& s : sides) {
    mesh.faces.push_back({s[0], s[1], s[2]});
    mesh.faces.push_back({s[0], s[2], s[3]});
  }
  return mesh;
}

/// An icosahedron whose triangles are divided in four `times` times, its vertices on a sphere.
inline TestMesh icosphere(double radius, int times) {
  const double g = std::numbers::phi;
  TestMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = radius * vertex.normalized();
  for (int i = 0; i < times; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        const Eigen::Vector3d sum = mesh.vertices[a] + mesh.vertices[b];
        mesh.vertices.push_back(radius * sum.normalized());
      }
      return found->second;
    };
    std::vector<std::vector<std::uint32_t>> finer;
    for (const auto& f : mesh.faces) {
      const std::uint32_t a = middle(f[0], f[1]);
      const std::uint32_t b = middle(f[1], f[2]);
      const std::uint32_t c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    mesh.faces = std::move(finer);
  }
  return mesh;
}

/// A square plate with a bore of `corners` sides, its faces quadrangles.
inline TestMesh bored_plate(double half, double thickness, double bore, int corners) {
  TestMesh mesh;
  for (const double z : {-thickness / 2, thickness / 2}) {
    for (const bool outside : {false, true}) {
      for (int i = 0; i < corners; ++i) {
        const double a = 2 * std::numbers::pi * i / corners;
        const Eigen::Vector2d d(std::cos(a), std::sin(a));
        const double reach = outside ? half / d.cwiseAbs().maxCoeff() : bore;
        mesh.vertices.emplace_back(reach * d.x(), reach * d.y(), z);
      }
    }
  }
  const auto n = static_cast<std::uint32_t>(corners);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.faces.push_back({2 * n + i, 3 * n + i, 3 * n + j, 2 * n + j});
    mesh.faces.push_back({i, j, n + j, n + i});
    mesh.faces.push_back({n + i, n + j, 3 * n + j, 3 * n + i});
    mesh.faces.push_back({i, 2 * n + i, 2 * n + j, j});
  }
  return mesh;
}

inline std::string as_obj(const TestMesh& mesh) {
  std::string text = "# a mesh\n";
  for (const auto& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& face : mesh.faces) {
    text += "f";
    for (const std::uint32_t corner : face) text += fmt::format(" {}", corner + 1);
    text += "\n";
  }
  return text;
}

inline std::string as_ply(const TestMesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.faces.size());
  for (const auto& v : mesh.vertices) text += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& face : mesh.faces) {
    text += fmt::format("{}", face.size());
    for (const std::uint32_t corner : face) text += fmt::format(" {}", corner);
    text += "\n";
  }
  return text;
}

inline std::string as_stl_text(const TestMesh& mesh) {
  std::string text = "solid thing\n";
  for (const auto& face : mesh.faces) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t corner : face) {
      const auto& v = mesh.vertices[corner];
      text += fmt::format("   vertex {} {} {}\n", v.x(), v.y(), v.z());
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid thing\n";
}

inline void put(std::string& out, const Eigen::Vector3d& v) {
  for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(v[axis]));
}

/// The first three corners of each face.
inline std::string as_stl(const TestMesh& mesh) {
  std::string bytes = "solid, but of bytes";
  bytes.resize(80);
  put(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
  for (const auto& face : mesh.faces) {
    put(bytes, Eigen::Vector3d(0, 0, 0));
    for (std::size_t i = 0; i < 3; ++i) put(bytes, mesh.vertices[face[i]]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

/// Positions, y up, and 32-bit indices, one after the other.
inline std::string gltf_data(const TestMesh& mesh) {
  std::string bytes;
  for (const auto& v : mesh.vertices) put(bytes, Eigen::Vector3d(v.x(), v.z(), -v.y()));
  for (const auto& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) put(bytes, face[i]);
  }
  return bytes;
}

/// The JSON of glTF for gltf_data(). `buffer`: further members of the buffer, such as its URI;
/// `node` of the only node.
inline std::string gltf_json(const TestMesh& mesh, const std::string& buffer = "",
                             const std::string& node = "") {
  const std::size_t positions = 12 * mesh.vertices.size();
  const std::size_t indices = 12 * mesh.faces.size();
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{"byteLength":{}{}}}]}})",
      node, mesh.vertices.size(), 3 * mesh.faces.size(), positions, positions, indices,
      positions + indices, buffer);
}

/// GLB of a JSON and the bytes behind it.
inline std::string glb(std::string json, std::string data) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4);
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(28 + json.size() + data.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(bytes, static_cast<std::uint32_t>(data.size()));
  return bytes + std::string("BIN\0", 4) + data;
}

inline std::string as_glb(const TestMesh& mesh) {
  return glb(gltf_json(mesh), gltf_data(mesh));
}

/// A file of each format: its name and bytes.
inline std::vector<std::pair<std::string, std::string>> as_every_format(const TestMesh& mesh) {
  return {{"mesh.obj", as_obj(mesh)},
          {"mesh.ply", as_ply(mesh)},
          {"text.stl", as_stl_text(mesh)},
          {"bytes.stl", as_stl(mesh)},
          {"mesh.glb", as_glb(mesh)}};
}

}  // namespace palpate::test
