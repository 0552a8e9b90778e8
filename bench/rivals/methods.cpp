// Lists the methods.
#include <fmt/format.h>

#include <algorithm>

#include "palpate/base/error.hpp"
#include "rivals/make.hpp"
#include "rivals/ours.hpp"

namespace palpate::rivals {
namespace {

// palpate's defaults and the paper's choices, by their places in all_contenders().
template <int kPlace>
std::unique_ptr<Rival> make_contender(double /*scale*/) {
  return make_rival(accuracy::all_contenders().at(kPlace));
}

constexpr const char* kGodObject = "Zilles and Salisbury 1994";
constexpr const char* kProxyGraph = "Walker and Salisbury 2003";

std::vector<Method> ours() {
  return {
      {"ours", "palpate", "the default for depth frames", "", 1, Needs::points, make_contender<0>},
      {"ours-points", "palpate", "the default for points", "", 1, Needs::points, make_contender<1>},
      {"pointset", "palpate", "its point-set surface", "", 1, Needs::points, make_contender<2>},
      {"metaball", "palpate", "its metaballs", "", 1, Needs::points, make_contender<3>},
      {"paper-pointset", "Leeper, Chan, Salisbury 2012", "the paper's point-set surface", "", 1,
       Needs::points, make_contender<4>},
      {"paper-metaball", "Leeper, Chan, Salisbury 2012", "the paper's metaballs", "", 1,
       Needs::points, make_contender<5>}};
}

std::vector<Method> of_frames() {
  return {{"terrain", kGodObject, "god-object on the triangles of the image", "jump of depth", 1,
           Needs::frame, make_terrain},
          {"terrain+filter", kGodObject, "the same on our filtered frame", "jump of depth", 1,
           Needs::filtered_frame, make_terrain},
          {"shaded", "Ruspini, Kolarov, Khatib 1997", "the same with force shading",
           "jump of depth", 1, Needs::frame, make_shaded},
          {"graph", kProxyGraph, "proxy on the edges of these triangles", "jump of depth", 1,
           Needs::frame, make_graph},
          {"graph+filter", kProxyGraph, "the same on our filtered frame", "jump of depth", 1,
           Needs::filtered_frame, make_graph},
          {"video", "Cha et al. 2006-09", "the same graph, which moves from frame to frame",
           "jump of depth", 1, Needs::frame, make_video}};
}

std::vector<Method> of_points() {
  return {
      {"hexahedra", "El-Far, Georganas, El Saddik 2008", "proxy hops among points grown to cubes",
       "half a cube's edge", 2, Needs::points, make_hexahedra},
      {"mls", "Lee and Kim 2007", "penalty force on a moving-least-squares surface",
       "width of the weights", 2, Needs::points, make_mls},
      {"spheres", "point objects of haptics libraries", "god-object among balls around points",
       "radius of the balls", 2, Needs::points, make_spheres},
      {"ball", "Sreeni and Chaudhuri 2012", "a ball rolls over the points", "radius of the ball",
       0.5, Needs::points, make_ball},
      {"local-ball", "Kumari 2020", "the same, its radius by local density", "radius of the ball",
       0.5, Needs::points, make_local_ball}};
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> all = [] {
    std::vector<Method> list = ours();
    for (const auto& more : {of_frames(), of_points()}) {
      list.insert(list.end(), more.begin(), more.end());
    }
    return list;
  }();
  return all;
}

const Method& method_named(std::string_view name) {
  std::string names;
  for (const Method& method : methods()) {
    if (method.name == name) return method;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", method.name);
  }
  throw Error(fmt::format("--methods {}: no such method; there are {}", name, names));
}

Step spring(const Eigen::Vector3d& proxy, const Eigen::Vector3d& hip) {
  return {kStiffness * (proxy - hip), proxy, proxy != hip};
}

}  // namespace palpate::rivals
