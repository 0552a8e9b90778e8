#pragma once

#include "field/description.hpp"
#include "palpate/prepare/prepare.hpp"

/// The descriptions of the options of preparation.
namespace palpate {

// In the order in which help and errors list them.
inline constexpr std::array<Named<PrepareOptions::Orientation>, 4> kOrientations = {
    {{"automatic", PrepareOptions::Orientation::automatic},
     {"viewpoint", PrepareOptions::Orientation::viewpoint},
     {"outward", PrepareOptions::Orientation::outward},
     {"given", PrepareOptions::Orientation::given}}};
[[nodiscard]] constexpr const auto& choices(PrepareOptions::Orientation /*of*/) {
  return kOrientations;
}

template <EitherConst<PrepareOptions> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [voxel, radius, smoothing, least, error, viewpoint, signs, clip, speckle, normals, material,
         paper, kernel, facts, progress, without] = options;  // the last is for benches alone
  take(About{"voxel", "m", kNotNegative, "voxel size of the voxel filter for clouds; 0: no filter"},
       voxel);
  take(About{"radius", "m", kPositive,
             "support radius R of every point (for depth images and streams: the smallest R); "
             "larger is smoother"},
       radius);
  take(About{"smoothing", "", kPositive, "", python}, smoothing);
  take(About{"minimum_radius", "m", kNotNegative, "", python}, least);
  take(About{"normal_error", "rad", kPositive,
             "how far normals may err: the smaller, the wider the area that a normal is fitted to, "
             "and the less detail",
             files},
       error);
  take(About{"viewpoint", "", {}, "sensor position in the cloud's frame; orients the normals"},
       viewpoint);
  take(About{"orientation", "", {}, "", python}, signs);
  take(About{"clip", "", {}, "", python}, clip);
  take(About{"remove_speckle", "", {}, "", python}, speckle);
  take(About{"estimate_normals", "", {}, "", python}, normals);
  take(About{"material_from_intensity", "", {}, "", python}, material);
  take(About{"paper", "", {}, "", python}, paper);
  take(About{"kernel", "", {}, "", python}, kernel);
  take(About{"facts", "", {}, "", recordings}, facts);
}

}  // namespace palpate
