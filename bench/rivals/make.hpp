#pragma once

#include "rivals/rival.hpp"

/// The methods, one file each. `scale` multiplies the one free length.
namespace palpate::rivals {

[[nodiscard]] std::unique_ptr<Rival> make_terrain(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_shaded(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_graph(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_video(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_hexahedra(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_mls(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_spheres(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_ball(double scale);
[[nodiscard]] std::unique_ptr<Rival> make_local_ball(double scale);

}  // namespace palpate::rivals
