// Says of archives and documents what they are, and how to get a cloud out of them.
#include "io/containers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

struct Container {
  std::string_view start;   // of the file
  std::string_view ending;  // of its name; or
  std::string_view word;    // near its begin
  std::string_view what;
  std::string_view remedy;
};

constexpr std::string_view kAsMesh = "Export it again as GLB, OBJ or PLY";

constexpr Container kContainers[] = {
    {"PK\x03\x04", ".usdz", ".usd", "a scene in USDZ, which is not read", kAsMesh},
    {"PK\x03\x04", ".3mf", "3D/3dmodel", "a model for printers in 3MF, which is not read",
     "Export it again as STL"},
    {"PK\x03\x04", ".npz", ".npy", "an archive of NumPy's arrays",
     "Take its points, here those in floats of which there are most: python3 -c \"import numpy as "
     "np; z = np.load('IN.npz'); np.save('OUT.npy', z[max(z, key=lambda k: "
     "(k in ('points', 'xyz', 'vertices'), z[k].dtype.kind == 'f', z[k].size))])\""},
    {"PXR-USDC", "", "", "a scene in USD, which is not read", kAsMesh},
    {"#usda", "", "", "a scene in USD, which is not read", kAsMesh},
    {"<", ".dae", "<COLLADA", "a scene in COLLADA, which is not read",
     "Open it in Blender or MeshLab and export it as GLB, OBJ or PLY"},
    {"<", ".x3d", "<X3D", "a scene in X3D, which is not read",
     "Open it in Blender or MeshLab and export it as GLB, OBJ or PLY"},
    {"<", ".vtp", "<VTKFile", "a file of VTK in XML, which is not read",
     "Save its data in ParaView as PLY or CSV"},
    {"# vtk DataFile", "", "", "a file of VTK, which is not read",
     "Save its data in ParaView as PLY or CSV"},
    {"{", "ept.json", "\"hierarchyType\"",
     "a cloud of tiles as Entwine makes it, which is not read",
     "Make one file of it: pdal translate ept://FOLDER cloud.copc.laz"},
    {"{", "cloud.js", "\"octreeDir\"", "a store of Potree 1, which is not read",
     "Convert the cloud that it was made of, by PotreeConverter 2 or palpate tile"},
    {"{", "tileset.json", "\"geometricError\"", "a set of 3D Tiles, which is not read",
     "Give the cloud or mesh that it was made of"},
    {"BLENDER", "", "", "a scene of Blender", "Export it from there as GLB, OBJ or PLY"},
};

bool is_container(const Container& container, std::string_view text, const std::string& name) {
  constexpr std::size_t kNear = 4096;  // bytes in which words are looked for (judgement)
  if (!text.starts_with(container.start)) return false;
  if (container.ending.empty()) return true;
  return name.ends_with(container.ending) ||
         text.substr(0, kNear).find(container.word) != std::string_view::npos;
}

}  // namespace

void refuse_containers(const Input& input) {
  const std::string name = lower_case(input.name);
  const std::string_view text = input.text();
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  for (const Container& each : kContainers) {
    if (!is_container(each, text.substr(begin), name)) continue;
    fail(input, fmt::format("this is {}", each.what), each.remedy);
  }
}

}  // namespace palpate::io
